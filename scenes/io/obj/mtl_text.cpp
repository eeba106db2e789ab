#include "scenes/io/obj/mtl_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/io/common/text_parse.h"
#include "scenes/model/error.h"
#include "scenes/model/limits.h"

namespace reemit {
namespace {

// Numbers a statement of a MTL file must have. tinyobjloader reads what is missing or garbled as 0.
struct NumberRule {
  std::string_view keyword;
  std::size_t least, most;  // how many
  double low, high;         // allowed values
};
constexpr double kAny = 1e300;
constexpr std::array kObjRules = {
    NumberRule{"Kd", 1, 3, 0, 1},        NumberRule{"Ks", 1, 3, 0, 1}, NumberRule{"Ke", 1, 3, 0, kAny},
    NumberRule{"Ka", 1, 3, -kAny, kAny}, NumberRule{"Tf", 1, 3, 0, 1}, NumberRule{"Ns", 1, 1, 0, kAny},
    NumberRule{"Ni", 1, 1, 0, kAny},     NumberRule{"d", 1, 1, 0, 1},  NumberRule{"Tr", 1, 1, 0, 1},
    NumberRule{"illum", 1, 1, 0, 10},
};

// The words of a numeric statement up to a comment; -halo of d, by which viewers fade what is seen at a
// slant, is passed over.
std::vector<std::string_view> words_of_numbers(const TextLine& line) {
  const auto comment =
      std::find_if(line.words.begin(), line.words.end(), [](auto word) { return word[0] == '#'; });
  std::vector<std::string_view> words(line.words.begin(), comment);
  if (words.size() == 3 && words[0] == "d" && words[1] == "-halo") words.erase(words.begin() + 1);
  return words;
}

// What single precision makes of a 1 on its way from program to program.
constexpr double kRounding = 1e-5;
// Shares above it are no strengths of a highlight that somebody turned up, but numbers of another scale.
constexpr double kMostShare = 10;

// Numbers that were brought into their range, of one file.
struct CorrectedNumbers {
  std::size_t count = 0;
  std::string first;  // with its place and what was taken

  void add(const NumberRule& rule, std::string_view word, double taken, const std::string& where) {
    if (count++ == 0) first = fmt::format("{}: '{} {}' is taken as {}", where, rule.keyword, word, taken);
  }
  std::string warning() const {
    return fmt::format("{}, which is the end of its range{}.", first,
                       count > 1 ? fmt::format(", as are {} more numbers of the file", count - 1) : "");
  }
};

// The number nearest to `value` that a statement may have; none if `value` is no error of a known kind.
std::optional<double> within_range(const NumberRule& rule, double value) {
  if (value >= rule.low && value <= rule.high) return value;
  if (rule.high == 1 && value > 1 && value <= kMostShare) return 1;
  if (rule.keyword == "Ns" && value < 0) return 0;  // as exporters write of surfaces without a highlight
  return std::nullopt;
}

std::string checked_numbers(const NumberRule& rule, const TextLine& line, const std::string& where,
                            CorrectedNumbers& corrected) {
  const std::vector<std::string_view> words = words_of_numbers(line);
  const std::size_t count = words.size() - 1;
  if (count > 0 && (words[1] == "spectral" || words[1] == "xyz"))
    throw InputError(where, fmt::format("'{} {}' is not supported", rule.keyword, words[1]),
                     "Give red, green, blue.");
  if (count < rule.least || count > rule.most || count == 2)
    throw InputError(where, fmt::format("'{}' has {} numbers", rule.keyword, count),
                     rule.most == 3 ? "Give red, green, blue." : "Give one number.");
  std::vector<std::string> numbers;
  Spectrum values = Spectrum::Zero(static_cast<Eigen::Index>(count));
  for (std::size_t i = 1; i <= count; ++i) {
    const auto written = parse_number(words[i]);
    const auto value = written ? within_range(rule, *written) : std::nullopt;
    if (!value)
      throw InputError(where, fmt::format("'{} {}' is not a number in its range", rule.keyword, words[i]),
                       rule.high != 1                     ? "Give a finite number of 0 or more."
                       : written && *written > kMostShare ? "Give a fraction from 0 to 1: 255 is 1 there."
                                                          : "Give a fraction from 0 to 1.");
    if (std::abs(*value - *written) > kRounding) corrected.add(rule, words[i], *value, where);
    values[static_cast<Eigen::Index>(i - 1)] = *value;
    numbers.push_back(*value != *written ? fmt::format("{}", *value) : std::string(words[i]));
  }
  if (rule.keyword == "Ke") {
    const std::string problem = strength_problem(values, "the radiance Ke [W/(m2 sr)]");
    if (!problem.empty()) throw InputError(where, problem, kStrengthAdvice);
  }
  if (rule.most == 3 && count == 1) numbers.resize(3, numbers.front());  // one stands for all three
  return fmt::format("{} {}\n", rule.keyword, fmt::join(numbers, " "));
}

// What a material says of its emission.
struct EmissionStatements {
  std::string material;
  bool has_factor = false, has_map = false;

  // Programs leave Ke out where an image has its place, and without it the image would emit nothing.
  std::string completed(const std::string& file, std::vector<std::string>& notes) const {
    if (!has_map || has_factor) return "";
    notes.push_back(fmt::format("{}: material '{}' has a map_Ke without Ke, which is taken as 1 W/(m2 sr).",
                                file, material));
    return "Ke 1 1 1\n";
  }
};

}  // namespace

std::string checked_mtl_text(const std::string& text, const std::string& name,
                             std::vector<std::string>& notes, std::vector<std::string>& warnings) {
  std::string clean;
  bool in_material = false, has_stray = false;
  EmissionStatements emission;
  CorrectedNumbers corrected;
  for (const TextLine& line : split_lines(text)) {
    if (line.words[0][0] == '#') continue;
    const std::string where = at_line(name, line.number);
    if (line.words[0] == "newmtl") {
      in_material = true;
      clean += emission.completed(name, notes);
      emission = {line.words.size() < 2 ? kNoMaterialName : rest_of(line, 1)};
      clean += fmt::format("newmtl {}\n", emission.material);
      continue;
    } else if (!in_material) {
      if (!has_stray)
        warnings.push_back(
            fmt::format("{}: '{}' is ignored, as is all before the first 'newmtl'.", where, line.words[0]));
      has_stray = true;
      continue;
    }
    emission.has_factor = emission.has_factor || line.words[0] == "Ke";
    emission.has_map = emission.has_map || line.words[0] == "map_Ke";
    const auto* rule = std::find_if(kObjRules.begin(), kObjRules.end(),
                                    [&](const NumberRule& r) { return r.keyword == line.words[0]; });
    if (rule != kObjRules.end())
      clean += checked_numbers(*rule, line, where, corrected);
    else
      clean += fmt::format("{} {}\n", line.words[0], rest_of(line, 1));
  }
  if (corrected.count > 0) warnings.push_back(corrected.warning());
  return clean + emission.completed(name, notes);
}

}  // namespace reemit

#include "scenes/io/photometry/eulumdat_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenes/io/common/text_parse.h"

namespace reemit {

std::string_view EulumdatText::line(const char* what) {
  std::string_view found;
  if (!text_.next_line(found))
    fail(fmt::format("the file ends before {}", what), "Was it copied completely?");
  return found;
}

double EulumdatText::parsed(std::string_view word, const char* what) const {
  std::string number(word);
  std::replace(number.begin(), number.end(), ',', '.');
  const auto value = parse_number(number);
  constexpr std::size_t kShown = 24;
  if (!value)
    fail(fmt::format("'{}' is not a number, where {} should stand", word.substr(0, kShown), what),
         "Is a line missing above, or one too many? EULUMDAT has one value a line in a fixed order.");
  return *value;
}

std::string EulumdatText::text(const char* what) {
  return std::string(line(what));
}

double EulumdatText::number_or(const char* what, double otherwise) {
  const std::string_view found = line(what);
  return found.empty() ? otherwise : parsed(found.substr(0, found.find_first_of(" \t")), what);
}

double EulumdatText::size(const char* what) {
  const double value = number_or(what, 0);
  if (!(value >= 0)) fail(fmt::format("{} is {}", what, value), "Give 0 or more.");
  return value;
}

int EulumdatText::integer(const char* what, int least, int most) {
  const double value = number_or(what, std::nan(""));
  if (!(value >= least && value <= most) || value != std::floor(value))
    fail(fmt::format("{} is {}", what, std::isnan(value) ? "missing" : fmt::format("{}", value)),
         fmt::format("It must be a whole number from {} to {}.", least, most));
  return static_cast<int>(value);
}

std::vector<double> EulumdatText::numbers(std::size_t count, const char* what) {
  std::vector<double> values;
  while (values.size() < count) {
    const std::string described = fmt::format("number {} of {} {}", values.size() + 1, count, what);
    const std::string_view found = line(described.c_str());
    for (const TextLine& words : split_lines(found)) {
      if (values.size() + words.words.size() > count)
        fail(fmt::format("'{}' is more than the {} {}", found.substr(0, 24), count, what),
             "Check the counts of planes and angles.");
      for (const std::string_view word : words.words) values.push_back(parsed(word, described.c_str()));
    }
  }
  return values;
}

}  // namespace reemit

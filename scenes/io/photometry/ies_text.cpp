#include "scenes/io/photometry/ies_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenes/io/common/text_file.h"
#include "scenes/io/common/text_parse.h"
#include "scenes/model/error.h"

namespace reemit {
namespace {

constexpr std::uintmax_t kLargestIes = std::uintmax_t{64} << 20;

// Blanks, commas, and what editors of old systems leave at the end of a file (Ctrl-Z, NUL).
constexpr std::string_view kBetween{" \t\v\f,\x1a\0", 7};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank{" \t\v\f\r\x1a\0", 7};
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

}  // namespace

IesText::IesText(const std::filesystem::path& file)
    : name_(file.lexically_normal().string()), text_(load_file(file, kLargestIes)), rest_(text_) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (rest_.starts_with(kMark)) rest_.remove_prefix(kMark.size());
}

bool IesText::next_line(std::string_view& line) {
  if (rest_.empty()) return false;
  line_ = next_line_++;
  const std::size_t end = rest_.find_first_of("\r\n");
  line = trimmed(rest_.substr(0, end));
  if (end == std::string_view::npos) {
    rest_ = {};
    return true;
  }
  const bool both = rest_[end] == '\r' && end + 1 < rest_.size() && rest_[end + 1] == '\n';
  rest_.remove_prefix(end + (both ? 2 : 1));
  return true;
}

bool IesText::next_word(std::string_view& word) {
  while (!rest_.empty()) {
    const char c = rest_.front();
    if (c == '\n' || c == '\r') {
      const bool both = c == '\r' && rest_.size() > 1 && rest_[1] == '\n';
      rest_.remove_prefix(both ? 2 : 1);
      ++next_line_;
    } else if (kBetween.find(c) != std::string_view::npos) {
      rest_.remove_prefix(1);
    } else {
      std::size_t end = 0;
      while (end < rest_.size() && rest_[end] != '\n' && rest_[end] != '\r' &&
             kBetween.find(rest_[end]) == std::string_view::npos)
        ++end;
      word = rest_.substr(0, end);
      rest_.remove_prefix(end);
      line_ = next_line_;
      return true;
    }
  }
  return false;
}

double IesText::value(const char* what, std::size_t index, std::size_t count) {
  const auto described = [&] {
    return count > 1 ? fmt::format("number {} of {} {}", index + 1, count, what) : std::string(what);
  };
  std::string_view word;
  if (!next_word(word)) fail("the file ends before " + described(), "Was it copied completely?");
  const auto number = parse_number(word);
  constexpr std::size_t kShown = 24;
  if (!number)
    fail(fmt::format("'{}' is not a number, where {} should stand", word.substr(0, kShown), described()),
         "Are the counts of angles and values before it right?");
  return *number;
}

double IesText::number(const char* what) {
  return value(what, 0, 1);
}

double IesText::positive(const char* what) {
  const double value = number(what);
  if (!(value > 0))
    fail(fmt::format("{} is {}", what, value), "It must be above 0, or the luminaire gives no light.");
  return value;
}

int IesText::integer(const char* what, int least, int most) {
  const double value = number(what);
  if (!(value >= least && value <= most) || value != std::floor(value))
    fail(fmt::format("{} is {}", what, value),
         fmt::format("It must be a whole number from {} to {}.", least, most));
  return static_cast<int>(value);
}

std::vector<double> IesText::numbers(std::size_t count, const char* what, std::vector<std::uint32_t>* lines) {
  // A number takes two characters at least, with what parts it from the next.
  if (count > rest_.size() / 2 + 1)
    fail(fmt::format("the file is too short for {} {}", count, what),
         "Check the counts of vertical and horizontal angles.");
  std::vector<double> values;
  values.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(value(what, i, count));
    if (lines != nullptr) lines->push_back(line_);
  }
  return values;
}

std::string IesText::rest_as_text() {
  std::string_view word;
  if (!next_word(word)) return "";
  const std::size_t more = std::min(rest_.find_first_of("\r\n"), rest_.size());
  const std::string_view line = trimmed({word.data(), word.size() + more});
  constexpr std::size_t kShown = 24;
  const std::string_view shown = line.substr(0, kShown);
  if (line.find_first_not_of("0123456789+-.,eE \t") == std::string_view::npos)
    fail(fmt::format("'{}' comes after the last value", shown),
         "There are more values than the counts of vertical and horizontal angles say: correct the counts.");
  rest_ = {};
  return fmt::format("{}: what follows the last value is not read: '{}'", where(), shown);
}

std::string IesText::where() const {
  return at_line(name_, std::max<std::uint32_t>(line_, 1));
}

void IesText::fail(const std::string& problem, const std::string& advice) const {
  throw InputError(where(), problem, advice);
}

void IesText::fail_at(std::uint32_t line, const std::string& problem, const std::string& advice) const {
  throw InputError(at_line(name_, line), problem, advice);
}

}  // namespace reemit

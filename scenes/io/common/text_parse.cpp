#include "scenes/io/common/text_parse.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace reemit {
namespace {

template <class Number>
std::optional<Number> parse_whole(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\0';
}

// Length of the line end at `i`, 0 if there is none.
std::size_t line_end_at(std::string_view text, std::size_t i) {
  if (i >= text.size()) return 0;
  if (text[i] == '\n') return 1;
  if (text[i] != '\r') return 0;
  return i + 1 < text.size() && text[i + 1] == '\n' ? 2 : 1;
}

}  // namespace

std::optional<double> parse_number(std::string_view word) {
  const std::optional<double> value = parse_whole<double>(word);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<std::int64_t> parse_integer(std::string_view word) {
  return parse_whole<std::int64_t>(word);
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return result;
}

std::string lower_case_extension(const std::filesystem::path& file) {
  return lower_case(file.extension().string());
}

std::string at_line(const std::string& file, std::uint32_t line) {
  return fmt::format("{}:{}", file, line);
}

std::string rest_of(const TextLine& line, std::size_t first) {
  if (first >= line.words.size()) return "";
  const std::string_view last = line.words.back();
  return {line.words[first].data(), last.data() + last.size()};
}

std::vector<TextLine> split_lines(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::vector<TextLine> lines;
  TextLine line{1, {}};
  std::uint32_t physical = 1;
  const auto finish_line = [&] {
    if (!line.words.empty()) lines.push_back(std::move(line));
    line = TextLine{physical, {}};
  };
  for (std::size_t i = 0; i < text.size();) {
    if (const std::size_t end = line_end_at(text, i); end > 0) {
      i += end;
      ++physical;
      finish_line();
    } else if (is_blank(text[i])) {
      ++i;
    } else if (const std::size_t joined = text[i] == '\\' ? line_end_at(text, i + 1) : 0; joined > 0) {
      i += 1 + joined;
      ++physical;
    } else {
      const std::size_t begin = i;
      while (i < text.size() && !is_blank(text[i]) && line_end_at(text, i) == 0 &&
             !(text[i] == '\\' && line_end_at(text, i + 1) > 0))
        ++i;
      line.words.push_back(text.substr(begin, i - begin));
    }
  }
  finish_line();
  return lines;
}

}  // namespace reemit

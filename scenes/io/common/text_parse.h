#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace reemit {

/// A whole word as a finite number; nothing if any character is left over, or it is infinite or not a number.
/// Independent of the locale.
std::optional<double> parse_number(std::string_view word);

/// A whole word as a decimal integer; nothing if any character is left over or it does not fit.
std::optional<std::int64_t> parse_integer(std::string_view word);

/// Letters of ASCII alone, whatever the locale.
std::string lower_case(std::string_view text);

/// With its dot: ".glb" of "Room.GLB".
std::string lower_case_extension(const std::filesystem::path& file);

/// "file:line".
std::string at_line(const std::string& file, std::uint32_t line);

/// The words of one logical line of a text file; views into the text that was split.
struct TextLine {
  std::uint32_t number = 0;  ///< Of its first physical line, from 1.
  std::vector<std::string_view> words;
};

/// The line from word `first` on as it stands, blanks inside kept, as names may have them; empty if there is
/// no such word.
std::string rest_of(const TextLine& line, std::size_t first);

/// Splits text into its non-blank lines. A backslash at the end of a line joins the next one to it; LF, CRLF
/// and CR end lines. A byte order mark of UTF-8 is passed over. The text must outlive the result.
std::vector<TextLine> split_lines(std::string_view text);

}  // namespace reemit

#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace reemit {

/// The text of an LM-63 file: lines by number, then numbers that stand free-form over lines, apart by blanks
/// and commas. Every failure is an InputError with file and line.
class IesText {
 public:
  /// Loads the file; a byte order mark is skipped.
  explicit IesText(const std::filesystem::path& file);
  IesText(const IesText&) = delete;
  IesText& operator=(const IesText&) = delete;

  /// The next line without its end and the blanks around it; false at the end of the file.
  bool next_line(std::string_view& line);
  /// Number of the line read last, from 1.
  std::uint32_t line() const { return line_; }

  double number(const char* what);
  double positive(const char* what);
  /// A whole number in [least, most].
  int integer(const char* what, int least, int most);
  /// `count` numbers; `lines` receives the line of each if given.
  std::vector<double> numbers(std::size_t count, const char* what,
                              std::vector<std::uint32_t>* lines = nullptr);
  /// Skips text that follows the last value, such as END or a remark, and says what to warn of; empty if only
  /// blanks are left. A line of numbers means that the counts before it are wrong.
  std::string rest_as_text();

  std::string where() const;  ///< file:line
  [[noreturn]] void fail(const std::string& problem, const std::string& advice) const;
  [[noreturn]] void fail_at(std::uint32_t line, const std::string& problem, const std::string& advice) const;

 private:
  bool next_word(std::string_view& word);
  double value(const char* what, std::size_t index, std::size_t count);

  std::string name_;
  std::string text_;
  std::string_view rest_;
  std::uint32_t line_ = 0;       // of what was read last
  std::uint32_t next_line_ = 1;  // of what is read next
};

}  // namespace reemit

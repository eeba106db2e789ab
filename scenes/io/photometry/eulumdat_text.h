#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "scenes/io/photometry/ies_text.h"

namespace reemit {

/// The text of a EULUMDAT file: one value a line, in a fixed order, lines of text among them; a decimal comma
/// counts as a point. Every failure is an InputError with file and line.
class EulumdatText {
 public:
  explicit EulumdatText(const std::filesystem::path& file) : text_(file) {}

  std::string text(const char* what);
  /// A whole number in [least, most].
  int integer(const char* what, int least, int most);
  /// The number of a line, `otherwise` if the line is blank.
  double number_or(const char* what, double otherwise);
  /// A length of 0 or more; a blank line means 0.
  double size(const char* what);
  /// `count` numbers on the next lines, blank ones skipped.
  std::vector<double> numbers(std::size_t count, const char* what);
  /// As IesText.
  std::string rest_as_text() { return text_.rest_as_text(); }

  std::string where() const { return text_.where(); }
  [[noreturn]] void fail(const std::string& problem, const std::string& advice) const {
    text_.fail(problem, advice);
  }

 private:
  std::string_view line(const char* what);
  double parsed(std::string_view word, const char* what) const;
  IesText text_;
};

}  // namespace reemit

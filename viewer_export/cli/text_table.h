#pragma once
#include <string>
#include <vector>

#include "viewer_export/formats/export_info.h"

namespace reemit::cli {

/// Columns of text for people: the first is aligned left, the others right.
class TextTable {
 public:
  /// Cells beyond the longest row so far make new columns; missing ones stay empty.
  void row(std::vector<std::string> cells);
  void blank_line() { rows_.emplace_back(); }
  /// All rows, each ended by a newline, without trailing spaces.
  std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// Six significant digits, as in all tables.
std::string number_text(double value);
/// "1.25 %", or "not known" unless finite.
std::string percent_text(double share);

/// The achieved error of exported values; infinite where it is not known, which JSON shows as null.
double known_error(const ExportInfo& info);

}  // namespace reemit::cli

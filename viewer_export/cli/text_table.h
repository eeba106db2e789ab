#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "scenes/model/bands.h"

namespace reemit::cli {

/// Columns of text for people: the first is aligned left, the others right.
class TextTable {
 public:
  /// Cells beyond the longest row so far make new columns; missing ones stay empty.
  void row(std::vector<std::string> cells);
  /// All rows, each ended by a newline, without trailing spaces.
  std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// Six significant digits, as in all tables.
std::string number_text(double value);
/// A value and its standard error: the error with two digits, the value to the same place; "not known" for an
/// infinite error and "exact" for none.
std::pair<std::string, std::string> estimate_texts(double value, double standard_error);

/// Long tables are cut after this many rows.
inline constexpr std::size_t kMostRows = 40;
/// The line that says so; empty unless it is true.
std::string rest_text(std::size_t rows, const std::string& of_what);

/// Heads of the columns of a quantity: one per band, or lowest and highest where bands are many.
void add_band_heads(std::vector<std::string>& cells, const std::string& quantity, const BandSet& bands);
/// Its cells.
void add_band_cells(std::vector<std::string>& cells, const Spectrum& value);

/// "1.25 %", or "not known" unless finite.
std::string percent_text(double share);
/// With two digits: of an estimate from few points.
std::string rough_percent_text(double share);

}  // namespace reemit::cli

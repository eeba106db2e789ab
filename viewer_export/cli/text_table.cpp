#include "viewer_export/cli/text_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace reemit::cli {
namespace {

constexpr std::size_t kMostBandColumns = 4;

}  // namespace

void TextTable::row(std::vector<std::string> cells) {
  rows_.push_back(std::move(cells));
}

std::string TextTable::text() const {
  std::vector<std::size_t> widths;
  for (const auto& row : rows_) {
    widths.resize(std::max(widths.size(), row.size()));
    // A lone cell is a heading and may run across the columns.
    if (row.size() == 1) continue;
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += i == 0 ? fmt::format("{:<{}}", row[i], widths[i]) : fmt::format("  {:>{}}", row[i], widths[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

std::string number_text(double value) {
  return fmt::format("{:.6g}", value);
}

std::pair<std::string, std::string> estimate_texts(double value, double standard_error) {
  if (!std::isfinite(standard_error)) return {number_text(value), "not known"};
  if (!(standard_error > 0)) return {number_text(value), "exact"};
  // Decimals that show two digits of the error; rounding noise is shown as if it were an error.
  const int digits = 1 - static_cast<int>(std::floor(std::log10(standard_error)));
  if (digits < 0 || digits > 9) return {number_text(value), fmt::format("{:.2g}", standard_error)};
  return {fmt::format("{:.{}f}", value, digits), fmt::format("{:.{}f}", standard_error, digits)};
}

std::string rest_text(std::size_t rows, const std::string& of_what) {
  if (rows <= kMostRows) return "";
  return fmt::format("  ... and {} more {}; --json lists all\n", rows - kMostRows, of_what);
}

void add_band_heads(std::vector<std::string>& cells, const std::string& quantity, const BandSet& bands) {
  if (bands.count() > kMostBandColumns) {
    cells.insert(cells.end(), {quantity + " lowest", quantity + " highest"});
    return;
  }
  for (const std::string& band : bands.names()) cells.push_back(fmt::format("{} {}", quantity, band));
}

void add_band_cells(std::vector<std::string>& cells, const Spectrum& value) {
  if (static_cast<std::size_t>(value.size()) > kMostBandColumns) {
    cells.insert(cells.end(), {number_text(value.minCoeff()), number_text(value.maxCoeff())});
    return;
  }
  for (const double v : value) cells.push_back(number_text(v));
}

std::string percent_text(double share) {
  if (!std::isfinite(share)) return "not known";
  return fmt::format("{:.3g} %", 100 * share);
}

std::string rough_percent_text(double share) {
  const double percent = 100 * share;
  return percent >= 99.5 ? fmt::format("{:.0f} %", percent) : fmt::format("{:.2g} %", percent);
}

}  // namespace reemit::cli

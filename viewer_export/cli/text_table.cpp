#include "viewer_export/cli/text_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace reemit::cli {

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

std::string percent_text(double share) {
  if (!std::isfinite(share)) return "not known";
  return fmt::format("{:.3g} %", 100 * share);
}

double known_error(const ExportInfo& info) {
  return info.error > 0 ? info.error : std::numeric_limits<double>::infinity();
}

}  // namespace reemit::cli

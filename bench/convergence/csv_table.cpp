#include "bench/convergence/csv_table.h"

#include <fstream>

#include <fmt/format.h>

namespace reemit::bench {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  for (std::size_t from = 0;;) {
    const std::size_t comma = line.find(',', from);
    cells.push_back(line.substr(from, comma - from));
    if (comma == std::string::npos) return cells;
    from = comma + 1;
  }
}

}  // namespace

CsvTable read_csv(const std::filesystem::path& file, const std::string& header) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(fmt::format("{} cannot be read", file.string()));
  const std::size_t columns = cells_of(header).size();
  CsvTable table;
  bool header_seen = false;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.starts_with("# ")) {
      table.notes.push_back(line.substr(2));
    } else if (!header_seen) {
      if (line != header) break;
      header_seen = true;
    } else {
      table.rows.push_back(cells_of(line));
      if (table.rows.back().size() != columns)
        throw std::runtime_error(fmt::format("{}:{}: {} columns expected", file.string(), number, columns));
    }
  }
  if (!header_seen)
    throw std::runtime_error(fmt::format("{} is not a table that this program has written", file.string()));
  return table;
}

}  // namespace reemit::bench

#include "bench/convergence/measurement.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ostream.h>

namespace reemit::bench {
namespace {

constexpr const char* kHeader =
    "room,quantity,method,seed,level,seconds,work,work_unit,error_rms,error_median,reference_rms,reference_"
    "median";

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace

void write_table(const Table& table, const std::filesystem::path& file) {
  std::ofstream out(file);
  for (const std::string& note : table.notes) fmt::print(out, "# {}\n", note);
  fmt::print(out, "{}\n", kHeader);
  for (const Measurement& m : table.rows)
    fmt::print(out, "{},{},{},{},{},{:.5g},{:.6g},{},{:.4g},{:.4g},{:.4g},{:.4g}\n", m.room, m.quantity,
               m.method, m.seed, m.level, m.seconds, m.work, m.work_unit, m.error.rms, m.error.median,
               m.reference.rms, m.reference.median);
  if (!out.flush()) throw std::runtime_error(fmt::format("{} cannot be written", file.string()));
}

Table read_table(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(fmt::format("{} cannot be read", file.string()));
  Table table;
  bool header_seen = false;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.starts_with("# ")) {
      table.notes.push_back(line.substr(2));
    } else if (!header_seen) {
      if (line != kHeader) break;
      header_seen = true;
    } else {
      const std::vector<std::string> c = cells_of(line);
      if (c.size() != 12)
        throw std::runtime_error(fmt::format("{}:{}: 12 columns expected", file.string(), number));
      table.rows.push_back({c[0],
                            c[1],
                            c[2],
                            std::stoull(c[3]),
                            std::stoi(c[4]),
                            std::stod(c[5]),
                            std::stod(c[6]),
                            c[7],
                            {std::stod(c[8]), std::stod(c[9])},
                            {std::stod(c[10]), std::stod(c[11])}});
    }
  }
  if (!header_seen)
    throw std::runtime_error(fmt::format("{} is not a table that this program has written", file.string()));
  return table;
}

}  // namespace reemit::bench

#include "bench/convergence/measurement.h"

#include <fstream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ostream.h>

#include "bench/convergence/csv_table.h"

namespace reemit::bench {
namespace {

constexpr const char* kHeader =
    "room,quantity,method,seed,level,seconds,work,work_unit,error_rms,error_median,reference_rms,reference_"
    "median";

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
  CsvTable cells = read_csv(file, kHeader);
  Table table;
  table.notes = std::move(cells.notes);
  for (const std::vector<std::string>& c : cells.rows)
    table.rows.push_back({c[0],
                          c[1],
                          c[2],
                          number_of<std::uint64_t>(c[3], file),
                          number_of<int>(c[4], file),
                          number_of<double>(c[5], file),
                          number_of<double>(c[6], file),
                          c[7],
                          {number_of<double>(c[8], file), number_of<double>(c[9], file)},
                          {number_of<double>(c[10], file), number_of<double>(c[11], file)}});
  return table;
}

}  // namespace reemit::bench

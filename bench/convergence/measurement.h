#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace reemit::bench {

/// The two figures for how far values are off, as fractions.
struct ErrorPair {
  double rms = 0;
  double median = 0;
};

/// One run of one method.
struct Measurement {
  std::string room;
  std::string quantity;  ///< "zones", "vertices" or "still".
  std::string method;
  std::uint64_t seed = 1;
  int level = 0;  ///< Runs of one method with the same level differ only in their seed.
  double seconds = 0;
  double work = 0;
  std::string work_unit;  ///< "rays" or "samples per ...".
  ErrorPair error;        ///< As measured: the reference's noise is still in it.
  ErrorPair reference;    ///< Error of the reference.
};

/// All runs, and what a reader must know about them, one line each.
struct Table {
  std::vector<std::string> notes;
  std::vector<Measurement> rows;
};

/// CSV, notes first, each behind "# ". Throws std::runtime_error when the file cannot be written or read, or
/// is not such a table.
void write_table(const Table& table, const std::filesystem::path& file);
Table read_table(const std::filesystem::path& file);

}  // namespace reemit::bench

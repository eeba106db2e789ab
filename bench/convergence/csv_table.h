#pragma once
#include <charconv>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

namespace reemit::bench {

/// What a measuring program wrote for its page: notes for the reader first, each behind "# ", then rows of
/// cells, which hold no commas.
struct CsvTable {
  std::vector<std::string> notes;
  std::vector<std::vector<std::string>> rows;
};

/// Throws std::runtime_error when the file cannot be read, does not have this header, or has a row of another
/// number of cells.
CsvTable read_csv(const std::filesystem::path& file, const std::string& header);

/// A whole cell as a number. Throws std::runtime_error, which names the file, if it is none.
template <class Number>
Number number_of(const std::string& cell, const std::filesystem::path& file) {
  Number value{};
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size())
    throw std::runtime_error(file.string() + ": '" + cell + "' is not a number");
  return value;
}

}  // namespace reemit::bench

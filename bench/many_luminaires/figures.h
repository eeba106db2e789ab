#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/convergence/curve.h"

namespace reemit::bench {

/// One measured number.
struct Figure {
  std::string part;       ///< Section of the page: "sphereflake", "panels", "growth".
  std::string subject;    ///< What was lit: a set of points, a level of samples, a kind of luminaire.
  std::size_t count = 0;  ///< Luminaires, or samples per pixel in the section of the stills.
  std::string selection;  ///< Name of the selection, "one lamp", or empty.
  std::string quantity;   ///< With its unit.
  Spread value;           ///< Over rounds or seeds.
};

/// All figures, and what a reader must know about them, one line each.
struct Figures {
  std::vector<std::string> notes;
  std::vector<Figure> rows;

  /// Adds the row and prints it to stderr.
  void add(Figure row);
  /// Null if there is no such row.
  const Figure* find(const std::string& part, const std::string& subject, std::size_t count,
                     const std::string& selection, const std::string& quantity) const;
};

/// CSV, notes first, each behind "# ". Throws std::runtime_error when the file cannot be written or read, or
/// is not such a table.
void write_figures(const Figures& figures, const std::filesystem::path& file);
Figures read_figures(const std::filesystem::path& file);

}  // namespace reemit::bench

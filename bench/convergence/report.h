#pragma once
#include <filesystem>
#include <string>

#include "bench/convergence/measurement.h"

namespace reemit::bench {

/// Writes folder/convergence.md from the template page.md.in with the tables of this measurement. Throws
/// std::runtime_error when a file cannot be read or written.
void write_page(const Table& table, const std::filesystem::path& folder);

/// Draws folder/images/convergence_<quantity>_<room>.svg with gnuplot. False, and nothing drawn, when gnuplot
/// does not run.
bool draw_plots(const Table& table, const std::filesystem::path& folder);

/// Name of a plot's file, without folder.
std::string plot_name(const std::string& quantity, const std::string& room);

}  // namespace reemit::bench

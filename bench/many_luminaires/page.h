#pragma once
#include <filesystem>

#include "bench/many_luminaires/figures.h"

namespace reemit::bench {

/// Writes folder/many_luminaires.md from the template page.md.in with the tables of these figures. Parts that
/// were not measured have empty tables. Throws std::runtime_error when a file cannot be read or written.
void write_many_luminaires_page(const Figures& figures, const std::filesystem::path& folder);

/// Draws folder/images/many_luminaires_stills.svg and many_luminaires_growth.svg with gnuplot. False, and
/// nothing drawn, when gnuplot does not run. Throws std::runtime_error when it ends with an error.
bool plot_many_luminaires(const Figures& figures, const std::filesystem::path& folder);

}  // namespace reemit::bench

#pragma once
#include <filesystem>
#include <vector>

#include "bench/validation/cube_convergence.h"
#include "bench/validation/validation_row.h"

namespace reemit::validation {

/// Throws ResourceError with what to install when gnuplot is not there.
void require_gnuplot();

/// Histogram of the deviations of noisy rows against Student's t, as SVG. Throws ResourceError when gnuplot
/// fails.
void plot_deviations(const std::vector<ValidationRow>& rows, const std::filesystem::path& svg);

/// Deviation of the zone and of gathers from the continuous solution at one point, by the size of zones, as
/// SVG.
void plot_convergence(const std::vector<CubeStep>& steps, const std::filesystem::path& svg);

}  // namespace reemit::validation

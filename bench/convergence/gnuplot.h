#pragma once
#include <string>

namespace reemit::bench {

bool gnuplot_runs();

/// Commands for a gnuplot of their own. Throws std::runtime_error when it does not start or ends with an
/// error.
void run_gnuplot(const std::string& commands);

}  // namespace reemit::bench

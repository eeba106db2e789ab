#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "bench/zone_plans/plan_plot.h"

namespace reemit::bench {

/// Head of the table that row_text continues, with the line below it.
std::string plan_table_head();
/// A line of the table.
std::string row_text(const PlanRow& row);
/// Reads a table back, as precisely as it was printed. Throws std::runtime_error with file and line where a
/// line is not one of a table.
std::vector<PlanRow> read_plan_table(const std::filesystem::path& file);

}  // namespace reemit::bench

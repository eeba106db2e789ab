#include "bench/zone_plans/plan_table.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

namespace reemit::bench {
namespace {

constexpr const char* kFitting = "fit the light";
constexpr std::size_t kColumns = 13;

std::string percent(double value) {
  return value > 0 ? fmt::format("{:.2f} %", 100 * value) : "-";
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  std::string cell;
  std::getline(stream, cell, '|');  // before the first bar
  while (std::getline(stream, cell, '|'))
    if (cell.size() >= 2) cells.push_back(cell.substr(1, cell.size() - 2));
  return cells;
}

double fraction(const std::string& text) {
  return text == "-" ? 0 : std::stod(text) / 100;
}

}  // namespace

std::string plan_table_head() {
  return "| room | zones | number | lit | zoning [s] | solve [s] | Mray/s | noise | points | gathered light "
         "| "
         "picture of zones | export | wrong area |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
}

std::string row_text(const PlanRow& r) {
  return fmt::format("| {} | {} | {} | {} | {:.2f} | {:.1f} | {:.1f} | {:.3f} % | {} | {} | {} | {} | {} |\n",
                     r.room, r.fitting ? kFitting : "of one size", r.zones, r.lit, r.zoning_s, r.solve_s,
                     r.rays_per_s / 1e6, 100 * r.noise, percent(r.points), percent(r.gathered),
                     percent(r.picture_zones), percent(r.exported), percent(r.wrong_area));
}

std::vector<PlanRow> read_plan_table(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  std::vector<PlanRow> rows;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::vector<std::string> c = cells_of(line);
    if (c.empty() || c[0] == "room" || c[0].starts_with("-")) continue;
    try {
      if (c.size() != kColumns) throw std::invalid_argument("columns");
      rows.push_back({c[0], c[1] == kFitting, std::stoul(c[2]), std::stoul(c[3]), std::stod(c[4]),
                      std::stod(c[5]), 1e6 * std::stod(c[6]), fraction(c[7]), fraction(c[8]), fraction(c[9]),
                      fraction(c[10]), fraction(c[11]), fraction(c[12])});
    } catch (const std::logic_error&) {
      throw std::runtime_error(
          fmt::format("{}:{}: this is no line of a table of zones", file.string(), number));
    }
  }
  return rows;
}

}  // namespace reemit::bench

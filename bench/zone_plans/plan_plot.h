#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace reemit::bench {

/// One solve of a room.
struct PlanRow {
  std::string room;
  bool fitting = false;  ///< Zones that fit the light, or of one size.
  std::size_t zones = 0;
  std::size_t lit = 0;
  double zoning_s = 0;  ///< Meshing and choosing zones.
  double solve_s = 0;
  double rays_per_s = 0;
  double noise = 0;          ///< Relative standard error of zones.
  double points = 0;         ///< Points against their zones, relative; 0 = not known.
  double gathered = 0;       ///< Error that zones leave in gathered light, relative; 0 = not known.
  double picture_zones = 0;  ///< Error of a picture that shows the zones, relative.
  double exported = 0;       ///< Export against points between its vertices, relative.
  double wrong_area = 0;     ///< Share of its area where that is far off (ExportDifference).
};

/// Draws the picture and point errors against zones (`by_time` false) or against seconds of zoning and
/// solving, as SVG. Throws std::runtime_error if gnuplot does not run.
void draw_plans(const std::vector<PlanRow>& rows, bool by_time, const std::filesystem::path& file);

}  // namespace reemit::bench

#include "solver/solution/opposite_zones.h"

#include <map>

#include "mesh/zones/side_cell.h"

namespace reemit {
namespace {

/// A cell is looked at in the middles of kRowsOfCell^2 equal parts.
constexpr int kRowsOfCell = 4;

class AreaBehind {
 public:
  explicit AreaBehind(const ZoneMesh& mesh) : mesh_(mesh) {}

  void add(const SideCell& cell, double area) {
    for (int i = 0; i < kRowsOfCell; ++i)
      for (int j = 0; i + j < kRowsOfCell; ++j) {
        add_point(cell, i + 1.0 / 3, j + 1.0 / 3, area);
        if (i + j + 1 < kRowsOfCell) add_point(cell, i + 2.0 / 3, j + 2.0 / 3, area);
      }
  }

  std::vector<ZoneShare> shares() const {
    std::vector<ZoneShare> result;
    for (const auto& [zone, area] : area_) result.push_back({ZoneId(zone), area / all_});
    return result;
  }

 private:
  void add_point(const SideCell& cell, double i, double j, double area) {
    const SidePoint x =
        cell_point(cell, static_cast<float>(i / kRowsOfCell), static_cast<float>(j / kRowsOfCell));
    const ZoneId zone =
        mesh_.zone_at(x.triangle, static_cast<float>(x.at.u), static_cast<float>(x.at.v), !x.front);
    if (!zone.valid()) return;
    area_[zone.index()] += area;
    all_ += area;
  }

  const ZoneMesh& mesh_;
  std::map<std::size_t, double> area_;  // by zone
  double all_ = 0;
};

}  // namespace

std::vector<ZoneShare> opposite_zones(const ZoneMesh& mesh, ZoneId zone) {
  AreaBehind behind(mesh);
  if (!mesh.is_group(zone)) {
    behind.add(mesh.zone_cell(zone), 1);
    return behind.shares();
  }
  for (std::uint32_t m = 0; m < mesh.member_count(zone); ++m) {
    const TriangleId t = mesh.member_triangle(zone, m);
    behind.add({t, mesh.zone_is_front(zone), {}}, mesh.triangle_area(t));
  }
  return behind.shares();
}

}  // namespace reemit

#include "mesh/zones/zone_cells.h"

namespace reemit {

std::array<Vec3, 3> corner_points(const ZoneMesh& mesh, const SideCell& cell) {
  std::array<Vec3, 3> points;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [u, v] = cell.corners.corner(k);
    points[k] = mesh.point(cell.triangle, u, v);
  }
  return points;
}

double cell_area(const ZoneMesh& mesh, const SideCell& cell) {
  return mesh.triangle_area(cell.triangle) * cell.corners.share();
}

ZoneCells::ZoneCells(const ZoneMesh& mesh) : mesh_(&mesh) {
  first_.reserve(mesh.side_count() + 1);
  std::size_t next_zone = 0;
  for (std::size_t s = 0; s < mesh.side_count(); ++s) {
    first_.push_back(side_.size());
    const SideId side(s);
    if (!mesh.has_zones(side)) continue;
    std::size_t cells = 0;
    if (mesh.is_group(mesh.first_zone(triangle_of(side), is_front(side)))) {
      const std::size_t n = mesh.triangle(triangle_of(side)).divisions;
      cells = n * n;
    } else {
      for (; next_zone < mesh.cell_zone_count() && mesh.zone_side(ZoneId(next_zone)) == side; ++next_zone)
        ++cells;
    }
    side_.insert(side_.end(), cells, side);
  }
  first_.push_back(side_.size());
}

SideCell ZoneCells::cell(std::size_t i) const {
  const SideId s = side_[i];
  const TriangleId t = triangle_of(s);
  const ZoneId first = mesh_->first_zone(t, is_front(s));
  const std::size_t number = i - first_[s.index()];
  if (!mesh_->is_group(first)) return mesh_->zone_cell(ZoneId(first.index() + number));
  return {t, is_front(s), grid_cell(mesh_->triangle(t).divisions, static_cast<std::uint32_t>(number))};
}

ZoneId ZoneCells::zone(std::size_t i) const {
  const SideId s = side_[i];
  const ZoneId first = mesh_->first_zone(triangle_of(s), is_front(s));
  return mesh_->is_group(first) ? first : ZoneId(first.index() + i - first_[s.index()]);
}

double ZoneCells::area(std::size_t i) const {
  return cell_area(*mesh_, cell(i));
}

}  // namespace reemit

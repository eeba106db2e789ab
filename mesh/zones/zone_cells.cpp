#include "mesh/zones/zone_cells.h"

namespace reemit {

ZoneCells::ZoneCells(const ZoneMesh& mesh) : mesh_(&mesh) {
  first_.reserve(mesh.side_count());
  for (std::size_t s = 0; s < mesh.side_count(); ++s) {
    first_.push_back(side_.size());
    const SideId side(s);
    if (!mesh.has_zones(side)) continue;
    const std::size_t n = mesh.triangle(triangle_of(side)).divisions;
    side_.insert(side_.end(), n * n, side);
  }
}

SideCell ZoneCells::cell(std::size_t i) const {
  const SideId s = side_[i];
  const TriangleId t = triangle_of(s);
  return {t, is_front(s), mesh_->triangle(t).divisions, static_cast<std::uint32_t>(i - first_[s.index()])};
}

ZoneId ZoneCells::zone(std::size_t i) const {
  const SideCell c = cell(i);
  const ZoneId first = mesh_->first_zone(c.triangle, c.front);
  return mesh_->is_group(first) ? first : ZoneId(first.index() + c.number);
}

double ZoneCells::area(std::size_t i) const {
  const SideCell c = cell(i);
  const double n = c.divisions;
  return mesh_->triangle_area(c.triangle) / (n * n);
}

}  // namespace reemit

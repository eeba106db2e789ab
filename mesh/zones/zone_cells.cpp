#include "mesh/zones/zone_cells.h"

namespace reemit {

ZoneCells::ZoneCells(const ZoneMesh& mesh) : mesh_(&mesh) {
  first_.reserve(2 * mesh.triangle_count());
  for (std::size_t s = 0; s < 2 * mesh.triangle_count(); ++s) {
    first_.push_back(side_.size());
    const TriangleId t(s / 2);
    if (!mesh.has_zones(t, s % 2 == 0)) continue;
    const std::size_t n = mesh.triangle(t).divisions;
    side_.insert(side_.end(), n * n, static_cast<std::uint32_t>(s));
  }
}

SideCell ZoneCells::cell(std::size_t i) const {
  const std::uint32_t s = side_[i];
  const TriangleId t(s / 2);
  return {t, s % 2 == 0, mesh_->triangle(t).divisions, static_cast<std::uint32_t>(i - first_[s])};
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

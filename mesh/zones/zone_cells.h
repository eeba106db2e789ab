#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/zones/zone_mesh.h"

namespace reemit {

/// Corners of a cell [m], on the shape where it is curved.
std::array<Vec3, 3> corner_points(const ZoneMesh& mesh, const SideCell& cell);
/// Of a cell, holes of cut-outs included [m2].
double cell_area(const ZoneMesh& mesh, const SideCell& cell);

/// All cells, as far as they are cut, of all sides that have zones, by side. Those of sides that are in no
/// group are the first zones of the mesh, in their order.
class ZoneCells {
 public:
  /// The mesh must outlive it.
  explicit ZoneCells(const ZoneMesh& mesh);

  std::size_t size() const { return side_.size(); }
  /// First cell of a side; that of the one after the last is size().
  std::size_t first(SideId side) const { return first_[side.index()]; }
  SideCell cell(std::size_t i) const;
  ZoneId zone(std::size_t i) const;  ///< That the cell is, or belongs to.
  double area(std::size_t i) const;  ///< [m2]

 private:
  const ZoneMesh* mesh_;
  std::vector<SideId> side_;        // of each cell
  std::vector<std::size_t> first_;  // cell of each side, and the end
};

}  // namespace reemit

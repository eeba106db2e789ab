#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/zones/zone_topology.h"
#include "solver/reflect/surface_model.h"
#include "solver/solution/solution.h"

namespace reemit {

/// One cell beside a vertex.
struct RingCell {
  ZoneId zone;         ///< That it is, or belongs to.
  SideCell cell;       ///< The part of the zone that lies at the vertex.
  Barycentric vertex;  ///< Where the vertex lies in the triangle of the cell.
  double area;         ///< Of the cell [m2].
};

/// The vertices to export and the zones around each: those of one smooth part on one side that no thing
/// standing there covers.
class VertexRings {
 public:
  /// Leaves out the backs of surfaces that no light reached and that do not emit, unless `all_zones`, and all
  /// surfaces but `only`, unless it is empty.
  VertexRings(const SurfaceModel& surfaces, const Solution& solution, bool all_zones,
              const std::vector<SurfaceId>& only = {});

  std::size_t size() const { return first_.size() - 1; }
  const RingCell* begin(std::size_t vertex) const { return &rings_[first_[vertex]]; }
  const RingCell* end(std::size_t vertex) const { return rings_.data() + first_[vertex + 1]; }
  /// The vertex in the first of its cells, without its normal.
  SurfacePoint point(std::size_t vertex) const {
    const RingCell& ring = *begin(vertex);
    return {ring.cell.triangle, static_cast<float>(ring.vertex.u), static_cast<float>(ring.vertex.v),
            ring.cell.front};
  }
  double area(std::size_t vertex) const;  ///< A third of the zones around [m2].

  const std::vector<Vec3>& positions() const { return positions_; }  ///< [m]
  const std::vector<Vec3>& normals() const { return normals_; }
  /// Cells as triangles of these vertices, counter-clockwise seen from their side.
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }

 private:
  void add_triangles(const ZoneTopology& topology, const std::vector<bool>& kept_cells,
                     const std::vector<std::uint32_t>& number);

  std::vector<std::size_t> first_;
  std::vector<RingCell> rings_;
  std::vector<Vec3> positions_;
  std::vector<Vec3> normals_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

/// Cuts a convex polygon, whose sides may carry further vertices, into triangles without slivers. Indices
/// into `polygon`, wound as it is.
std::vector<std::array<std::uint32_t, 3>> cut_into_triangles(const std::vector<Vec3>& polygon);

}  // namespace reemit

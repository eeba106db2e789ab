#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "mesh/zones/zone_mesh.h"

namespace reemit {

/// Which patches, as sides that have zones are called here, continue each other smoothly, and the vertices
/// that follow from it at their corners. Edge k of a patch runs between corners k and k+1 of its triangle.
class SmoothPatches {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  /// Two patches are joined along an edge if no third triangle meets there, such as that of a wall that
  /// stands on a floor; their triangles belong to the same surface, they lie on the same side, and they bend
  /// by no more than the crease angle or have the same shading normals at both ends.
  SmoothPatches(const ZoneMesh& mesh, double crease_angle_deg);

  /// Patch and edge on the other side of edge k as 3*patch+edge; kNone at a border.
  std::uint32_t neighbour(SideId p, int k) const { return neighbour_[slot(p, k)]; }
  /// Number of the vertex at corner k; patches joined around it have the same.
  std::uint32_t corner_vertex(SideId p, int k) const { return corner_vertex_[slot(p, k)]; }
  /// Unit normal at such a vertex: of the shading normals, else of the faces around it, weighted by angle.
  const Vec3& corner_normal(std::uint32_t vertex) const { return corner_normal_[vertex]; }

 private:
  static std::size_t slot(SideId p, int k) { return 3 * p.index() + static_cast<std::size_t>(k); }
  void join_edges(const ZoneMesh& mesh, double crease_angle_deg);
  void number_corners(const ZoneMesh& mesh);

  std::vector<std::uint32_t> neighbour_;
  std::vector<std::uint32_t> corner_vertex_;
  std::vector<Vec3> corner_normal_;
};

}  // namespace reemit

#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "scenes/model/ids.h"
#include "scenes/model/shape.h"
#include "scenes/model/vec.h"

namespace reemit {

/// What zones are cut from: a triangle of the coarse, repaired room, which rays are traced against, or a
/// patch of a curved shape.
struct BaseTriangle {
  static constexpr std::uint32_t kFlat = 0xffffffff;
  std::array<std::uint32_t, 3> vertex;  ///< Into BaseMesh::vertices, counter-clockwise from the front.
  std::array<std::uint32_t, 3> normal{kFlat, kFlat,
                                      kFlat};  ///< Into BaseMesh::normals, kFlat = geometric normal.
  SurfaceId surface;
  std::uint32_t face = 0;       ///< Index of the polygon in its Surface it was cut from.
  std::uint32_t divisions = 1;  ///< n >= 1: the triangle holds n*n cells on each side that has zones.
  bool two_sided = false;       ///< The back has zones of its own; else it absorbs.
  std::uint32_t shape = kFlat;  ///< Into BaseMesh::shapes; kFlat = a flat triangle.
  std::uint32_t patch = 0;      ///< Of CurvedPatches.

  bool is_curved() const { return shape != kFlat; }
};

/// A polygon of a surface.
struct SurfaceFace {
  SurfaceId surface;
  std::uint32_t face = 0;  ///< Of the surface.

  bool operator==(const SurfaceFace&) const = default;
};

/// The repaired, cut and triangulated room [m]. Plain data: this is what a solution file keeps of the
/// geometry.
struct BaseMesh {
  std::vector<Vec3> vertices;
  std::vector<Vec3> normals;            ///< Unit shading normals.
  std::vector<BaseTriangle> triangles;  ///< Flat ones first, then all patches of each shape in order.
  std::vector<CurvedShape> shapes;
  /// By triangle, the face that its back shows where two faces lie back to back: that one's front. Not valid:
  /// the back is that of the triangle's own face. Empty if there is no such pair.
  std::vector<SurfaceFace> backs;
};

}  // namespace reemit

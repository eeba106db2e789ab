#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "mesh/pieces/face_piece.h"

namespace reemit {

/// What triangles a planar region is cut into. Long thin triangles are improved by points in the middle of
/// their longest sides. (Ruppert's refinement would guarantee the angle, but also answers every small feature
/// with a cascade of triangles, which costs rays and serves no zone.)
struct TriangleQuality {
  double smallest_angle_deg = 0;    ///< Aimed at by adding points; 0 = none are added.
  double free_length = 0;           ///< Triangles whose longest side is shorter may have any shape [m],
  double free_area = 0;             ///< and so may triangles of less area [m2].
  std::size_t most_new_points = 0;  ///< If more would be needed, none are added.
};

/// How crossings of segments are found. Where many cross almost in one point, rounding at every step can bend
/// a segment to a point far away; exact ones do not, at seven times the cost (measured on 3,881 segments).
enum class Crossings { kRounded, kExact };

/// A constrained Delaunay triangulation of the regions that count as inside.
struct PlanarTriangulation {
  static constexpr std::uint32_t kNone = 0xffffffff;

  std::vector<Vec2>
      points;  ///< The input points in their order, then crossings of segments, then added points.
  /// By points past the input ones: the two points between which it lies on a segment, both earlier in
  /// `points`; kNone for crossings and for points off the segments.
  std::vector<std::array<std::uint32_t, 2>> on_segment;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Counter-clockwise.
  std::vector<std::uint32_t> region;  ///< By triangle: no segment separates triangles of one region.
  std::vector<Vec2> region_point;     ///< By region: a point well inside.
};

/// Triangulates the plane with the given segments kept as edges (they may cross, touch and repeat), and
/// returns the part for which `inside` holds; it is asked once per region. Shewchuk/Ruppert refinement by
/// CGAL. Equal points are one: triangles then name the first of them. No triangles if the input defeats the
/// arithmetic. Deterministic.
PlanarTriangulation triangulate_planar(const std::vector<Vec2>& points,
                                       const std::vector<std::array<std::uint32_t, 2>>& segments,
                                       const std::function<bool(const Vec2&)>& inside,
                                       const TriangleQuality& quality,
                                       Crossings crossings = Crossings::kRounded);

}  // namespace reemit

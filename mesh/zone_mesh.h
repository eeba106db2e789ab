#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "mesh/zone_lookup.h"
#include "scenes/model/ids.h"
#include "scenes/model/vec.h"

namespace reemit {

/// What rays are traced against: a triangle of the coarse, repaired room, and how it is cut into zones.
struct BaseTriangle {
  static constexpr std::uint32_t kFlat = 0xffffffff;
  std::array<std::uint32_t, 3> vertex;  ///< Into BaseMesh::vertices, counter-clockwise from the front.
  std::array<std::uint32_t, 3> normal{kFlat, kFlat,
                                      kFlat};  ///< Into BaseMesh::normals, kFlat = geometric normal.
  SurfaceId surface;
  std::uint32_t face = 0;       ///< Index of the polygon in its Surface it was cut from.
  std::uint32_t divisions = 1;  ///< n >= 1: the triangle holds n*n zones on each side that has zones.
  bool two_sided = false;       ///< The back has zones of its own; else it absorbs.
};

/// The repaired, cut and triangulated room [m]. Plain data: this is what a solution file keeps of the
/// geometry.
struct BaseMesh {
  std::vector<Vec3> vertices;
  std::vector<Vec3> normals;  ///< Unit shading normals.
  std::vector<BaseTriangle> triangles;
};

/// Base triangles and their zones. A zone is one cell of a base triangle seen from one side; the back of a
/// two-sided triangle has zones of its own, numbered like those of its front. No radiometric value is stored
/// here.
class ZoneMesh {
 public:
  /// Throws std::invalid_argument when an index is out of range or divisions is 0 or the zones exceed 2^32-2.
  explicit ZoneMesh(BaseMesh base);

  const BaseMesh& base() const { return base_; }
  std::size_t triangle_count() const { return base_.triangles.size(); }
  std::size_t zone_count() const { return zone_triangle_.size(); }

  const BaseTriangle& triangle(TriangleId t) const { return base_.triangles[t.index()]; }
  const Vec3& corner(TriangleId t, int k) const {
    return base_.vertices[triangle(t).vertex[static_cast<std::size_t>(k)]];
  }
  double triangle_area(TriangleId t) const { return triangle_area_[t.index()]; }  ///< One side [m2].
  const Vec3& triangle_normal(TriangleId t) const {
    return triangle_normal_[t.index()];
  }  ///< Unit, of the front.

  /// First zone on the given side; not valid for the back of a one-sided triangle.
  ZoneId first_zone(TriangleId t, bool front) const { return first_zone_[2 * t.index() + (front ? 0 : 1)]; }
  /// Zone that holds barycentric point (u,v) of the given side, in constant time. Pre: that side has zones.
  ZoneId zone_at(TriangleId t, float u, float v, bool front) const {
    return ZoneId(first_zone(t, front).index() + zone_in_triangle(triangle(t).divisions, u, v));
  }

  TriangleId zone_triangle(ZoneId z) const { return zone_triangle_[z.index()]; }  ///< The zone's parent.
  bool zone_is_front(ZoneId z) const { return z < back_begin(zone_triangle(z)); }
  SurfaceId zone_surface(ZoneId z) const { return triangle(zone_triangle(z)).surface; }
  double zone_area(ZoneId z) const;  ///< [m2]
  Vec3 zone_normal(ZoneId z) const;  ///< Unit, points away from the side the zone is on.
  /// Barycentric corners within the parent triangle; counter-clockwise seen from the *front* of the triangle.
  std::array<Barycentric, 3> zone_barycentrics(ZoneId z) const;
  Vec3 point(TriangleId t, double u, double v) const;  ///< [m]
  Vec3 zone_centroid(ZoneId z) const;                  ///< [m]

 private:
  ZoneId back_begin(TriangleId t) const {
    const BaseTriangle& tri = triangle(t);
    return ZoneId(first_zone(t, true).index() + std::size_t{tri.divisions} * tri.divisions);
  }

  BaseMesh base_;
  std::vector<double> triangle_area_;
  std::vector<Vec3> triangle_normal_;
  std::vector<ZoneId> first_zone_;  // front, back of each triangle
  std::vector<TriangleId> zone_triangle_;
};

}  // namespace reemit

#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "mesh/zones/curved_patch.h"
#include "mesh/zones/zone_lookup.h"
#include "scenes/model/ids.h"
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
  std::uint32_t divisions = 1;  ///< n >= 1: the triangle holds n*n zones on each side that has zones.
  bool two_sided = false;       ///< The back has zones of its own; else it absorbs.
  std::uint32_t shape = kFlat;  ///< Into BaseMesh::shapes; kFlat = a flat triangle.
  std::uint32_t patch = 0;      ///< Of CurvedPatches.

  bool is_curved() const { return shape != kFlat; }
};

/// The repaired, cut and triangulated room [m]. Plain data: this is what a solution file keeps of the
/// geometry.
struct BaseMesh {
  std::vector<Vec3> vertices;
  std::vector<Vec3> normals;            ///< Unit shading normals.
  std::vector<BaseTriangle> triangles;  ///< Flat ones first, then all patches of each shape in order.
  std::vector<CurvedShape> shapes;
};

/// A point on one side of a base triangle.
struct SidePoint {
  TriangleId triangle;
  Barycentric at;
  bool front = true;
};

/// Base triangles and their zones: the one place that knows what a zone is, which zone a point belongs to,
/// and where the points of a zone are. A zone is one cell of a base triangle seen from one side; the back of
/// a two-sided triangle has zones of its own, numbered like those of its front. No radiometric value is
/// stored here.
class ZoneMesh {
 public:
  /// Throws std::invalid_argument when an index is out of range, patches are not in order, divisions is 0 or
  /// the zones exceed 2^32-2.
  explicit ZoneMesh(BaseMesh base);

  const BaseMesh& base() const { return base_; }
  std::size_t triangle_count() const { return base_.triangles.size(); }
  std::size_t zone_count() const { return zone_triangle_.size(); }

  const BaseTriangle& triangle(TriangleId t) const { return base_.triangles[t.index()]; }
  const Vec3& corner(TriangleId t, int k) const {
    return base_.vertices[triangle(t).vertex[static_cast<std::size_t>(k)]];
  }
  double triangle_area(TriangleId t) const { return triangle_area_[t.index()]; }  ///< One side [m2].
  /// Unit, of the front; of a curved patch, in its middle.
  const Vec3& triangle_normal(TriangleId t) const { return triangle_normal_[t.index()]; }
  /// Unit normal of the front at (u,v).
  Vec3 normal(TriangleId t, double u, double v) const {
    const BaseTriangle& tri = triangle(t);
    return tri.is_curved() ? curved_[tri.shape].normal(tri.patch, u, v) : triangle_normal(t);
  }

  std::size_t flat_count() const { return flat_count_; }  ///< Triangles that are flat; they come first.
  const std::vector<CurvedPatches>& curved() const { return curved_; }  ///< As BaseMesh::shapes.
  /// First patch of a shape.
  TriangleId first_patch(std::size_t shape) const { return first_patch_[shape]; }

  /// First zone on the given side; not valid for the back of a one-sided triangle.
  ZoneId first_zone(TriangleId t, bool front) const { return side(t, front).first_zone; }
  /// The back of a one-sided triangle has none.
  bool has_zones(TriangleId t, bool front) const { return first_zone(t, front).valid(); }
  /// Zone that holds barycentric point (u,v) of the given side, in constant time; not valid if that side has
  /// none.
  ZoneId zone_at(TriangleId t, float u, float v, bool front) const {
    const Side& s = side(t, front);
    return s.first_zone.valid() ? ZoneId(s.first_zone.index() + zone_in_triangle(s.divisions, u, v))
                                : ZoneId();
  }
  /// The point of a zone that is a and b of its edges away from its first corner: uniform over the zone for
  /// a, b uniform over the triangle a, b >= 0, a + b <= 1.
  SidePoint zone_point(ZoneId z, float a, float b) const {
    const auto corner = zone_barycentrics(z);
    const auto inside = [&](double Barycentric::*k) {
      return (1 - a - b) * corner[0].*k + a * corner[1].*k + b * corner[2].*k;
    };
    return {zone_triangle(z), {inside(&Barycentric::u), inside(&Barycentric::v)}, zone_is_front(z)};
  }

  TriangleId zone_triangle(ZoneId z) const { return zone_triangle_[z.index()]; }  ///< The zone's parent.
  bool zone_is_front(ZoneId z) const { return z < back_begin(zone_triangle(z)); }
  SurfaceId zone_surface(ZoneId z) const { return triangle(zone_triangle(z)).surface; }
  double zone_area(ZoneId z) const;  ///< [m2]
  Vec3 zone_normal(ZoneId z) const;  ///< Unit, points away from the side the zone is on.
  /// Barycentric corners within the parent triangle; counter-clockwise seen from the *front* of the triangle.
  std::array<Barycentric, 3> zone_barycentrics(ZoneId z) const;
  Vec3 point(TriangleId t, double u, double v) const;  ///< [m], on the shape where it is curved.
  /// Barycentric position in t of a point on it [m].
  Barycentric barycentric_of(TriangleId t, const Vec3& point) const;
  Vec3 zone_centroid(ZoneId z) const;  ///< [m]

 private:
  struct Side {
    ZoneId first_zone;
    std::uint32_t divisions;
  };

  const Side& side(TriangleId t, bool front) const { return sides_[2 * t.index() + (front ? 0 : 1)]; }
  ZoneId back_begin(TriangleId t) const {
    const BaseTriangle& tri = triangle(t);
    return ZoneId(first_zone(t, true).index() + std::size_t{tri.divisions} * tri.divisions);
  }

  void add_shapes();

  BaseMesh base_;
  std::size_t flat_count_ = 0;
  std::vector<CurvedPatches> curved_;
  std::vector<TriangleId> first_patch_;
  std::vector<double> triangle_area_;
  std::vector<Vec3> triangle_normal_;
  std::vector<Side> sides_;  // front, back of each triangle
  std::vector<TriangleId> zone_triangle_;
};

}  // namespace reemit

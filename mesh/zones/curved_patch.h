#pragma once
#include <array>
#include <cstdint>

#include "mesh/zones/zone_lookup.h"
#include "scenes/model/shape.h"

namespace reemit {

/// The patches of a shape: triangles in barycentric coordinates that are mapped onto the shape with equal
/// areas everywhere, so that the n*n zones of a patch are equally large and a uniform point of a zone is
/// uniform on the shape. A sphere has 8 patches (octants, equal areas by Archimedes), a disk or a pointed
/// cone 4, everything else two for each quarter of a slab about as long as it is wide.
class CurvedPatches {
 public:
  explicit CurvedPatches(const CurvedShape& shape);

  std::uint32_t count() const { return count_; }
  double patch_area() const { return area_ / count_; }  ///< [m2], all are equal.
  const CurvedShape& shape() const { return shape_; }

  struct Point {
    Vec3 position;
    Vec3 normal;  ///< Unit, of the front.
  };
  /// At (u,v), 0 <= u, v and u + v <= 1. Corners are counter-clockwise seen from the front.
  Point at(std::uint32_t patch, double u, double v) const;
  /// The same at 16 points of one patch, for much less each; `to` as the results of `at` for every lane.
  struct alignas(64) Points16 {
    double position[3][16], normal[3][16];
  };
  void at16(std::uint32_t patch, const double* u, const double* v, Points16& to) const;
  Vec3 point(std::uint32_t patch, double u, double v) const { return at(patch, u, v).position; }
  Vec3 normal(std::uint32_t patch, double u, double v) const { return at(patch, u, v).normal; }

  struct Place {
    std::uint32_t patch;
    Barycentric at;
  };
  /// Where a point on the shape (or near it) lies.
  Place place_of(const Vec3& point) const;
  /// Barycentrics in a given patch; a point outside of it is moved to its border.
  Barycentric in_patch(std::uint32_t patch, const Vec3& point) const;
  /// Unit normal of the front at a point on the shape.
  Vec3 normal_at(const Vec3& point) const;

 private:
  // A frustum in surface coordinates: a in [0,1] within a quarter turn, b in [0,1] by area from the larger
  // circle to the smaller.
  double share_at(double radius, double height) const;
  Point frustum_point(double quarter, double a, double b) const;
  Barycentric octant_place(std::uint32_t patch, const Vec3& direction) const;

  CurvedShape shape_;
  Frustum frustum_;
  double outwards_ = 0, upwards_ = 0;  // normal of a mantle, away from the axis and along it
  bool pointed_ = false;
  std::uint32_t slabs_ = 1;
  std::uint32_t count_ = 8;
  double area_ = 0;
};

}  // namespace reemit

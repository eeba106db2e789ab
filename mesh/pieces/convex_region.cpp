#include "mesh/pieces/convex_region.h"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

namespace reemit {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

ConvexRegion ConvexRegion::of_edge(const Vec3& a, const Vec3& b, double reach) {
  ConvexRegion region;
  region.min_ = a.cwiseMin(b).array() - reach;
  region.max_ = a.cwiseMax(b).array() + reach;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 normal = (b - a).cross(Vec3::Unit(axis));
    const double length = normal.norm();
    if (!(length > 0)) continue;
    const double at = normal.dot(a) / length;
    region.slabs_[region.count_++] = {normal / length, at - reach, at + reach};
  }
  return region;
}

ConvexRegion ConvexRegion::of_piece(const VertexTable& vertices, const FacePiece& piece,
                                    const PlaneFrame& plane, double reach, double inset) {
  ConvexRegion region;
  const Loop& outline = piece.loops[0];
  region.min_ = region.max_ = vertices[outline[0]];
  for (const std::uint32_t v : outline) {
    region.min_ = region.min_.cwiseMin(vertices[v]);
    region.max_ = region.max_.cwiseMax(vertices[v]);
  }
  region.min_.array() -= reach;
  region.max_.array() += reach;
  const double height = plane.normal.dot(plane.origin);
  region.slabs_[region.count_++] = {plane.normal, height - reach, height + reach};
  for (std::size_t i = 0; i < outline.size() && region.count_ < kMostSlabs; ++i) {
    const Vec3& a = vertices[outline[i]];
    const Vec3 normal = plane.normal.cross(vertices[outline[(i + 1) % outline.size()]] - a);
    const double length = normal.norm();
    if (!(length > 0)) continue;
    // The piece ends here if all of it lies on one side, whichever: it may be wound against the plane.
    double low = 0;
    double high = 0;
    for (const std::uint32_t v : outline) {
      const double depth = normal.dot(vertices[v] - a) / length;
      low = std::min(low, depth);
      high = std::max(high, depth);
    }
    if (low < 0 && high > 0 && std::min(-low, high) > 1e-9 * (high - low)) continue;
    const double at = normal.dot(a) / length;
    region.slabs_[region.count_++] = high > -low ? Slab{normal / length, at + inset, kUnbounded}
                                                 : Slab{normal / length, -kUnbounded, at - inset};
  }
  return region;
}

bool ConvexRegion::touches(const Vec3* begin, const Vec3* end) const {
  for (std::size_t i = 0; i < count_; ++i) {
    const Slab& s = slabs_[i];
    const auto above = [&](const Vec3& p) { return s.normal.dot(p) > s.high; };
    const auto below = [&](const Vec3& p) { return s.normal.dot(p) < s.low; };
    if (above(*begin) ? std::all_of(begin, end, above) : below(*begin) && std::all_of(begin, end, below))
      return false;
  }
  return true;
}

}  // namespace reemit

#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "scenes/model/vec.h"

namespace reemit {

/// Corners that a polygon luminaire may have; callers split larger ones.
inline constexpr std::size_t kMostCorners = 16;

/// Convex polygon relative to the shading point, cut at its horizon.
struct ClippedPolygon {
  std::array<Vec3, kMostCorners + 1> corner;  ///< Left unset beyond count.
  std::size_t count = 0;

  /// The part of `corners` - x with n . p >= 0. Pre: at most kMostCorners corners, convex.
  ClippedPolygon(std::span<const Vec3> corners, const Vec3& x, const Vec3& n) {
    const std::size_t size = corners.size();
    for (std::size_t i = 0; i < size; ++i) {
      const Vec3 p = corners[i] - x;
      const Vec3 q = corners[i + 1 < size ? i + 1 : 0] - x;
      const double hp = n.dot(p);
      const double hq = n.dot(q);
      // A convex polygon crosses a plane twice; the bound is for ones that are not convex to rounding.
      if (hp >= 0 && count < corner.size()) corner[count++] = p;
      if (((hp > 0 && hq < 0) || (hp < 0 && hq > 0)) && count < corner.size()) {
        Vec3 crossing = p + (hp / (hp - hq)) * (q - p);
        crossing -= n.dot(crossing) * n;
        corner[count++] = crossing;
      }
    }
  }
  std::span<const Vec3> corners() const { return {corner.data(), count}; }
};

}  // namespace reemit

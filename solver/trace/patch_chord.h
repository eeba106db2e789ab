#pragma once
#include <cmath>

#include "scenes/model/vec.h"

namespace reemit {

/// The flat triangle that stands for a curved patch, and the middle of the patch itself.
struct PatchChord {
  Vec3f corner[3], middle;

  /// From the point (u,v) of the triangle to the middle of the patch.
  float distance(float u, float v) const {
    const float w = 1 - u - v;
    const float x = middle.x() - (w * corner[0].x() + u * corner[1].x() + v * corner[2].x());
    const float y = middle.y() - (w * corner[0].y() + u * corner[1].y() + v * corner[2].y());
    const float z = middle.z() - (w * corner[0].z() + u * corner[1].z() + v * corner[2].z());
    return std::sqrt(x * x + y * y + z * z);
  }
};

}  // namespace reemit

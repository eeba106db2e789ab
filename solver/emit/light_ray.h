#pragma once
#include <array>

#include "scenes/model/vec.h"

namespace reemit {

/// The way of a packet that leaves a luminaire, in the normalised space.
struct LightRay {
  Vec3f origin;
  Vec3f direction;  ///< Unit.
};

/// Uniform numbers of several packets: [0] and [1] place each, [2] and [3] turn it.
using LightNumbers = std::array<const float*, 4>;

}  // namespace reemit

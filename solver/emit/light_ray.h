#pragma once
#include "scenes/model/vec.h"

namespace reemit {

/// The way of a packet that leaves a luminaire, in the normalised space.
struct LightRay {
  Vec3f origin;
  Vec3f direction;  ///< Unit.
};

}  // namespace reemit

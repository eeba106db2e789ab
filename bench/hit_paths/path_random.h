#pragma once
#include <random>

#include "scenes/model/vec.h"

namespace reemit::hit_paths {

using PathRandom = std::mt19937_64;

double uniform(PathRandom& random);  ///< [0,1)

/// Unit; density cos/pi about a unit normal.
Vec3 cosine_direction(const Vec3& normal, PathRandom& random);

/// Unit vector at an angle to the axis, given by its cosine, turned about it at random.
Vec3 direction_about(const Vec3& axis, double cosine, PathRandom& random);

}  // namespace reemit::hit_paths

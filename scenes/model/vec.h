#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace reemit {
using Vec3 =
    Eigen::Vector3d;  ///< Points and directions of the room [m]; double, so that offsets far from 0 survive.
using Vec3f = Eigen::Vector3f;  ///< Points and directions in the normalised space that rays are traced in.
}  // namespace reemit

#pragma once
#include <string>

#include "scenes/model/vec.h"

namespace reemit {

/// Pinhole camera.
struct Camera {
  std::string name;
  Vec3 eye{0, 0, 0};             ///< [m]
  Vec3 look_at{0, 0, -1};        ///< [m], not equal to eye.
  Vec3 up{0, 1, 0};              ///< Any length, not along the viewing direction.
  double vertical_fov_deg = 45;  ///< Full vertical field of view [deg], (0,180).
  int width = 512;               ///< Preferred size [px].
  int height = 512;
};

}  // namespace reemit

#pragma once
#include <variant>

#include "scenes/model/vec.h"

namespace reemit {

/// Shapes that are kept as they are, from the room file to the rays that hit them; nothing is tessellated.
struct Sphere {
  Vec3 centre{0, 0, 0};  ///< [m]
  double radius = 1;     ///< [m], > 0.
  bool inward = false;   ///< The front is the inside.
};

struct Disk {
  Vec3 centre{0, 0, 0};  ///< [m]
  Vec3 normal{0, 0, 1};  ///< Unit, of the front.
  double radius = 1;     ///< [m], > 0.
};

/// The mantle of a circular cylinder, without its ends; caps are disks.
struct Cylinder {
  Vec3 base{0, 0, 0};   ///< Middle of one end [m].
  Vec3 top{0, 0, 1};    ///< Middle of the other [m], not equal to base.
  double radius = 1;    ///< [m], > 0.
  bool inward = false;  ///< The front is the inside.
};

using CurvedShape = std::variant<Sphere, Disk, Cylinder>;

}  // namespace reemit

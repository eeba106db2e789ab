#pragma once
#include <utility>
#include <variant>

#include "scenes/model/vec.h"

namespace reemit {

// Shapes that are kept as they are, from the room file to the rays that hit them.

struct Sphere {
  Vec3 centre{0, 0, 0};  ///< [m]
  double radius = 1;     ///< [m], > 0.
  bool inward = false;   ///< The front is the inside.
};

/// A flat disk, or a ring if it has a hole.
struct Disk {
  Vec3 centre{0, 0, 0};     ///< [m]
  Vec3 normal{0, 0, 1};     ///< Unit, of the front.
  double radius = 1;        ///< [m], > 0.
  double inner_radius = 0;  ///< [m], of the hole, < radius.
};

/// The mantle of a circular cylinder, without its ends; caps are disks.
struct Cylinder {
  Vec3 base{0, 0, 0};   ///< Middle of one end [m].
  Vec3 top{0, 0, 1};    ///< Middle of the other [m], not equal to base.
  double radius = 1;    ///< [m], > 0.
  bool inward = false;  ///< The front is the inside.
};

/// The mantle of a cone or truncated cone, without its ends.
struct Cone {
  Vec3 base{0, 0, 0};      ///< Middle of one end [m].
  Vec3 top{0, 0, 1};       ///< Middle of the other [m], not equal to base.
  double base_radius = 1;  ///< [m], >= 0; only one of the two may be 0.
  double top_radius = 0;   ///< [m], >= 0.
  bool inward = false;     ///< The front is the inside.
};

using CurvedShape = std::variant<Sphere, Disk, Cylinder, Cone>;

double shape_area(const CurvedShape& shape);  ///< One side [m2].

/// Smallest and largest coordinates of the shape [m].
std::pair<Vec3, Vec3> shape_bounds(const CurvedShape& shape);

/// The same shape with front and back exchanged.
CurvedShape flipped(const CurvedShape& shape);

/// True if a transform turns spheres into spheres: rotation, translation, uniform scale, mirroring.
bool is_similarity(const Eigen::Affine3d& transform);

/// The transformed shape; fronts stay fronts. Pre: is_similarity(transform).
CurvedShape transformed(const CurvedShape& shape, const Eigen::Affine3d& transform);

/// A mantle between two circles about one axis: what disks, rings, cylinders and cones are.
struct Frustum {
  Vec3 base{0, 0, 0};  ///< Middle of the larger circle [m].
  Vec3 axis{0, 0, 1};  ///< Unit, towards the smaller one; of a disk, its normal.
  Vec3 u{1, 0, 0};     ///< Unit vectors with u x v = axis.
  Vec3 v{0, 1, 0};
  double height = 0;  ///< Between the circles [m], 0 for disks.
  double r0 = 1;      ///< Radius of the larger circle [m].
  double r1 = 0;      ///< Of the smaller [m].
  bool inward = false;
};

/// Pre: not a sphere.
Frustum frustum_of(const CurvedShape& shape);

}  // namespace reemit

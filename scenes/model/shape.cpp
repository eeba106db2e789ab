#include "scenes/model/shape.h"

#include <cmath>
#include <numbers>

namespace reemit {
namespace {

Frustum frustum_between(const Vec3& a, const Vec3& b, double ra, double rb, bool inward) {
  Frustum f;
  const bool swap = rb > ra;
  f.base = swap ? b : a;
  const Vec3 along = swap ? Vec3(a - b) : Vec3(b - a);
  f.height = along.norm();
  f.axis = along / f.height;
  f.r0 = swap ? rb : ra;
  f.r1 = swap ? ra : rb;
  f.inward = inward;
  return f;
}

/// Half the extent of a circle along each axis of the room.
Vec3 circle_reach(const Vec3& axis, double radius) {
  return radius * (Vec3::Ones() - axis.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
}

struct Transform {
  const Eigen::Affine3d& map;
  double scale;

  CurvedShape operator()(const Sphere& s) const { return Sphere{map * s.centre, scale * s.radius, s.inward}; }
  CurvedShape operator()(const Disk& d) const {
    return Disk{map * d.centre, (map.linear() * d.normal).normalized(), scale * d.radius,
                scale * d.inner_radius};
  }
  CurvedShape operator()(const Cylinder& c) const {
    return Cylinder{map * c.base, map * c.top, scale * c.radius, c.inward};
  }
  CurvedShape operator()(const Cone& c) const {
    return Cone{map * c.base, map * c.top, scale * c.base_radius, scale * c.top_radius, c.inward};
  }
};

}  // namespace

Frustum frustum_of(const CurvedShape& shape) {
  Frustum f;
  if (const auto* disk = std::get_if<Disk>(&shape)) {
    f.base = disk->centre;
    f.axis = disk->normal;
    f.r0 = disk->radius;
    f.r1 = disk->inner_radius;
  } else if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    f = frustum_between(cylinder->base, cylinder->top, cylinder->radius, cylinder->radius, cylinder->inward);
  } else {
    const Cone& cone = std::get<Cone>(shape);
    f = frustum_between(cone.base, cone.top, cone.base_radius, cone.top_radius, cone.inward);
  }
  f.u = f.axis.unitOrthogonal();
  f.v = f.axis.cross(f.u);
  return f;
}

double shape_area(const CurvedShape& shape) {
  if (const auto* s = std::get_if<Sphere>(&shape)) return 4 * std::numbers::pi * s->radius * s->radius;
  const Frustum f = frustum_of(shape);
  return std::numbers::pi * (f.r0 + f.r1) * std::hypot(f.height, f.r0 - f.r1);
}

std::pair<Vec3, Vec3> shape_bounds(const CurvedShape& shape) {
  if (const auto* s = std::get_if<Sphere>(&shape)) {
    const Vec3 reach = Vec3::Constant(s->radius);
    return {s->centre - reach, s->centre + reach};
  }
  const Frustum f = frustum_of(shape);
  const Vec3 top = f.base + f.height * f.axis;
  const Vec3 reach0 = circle_reach(f.axis, f.r0);
  const Vec3 reach1 = circle_reach(f.axis, f.r1);
  return {(f.base - reach0).cwiseMin(top - reach1), (f.base + reach0).cwiseMax(top + reach1)};
}

CurvedShape flipped(const CurvedShape& shape) {
  CurvedShape result = shape;
  if (auto* disk = std::get_if<Disk>(&result)) disk->normal = -disk->normal;
  if (auto* sphere = std::get_if<Sphere>(&result)) sphere->inward = !sphere->inward;
  if (auto* cylinder = std::get_if<Cylinder>(&result)) cylinder->inward = !cylinder->inward;
  if (auto* cone = std::get_if<Cone>(&result)) cone->inward = !cone->inward;
  return result;
}

bool is_similarity(const Eigen::Affine3d& transform) {
  const Eigen::Matrix3d square = transform.linear().transpose() * transform.linear();
  const double scale2 = square.trace() / 3;
  constexpr double kSlack = 1e-9;  // transforms written with about ten digits
  return scale2 > 0 &&
         (square - scale2 * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= kSlack * scale2;
}

CurvedShape transformed(const CurvedShape& shape, const Eigen::Affine3d& transform) {
  return std::visit(Transform{transform, std::cbrt(std::abs(transform.linear().determinant()))}, shape);
}

}  // namespace reemit

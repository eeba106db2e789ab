#include "solver/emit/luminaire_bounds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reemit {
namespace {

/// Float axes are off by this much in angle and cosines in value at most; cones are widened by as much.
constexpr double kConeRounding = 2.5e-7;

struct NormalCone {
  Vec3f axis;
  float cos_angle;
};

NormalCone merged_cones(const Vec3f& axis_a, float cos_a, const Vec3f& axis_b, float cos_b) {
  if (cos_a <= -1) return {axis_a, -1};
  if (cos_b <= -1) return {axis_b, -1};
  if (cos_a > cos_b) return merged_cones(axis_b, cos_b, axis_a, cos_a);  // a is the wider one.
  const Vec3 a = axis_a.cast<double>().normalized();
  const Vec3 b = axis_b.cast<double>().normalized();
  const double angle_a = std::acos(std::clamp<double>(cos_a, -1, 1));
  const double angle_b = std::acos(std::clamp<double>(cos_b, -1, 1));
  const double sine = a.cross(b).norm();
  const double between = std::atan2(sine, a.dot(b));
  if (between + angle_b <= angle_a) return {axis_a, cos_a};
  const double angle = (angle_a + between + angle_b) / 2;
  if (angle >= std::numbers::pi || sine == 0) return {axis_a, -1};
  const Vec3 sideways = (b - a.dot(b) * a).normalized();
  const double turn = angle - angle_a;
  const Vec3 axis = std::cos(turn) * a + std::sin(turn) * sideways;
  return {axis.normalized().cast<float>(),
          static_cast<float>(std::max(-1.0, std::cos(angle) - kConeRounding))};
}

}  // namespace

LuminaireBounds flat_bounds(std::span<const Vec3f> corners, const Vec3f& unit_normal, float intensity) {
  LuminaireBounds bounds{corners[0], corners[0], unit_normal, 1, 0, intensity};
  for (const Vec3f& corner : corners) {
    bounds.min = bounds.min.cwiseMin(corner);
    bounds.max = bounds.max.cwiseMax(corner);
  }
  return bounds;
}

LuminaireBounds disk_bounds(const Vec3f& centre, const Vec3f& unit_normal, float radius, float intensity) {
  const Vec3f half = radius * (1 - unit_normal.array().square()).max(0.0F).sqrt().matrix();
  return {centre - half, centre + half, unit_normal, 1, 0, intensity};
}

LuminaireBounds sphere_bounds(const Vec3f& centre, float radius, float intensity) {
  const Vec3f half = Vec3f::Constant(radius);
  return {centre - half, centre + half, Vec3f::UnitZ(), -1, 0, intensity};
}

LuminaireBounds spot_bounds(const Vec3f& position, const Vec3f& unit_direction, float cos_outer,
                            float intensity) {
  return {position, position, unit_direction, 1, cos_outer, intensity};
}

LuminaireBounds merged(const LuminaireBounds& a, const LuminaireBounds& b) {
  const NormalCone cone = merged_cones(a.axis, a.cos_normals, b.axis, b.cos_normals);
  return {a.min.cwiseMin(b.min),
          a.max.cwiseMax(b.max),
          cone.axis,
          cone.cos_angle,
          std::min(a.cos_emission, b.cos_emission),
          a.intensity + b.intensity};
}

bool valid(const LuminaireBounds& bounds) {
  const auto cosine = [](float c) { return c >= -1 && c <= 1; };
  return bounds.min.minCoeff() >= -kFarthest && bounds.max.maxCoeff() <= kFarthest &&
         (bounds.min.array() <= bounds.max.array()).all() && std::fabs(bounds.axis.norm() - 1) < 1e-3F &&
         cosine(bounds.cos_normals) && cosine(bounds.cos_emission) && bounds.intensity > 0 &&
         std::isfinite(bounds.intensity);
}

}  // namespace reemit

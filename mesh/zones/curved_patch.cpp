#include "mesh/zones/curved_patch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/model/sine_cosine.h"

namespace reemit {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;
constexpr double kMostSlabs = 64;

Barycentric into_triangle(double u, double v) {
  u = std::max(u, 0.0);
  v = std::max(v, 0.0);
  const double sum = u + v;
  return sum > 1 ? Barycentric{u / sum, v / sum} : Barycentric{u, v};
}

Barycentric swapped_if(bool swap, const Barycentric& at) {
  return swap ? Barycentric{at.v, at.u} : at;
}

// Patch k of a sphere is the octant whose coordinates are negative where bits 0, 1, 2 of k are set.
Vec3 octant_signs(std::uint32_t patch) {
  return {(patch & 1U) != 0 ? -1.0 : 1.0, (patch & 2U) != 0 ? -1.0 : 1.0, (patch & 4U) != 0 ? -1.0 : 1.0};
}

bool octant_swaps(std::uint32_t patch, bool inward) {
  const std::uint32_t negatives = (patch & 1U) + ((patch >> 1U) & 1U) + ((patch >> 2U) & 1U);
  return (negatives % 2 == 1) != inward;
}

// Rows of constant v of a triangle hold its share (1-v)^2 above them, as heights z of an octant hold 1-z.
Vec3 octant_direction(double u, double v) {
  const double z = v * (2 - v);
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  const double azimuth = v < 1 ? kQuarter * std::clamp(u / (1 - v), 0.0, 1.0) : 0.0;
  const SineCosine of = sine_and_cosine(azimuth);
  return {r * of.cosine, r * of.sine, z};
}

}  // namespace

CurvedPatches::CurvedPatches(const CurvedShape& shape) : shape_(shape), area_(shape_area(shape)) {
  if (std::holds_alternative<Sphere>(shape)) return;
  frustum_ = frustum_of(shape);
  const double slant = std::hypot(frustum_.height, frustum_.r0 - frustum_.r1);
  outwards_ = (frustum_.inward ? -frustum_.height : frustum_.height) / slant;
  upwards_ = (frustum_.inward ? frustum_.r1 - frustum_.r0 : frustum_.r0 - frustum_.r1) / slant;
  pointed_ = frustum_.r1 <= 0;
  if (pointed_) {
    count_ = 4;
    return;
  }
  const double width = kQuarter * 0.5 * (frustum_.r0 + frustum_.r1);
  slabs_ = static_cast<std::uint32_t>(std::clamp(std::round(slant / width), 1.0, kMostSlabs));
  count_ = 8 * slabs_;
}

double CurvedPatches::radius_at(double b) const {
  const double r0 = frustum_.r0;
  const double r1 = frustum_.r1;
  return std::sqrt(std::max(0.0, r0 * r0 + b * (r1 * r1 - r0 * r0)));
}

double CurvedPatches::share_at(double radius, double height) const {
  const double r0 = frustum_.r0;
  const double r1 = frustum_.r1;
  // Nearly straight mantles: the share by area, r0^2 - r^2 over r0^2 - r1^2, written without cancellation.
  const double f = frustum_.height > r0 - r1 ? height / frustum_.height : (r0 - radius) / (r0 - r1);
  const double inside = std::clamp(f, 0.0, 1.0);
  return inside * (2 * r0 - inside * (r0 - r1)) / (r0 + r1);
}

CurvedPatches::Point CurvedPatches::frustum_point(double quarter, double a, double b) const {
  const double r0 = frustum_.r0;
  const double r1 = frustum_.r1;
  const double r = radius_at(b);
  const double along = b * (r0 + r1) / (r + r0);  // (r0 - r) / (r0 - r1), also for r0 = r1
  const SineCosine of = sine_and_cosine(kQuarter * (quarter + a));
  const Vec3 out = of.cosine * frustum_.u + of.sine * frustum_.v;
  return {frustum_.base + along * frustum_.height * frustum_.axis + r * out,
          outwards_ * out + upwards_ * frustum_.axis};
}

CurvedPatches::Point CurvedPatches::at(std::uint32_t patch, double u, double v) const {
  if (const auto* sphere = std::get_if<Sphere>(&shape_)) {
    const Barycentric at = swapped_if(octant_swaps(patch, sphere->inward), {u, v});
    const Vec3 out = octant_signs(patch).cwiseProduct(octant_direction(at.u, at.v));
    return {sphere->centre + sphere->radius * out, sphere->inward ? Vec3(-out) : out};
  }
  const Barycentric at = swapped_if(frustum_.inward, {u, v});
  if (pointed_) {
    const double s = at.u + at.v;
    // The tip has no normal: that of the middle of the patch.
    return frustum_point(patch, s > 0 ? at.v / s : 0.5, 1 - s * s);
  }
  const std::uint32_t cell = patch / 2;
  const bool upper = patch % 2 == 1;
  const double a = upper ? 1 - at.u : at.u;
  const double b = upper ? 1 - at.v : at.v;
  const std::uint32_t slab = cell / 4;
  return frustum_point(cell % 4, a, (slab + b) / slabs_);
}

Vec3 CurvedPatches::normal_at(const Vec3& point) const {
  if (const auto* sphere = std::get_if<Sphere>(&shape_)) {
    const Vec3 outward = (point - sphere->centre).normalized();
    return sphere->inward ? Vec3(-outward) : outward;
  }
  if (frustum_.height == 0) return frustum_.axis;
  const Vec3 from_base = point - frustum_.base;
  const Vec3 radial = from_base - frustum_.axis.dot(from_base) * frustum_.axis;
  const double length = radial.norm();
  const Vec3 out = length > 0 ? Vec3(radial / length) : frustum_.u;
  return outwards_ * out + upwards_ * frustum_.axis;
}

Barycentric CurvedPatches::octant_place(std::uint32_t patch, const Vec3& direction) const {
  const Vec3 d = octant_signs(patch).cwiseProduct(direction).cwiseMax(0);
  const double length = d.norm();
  if (!(length > 0)) return {1.0 / 3, 1.0 / 3};
  const double r2 = (d.x() * d.x() + d.y() * d.y()) / (length * length);
  const double z = d.z() / length;
  const double row = std::sqrt(r2 / (1 + z));  // 1 - v = sqrt(1 - z), without cancellation near the pole
  const double u = row * std::atan2(d.y(), d.x()) / kQuarter;
  const bool inward = std::get<Sphere>(shape_).inward;
  return swapped_if(octant_swaps(patch, inward), into_triangle(u, 1 - row));
}

CurvedPatches::Place CurvedPatches::place_of(const Vec3& point) const {
  if (const auto* sphere = std::get_if<Sphere>(&shape_)) {
    const Vec3 d = point - sphere->centre;
    const std::uint32_t patch = (d.x() < 0 ? 1U : 0U) + (d.y() < 0 ? 2U : 0U) + (d.z() < 0 ? 4U : 0U);
    return {patch, octant_place(patch, d)};
  }
  const Vec3 d = point - frustum_.base;
  const double x = frustum_.u.dot(d);
  const double y = frustum_.v.dot(d);
  double turn = std::atan2(y, x) / kQuarter;
  if (turn < 0) turn += 4;
  const double quarter = std::clamp(std::floor(turn), 0.0, 3.0);
  const double a = std::clamp(turn - quarter, 0.0, 1.0);
  const double share = share_at(std::sqrt(x * x + y * y), frustum_.axis.dot(d));
  const auto q = static_cast<std::uint32_t>(quarter);
  if (pointed_) {
    const double s = std::sqrt(std::max(0.0, 1 - share));
    return {q, swapped_if(frustum_.inward, into_triangle(s * (1 - a), s * a))};
  }
  const double slab = std::clamp(std::floor(share * slabs_), 0.0, slabs_ - 1.0);
  const double b = std::clamp(share * slabs_ - slab, 0.0, 1.0);
  const bool upper = a + b > 1;
  const std::uint32_t patch = 2 * (4 * static_cast<std::uint32_t>(slab) + q) + (upper ? 1U : 0U);
  return {patch, swapped_if(frustum_.inward, upper ? into_triangle(1 - a, 1 - b) : into_triangle(a, b))};
}

Barycentric CurvedPatches::in_patch(std::uint32_t patch, const Vec3& point) const {
  if (const auto* sphere = std::get_if<Sphere>(&shape_)) return octant_place(patch, point - sphere->centre);
  const Vec3 d = point - frustum_.base;
  const double x = frustum_.u.dot(d);
  const double y = frustum_.v.dot(d);
  const std::uint32_t cell = pointed_ ? patch : patch / 2;
  double turn = std::atan2(y, x) / kQuarter - (cell % 4 + 0.5);
  turn -= 4 * std::round(turn / 4);  // from the middle of the quarter, the short way round
  const double a = std::clamp(turn + 0.5, 0.0, 1.0);
  const double share = share_at(std::sqrt(x * x + y * y), frustum_.axis.dot(d));
  if (pointed_) {
    const double s = std::sqrt(std::max(0.0, 1 - share));
    return swapped_if(frustum_.inward, into_triangle(s * (1 - a), s * a));
  }
  const std::uint32_t slab = cell / 4;
  const double b = std::clamp(share * slabs_ - slab, 0.0, 1.0);
  const bool upper = patch % 2 == 1;
  return swapped_if(frustum_.inward, upper ? into_triangle(1 - a, 1 - b) : into_triangle(a, b));
}

}  // namespace reemit

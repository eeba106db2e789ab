#include "mesh/zones/curved_patch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "scenes/model/instruction_sets.h"
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

double at_least_0(double x) {
  return x > 0 ? x : 0;
}

/// Where a point lies on a round shape: its height, the distance from the axis, and which way from it. To be
/// inlined, without branches, so that loops over lanes become vectors.
struct RoundPoint {
  double height, radius, cosine, sine;
};

// On the unit octant. Rows of constant v of a triangle hold its share (1-v)^2 above them, as heights z of an
// octant hold 1-z.
inline RoundPoint on_octant(double u, double v) {
  const double z = v * (2 - v);
  const double share = u / (1 - v);
  const double below = share < 1 ? share : 1;  // also where it is no number, at the pole
  const SineCosine of = sine_and_cosine(kQuarter * at_least_0(below));
  return {z, std::sqrt(at_least_0(1 - z * z)), of.cosine, of.sine};
}

/// On a frustum, in its surface coordinates; the height is a share.
inline RoundPoint on_frustum(double r0, double r1, double quarter, double a, double b) {
  const double r = std::sqrt(at_least_0(r0 * r0 + b * (r1 * r1 - r0 * r0)));
  const SineCosine of = sine_and_cosine(kQuarter * (quarter + a));
  return {b * (r0 + r1) / (r + r0), r, of.cosine, of.sine};  // (r0 - r) / (r0 - r1), also for r0 = r1
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

double CurvedPatches::share_at(double radius, double height) const {
  const double r0 = frustum_.r0;
  const double r1 = frustum_.r1;
  // Nearly straight mantles: the share by area, r0^2 - r^2 over r0^2 - r1^2, written without cancellation.
  const double f = frustum_.height > r0 - r1 ? height / frustum_.height : (r0 - radius) / (r0 - r1);
  const double inside = std::clamp(f, 0.0, 1.0);
  return inside * (2 * r0 - inside * (r0 - r1)) / (r0 + r1);
}

CurvedPatches::Point CurvedPatches::frustum_point(double quarter, double a, double b) const {
  const RoundPoint p = on_frustum(frustum_.r0, frustum_.r1, quarter, a, b);
  const Vec3 out = p.cosine * frustum_.u + p.sine * frustum_.v;
  return {frustum_.base + p.height * frustum_.height * frustum_.axis + p.radius * out,
          outwards_ * out + upwards_ * frustum_.axis};
}

CurvedPatches::Point CurvedPatches::at(std::uint32_t patch, double u, double v) const {
  if (const auto* sphere = std::get_if<Sphere>(&shape_)) {
    const Barycentric at = swapped_if(octant_swaps(patch, sphere->inward), {u, v});
    const RoundPoint p = on_octant(at.u, at.v);
    const Vec3 out = octant_signs(patch).cwiseProduct(Vec3(p.radius * p.cosine, p.radius * p.sine, p.height));
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

REEMIT_FOR_INSTRUCTION_SETS
void CurvedPatches::at16(std::uint32_t patch, const double* __restrict u, const double* __restrict v,
                         Points16& __restrict to) const {
  if (const auto* sphere = std::get_if<Sphere>(&shape_)) {
    if (octant_swaps(patch, sphere->inward)) std::swap(u, v);
    const Vec3 signs = octant_signs(patch);
    const Vec3 from = sphere->centre;
    const double radius = sphere->radius;
    const double side = sphere->inward ? -1 : 1;
    for (int i = 0; i < 16; ++i) {
      const RoundPoint p = on_octant(u[i], v[i]);
      const double x = signs.x() * (p.radius * p.cosine);
      const double y = signs.y() * (p.radius * p.sine);
      const double z = signs.z() * p.height;
      to.position[0][i] = from.x() + radius * x;
      to.position[1][i] = from.y() + radius * y;
      to.position[2][i] = from.z() + radius * z;
      to.normal[0][i] = side * x;
      to.normal[1][i] = side * y;
      to.normal[2][i] = side * z;
    }
    return;
  }
  if (frustum_.inward) std::swap(u, v);
  const std::uint32_t cell = pointed_ ? patch : patch / 2;
  const double flip = !pointed_ && patch % 2 == 1 ? 1 : 0;
  const std::uint32_t slab_number = cell / 4;
  const double slab = slab_number;
  alignas(64) double a[16];
  alignas(64) double b[16];
  for (int i = 0; i < 16; ++i) {
    const double s = u[i] + v[i];
    const double turn = s > 0 ? v[i] / s : 0.5;
    const double in_u = flip > 0 ? 1 - u[i] : u[i];
    const double in_v = flip > 0 ? 1 - v[i] : v[i];
    a[i] = pointed_ ? turn : in_u;
    b[i] = pointed_ ? 1 - s * s : (slab + in_v) / slabs_;
  }
  const Frustum f = frustum_;
  const double outwards = outwards_;
  const double upwards = upwards_;
  const double quarter = cell % 4;
  for (int i = 0; i < 16; ++i) {
    const RoundPoint p = on_frustum(f.r0, f.r1, quarter, a[i], b[i]);
    const double along = p.height * f.height;
    for (int k = 0; k < 3; ++k) {
      const double out = p.cosine * f.u[k] + p.sine * f.v[k];
      to.position[k][i] = f.base[k] + along * f.axis[k] + p.radius * out;
      to.normal[k][i] = outwards * out + upwards * f.axis[k];
    }
  }
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

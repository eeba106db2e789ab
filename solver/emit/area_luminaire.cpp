#include "solver/emit/area_luminaire.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/emit/default_density.h"
#include "solver/sampling/shapes/cylinder_sampler.h"
#include "solver/sampling/shapes/disk_sampler.h"
#include "solver/sampling/shapes/polygon_sampler.h"
#include "solver/sampling/shapes/rectangle_sampler.h"
#include "solver/sampling/shapes/sphere_sampler.h"

namespace reemit {
namespace {

constexpr double kPi = std::numbers::pi;
/// Beyond this many radii of the sphere around it, a shape weighs as if all of it were in its middle.
constexpr double kFarRadii = 2;
/// Least weight of what the formulas say is 0 although a point of it may light x.
constexpr double kLeastExpected = 1e-9;

bool is_rectangle(const std::vector<Vec3>& c) {
  if (c.size() != 4) return false;
  const Vec3 u = c[1] - c[0];
  const Vec3 v = c[3] - c[0];
  constexpr double kSlack = 1e-6;
  const double size = std::max(u.norm(), v.norm());
  return (c[2] - c[1] - v).norm() <= kSlack * size && std::abs(u.dot(v)) <= kSlack * u.norm() * v.norm();
}

ShapePoint sample_mantle(const CurvedPatches& patches, const Vec3& x, const Vec3& n, double u0, double u1) {
  const double scaled = u0 * patches.count();
  const auto patch = std::min(static_cast<std::uint32_t>(scaled), patches.count() - 1);
  const double s = std::sqrt(scaled - patch);
  const double u = s * (1 - u1);
  const double v = s * u1;
  const Vec3 point = patches.point(patch, u, v);
  return area_point(point, patches.normal_at(point), patches.count() * patches.patch_area(), x, n);
}

}  // namespace

AreaLuminaire::AreaLuminaire(const std::vector<Vec3>& corners, const Vec3& front, double exponent)
    : centre_(Vec3::Zero()), reach_(0), front_(front), exponent_(exponent) {
  for (const Vec3& c : corners) centre_ += c / static_cast<double>(corners.size());
  Vec3 twice = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    reach_ = std::max(reach_, (corners[i] - centre_).norm());
    twice += (corners[i] - centre_).cross(corners[(i + 1) % corners.size()] - centre_);
  }
  area_ = 0.5 * twice.norm();
  if (is_rectangle(corners))
    shape_ = Rectangle{corners[0], corners[1] - corners[0], corners[3] - corners[0]};
  else if (corners.size() == 3)
    shape_ = Triangle{{corners[0], corners[1], corners[2]}};
  else
    shape_ = Polygon{corners};
}

AreaLuminaire::AreaLuminaire(const CurvedShape& shape, double exponent, bool is_clear)
    : is_clear_(is_clear), area_(shape_area(shape)), exponent_(exponent) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    shape_ = *sphere;
    centre_ = sphere->centre;
    reach_ = sphere->radius;
    front_ = Vec3::UnitZ();
    flat_ = false;
    return;
  }
  const Frustum f = frustum_of(shape);
  front_ = f.axis;
  flat_ = f.height == 0;
  centre_ = f.base + 0.5 * f.height * f.axis;
  reach_ = std::hypot(0.5 * f.height, f.r0);
  const auto* disk = std::get_if<Disk>(&shape);
  if (disk != nullptr && disk->inner_radius == 0)
    shape_ = *disk;
  else if (const auto* cylinder = std::get_if<Cylinder>(&shape);
           cylinder != nullptr && !(cylinder->inward && is_clear))
    shape_ = *cylinder;
  else
    shape_ = Mantle{std::make_shared<const CurvedPatches>(shape)};
}

LuminaireBounds AreaLuminaire::bounds(double radiance) const {
  // The largest intensity of a convex body is its radiance times the largest area it can show.
  const auto strength = [&](double shown) { return static_cast<float>(radiance * shown); };
  if (const auto* sphere = std::get_if<Sphere>(&shape_))
    return sphere_bounds(sphere->centre.cast<float>(), static_cast<float>(sphere->radius),
                         strength(kPi * sphere->radius * sphere->radius));
  const Vec3f front = front_.cast<float>();
  if (flat_ && (std::holds_alternative<Disk>(shape_) || std::holds_alternative<Mantle>(shape_)))
    return disk_bounds(centre_.cast<float>(), front, static_cast<float>(reach_), strength(area_));
  if (!flat_) {
    LuminaireBounds b;
    const Vec3 reach = Vec3::Constant(reach_);
    b.min = (centre_ - reach).cast<float>();
    b.max = (centre_ + reach).cast<float>();
    b.intensity = strength(area_ / 2);
    return b;
  }
  std::vector<Vec3f> corners;
  if (const auto* r = std::get_if<Rectangle>(&shape_))
    for (const Vec3& c : {r->corner, Vec3(r->corner + r->edge_u), Vec3(r->corner + r->edge_u + r->edge_v),
                          Vec3(r->corner + r->edge_v)})
      corners.push_back(c.cast<float>());
  if (const auto* t = std::get_if<Triangle>(&shape_))
    for (const Vec3& c : t->corners) corners.push_back(c.cast<float>());
  if (const auto* p = std::get_if<Polygon>(&shape_))
    for (const Vec3& c : p->corners) corners.push_back(c.cast<float>());
  return flat_bounds(corners, front, strength(area_));
}

bool AreaLuminaire::faces_away(const Vec3& x) const {
  return flat_ && !(front_.dot(x - centre_) > 0);
}

double AreaLuminaire::expected_far(const Vec3& to_centre, double height, double distance2) const {
  const double distance = std::sqrt(distance2);
  double shown = 0;  // area as seen from x
  if (const auto* sphere = std::get_if<Sphere>(&shape_)) {
    shown = kPi * sphere->radius * sphere->radius;  // exact: E = pi (r/d)^2 cos
  } else if (flat_) {
    const double cosine = -front_.dot(to_centre) / distance;
    shown = area_ * cosine * (exponent_ > 0 ? std::pow(cosine, exponent_) : 1.0);
  } else {
    // A mantle shows about its area / pi from the side, and less along its axis.
    const double cosine = front_.dot(to_centre) / distance;
    shown = area_ / kPi * std::max(0.1, std::sqrt(std::max(0.0, 1 - cosine * cosine)));
  }
  return shown * height / (distance * distance2);
}

double AreaLuminaire::expected_near(const Vec3& x, const Vec3& n) const {
  const auto of_polygon = [&](std::span<const Vec3> corners) {
    return lambert_irradiance(ClippedPolygon(corners, x, n).corners(), n);
  };
  if (const auto* r = std::get_if<Rectangle>(&shape_)) {
    const std::array<Vec3, 4> corners{r->corner, r->corner + r->edge_u, r->corner + r->edge_u + r->edge_v,
                                      r->corner + r->edge_v};
    return of_polygon(corners);
  }
  if (const auto* t = std::get_if<Triangle>(&shape_)) return of_polygon(t->corners);
  if (const auto* p = std::get_if<Polygon>(&shape_)) return of_polygon(p->corners);
  if (const auto* s = std::get_if<Sphere>(&shape_)) {
    const SphereSampler sampler(*s, x, n, Density::kArea, is_clear_);
    return sampler.lights() ? sampler.irradiance() : -1;
  }
  if (const auto* d = std::get_if<Disk>(&shape_)) {
    const DiskSampler sampler(*d, x, n, Density::kArea);
    return sampler.lights() ? sampler.irradiance() : -1;
  }
  // Mantles: rings of the surface, each as far as its middle or as near as its wall.
  const CurvedShape& shape = [&]() -> CurvedShape {
    if (const auto* c = std::get_if<Cylinder>(&shape_)) return *c;
    return std::get<Mantle>(shape_).patches->shape();
  }();
  const Frustum f = frustum_of(shape);
  constexpr int kRings = 4;
  double sum = 0;
  for (int i = 0; i < kRings; ++i) {
    const double along = (i + 0.5) / kRings;
    const Vec3 to = f.base + along * f.height * f.axis - x;
    const double r = f.r0 + along * (f.r1 - f.r0);
    const double height = std::max(n.dot(to), 0.0) + 0.3 * r;
    const double distance2 =
        std::max(to.squaredNorm(), 0.25 * (r * r + f.height * f.height / (kRings * kRings)));
    sum += area_ / (kRings * kPi) * std::min(1.0, height / std::sqrt(distance2)) / distance2;
  }
  return sum;
}

double AreaLuminaire::expected_irradiance(const Vec3& x, const Vec3& n) const {
  const Vec3 to_centre = centre_ - x;
  const double height = n.dot(to_centre);
  if (height <= -reach_ || faces_away(x)) return 0;
  const double distance2 = to_centre.squaredNorm();
  if (distance2 > kFarRadii * kFarRadii * reach_ * reach_) {
    // Of a shape that the horizon cuts, about what is above it.
    const double height_above = std::max(height, 0.25 * (height + reach_));
    return std::max(expected_far(to_centre, height_above, distance2), kLeastExpected * area_ / distance2);
  }
  const double near = expected_near(x, n);
  if (near < 0) return 0;
  // A part just above the horizon must keep a weight even when a formula rounds to 0.
  const double least = kLeastExpected * std::min(1.0, area_ / std::max(distance2, 1e-30));
  double e = std::isfinite(near) ? std::max(near, least) : least;
  if (exponent_ > 0 && flat_) {
    const double cosine = front_.dot(x - centre_) / std::sqrt(distance2);
    e *= std::max(std::pow(std::max(cosine, 0.0), exponent_), 1e-3);
  }
  return e;
}

bool AreaLuminaire::sample(const Vec3& x, const Vec3& n, double u0, double u1, AreaSample& result) const {
  const auto ratio = [&] { return (centre_ - x).norm() / (2 * reach_); };
  const auto drawn_from = [&](const auto& sampler) {
    return sampler.lights() ? sampler.sample(u0, u1) : ShapePoint{};
  };
  const auto draw = [&]() -> ShapePoint {
    if (const auto* r = std::get_if<Rectangle>(&shape_))
      return drawn_from(
          RectangleSampler(r->corner, r->edge_u, r->edge_v, front_, x, n, density_of_polygon(ratio())));
    if (const auto* t = std::get_if<Triangle>(&shape_))
      return drawn_from(TriangleSampler(t->corners, front_, x, n, density_of_polygon(ratio())));
    if (const auto* p = std::get_if<Polygon>(&shape_))
      return drawn_from(ConvexPolygonSampler(p->corners, front_, x, n, density_of_polygon(ratio())));
    if (const auto* s = std::get_if<Sphere>(&shape_))
      return drawn_from(SphereSampler(*s, x, n, density_of_sphere(), is_clear_));
    if (const auto* d = std::get_if<Disk>(&shape_))
      return drawn_from(DiskSampler(*d, x, n, density_of_disk(ratio())));
    if (const auto* c = std::get_if<Cylinder>(&shape_))
      return drawn_from(CylinderSampler(*c, x, n, density_of_cylinder(ratio())));
    return sample_mantle(*std::get<Mantle>(shape_).patches, x, n, u0, u1);
  };
  const ShapePoint drawn = draw();
  if (!(drawn.irradiance > 0)) return false;
  result.point = drawn.point;
  result.normal = drawn.normal;
  result.factor = drawn.irradiance;
  result.pdf_per_sr = drawn.pdf_per_sr;
  if (exponent_ > 0) result.factor *= std::pow(drawn.cos_emit, exponent_);
  return true;
}

}  // namespace reemit

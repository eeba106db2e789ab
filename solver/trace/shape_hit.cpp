#include "solver/trace/shape_hit.h"

#include <cmath>
#include <limits>

namespace reemit {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
/// How far mantles and disks reach beyond their rims [normalised units], so that no ray slips between them
/// and the faces that they meet there, whose corners are rounded to single precision.
constexpr double kRim = 2e-7;
/// A disk in the plane of a face is hit first: it is what was put there.
constexpr double kProud = 1e-6;
constexpr double kRimBand = 4 * kProud;
/// A round shape that is met from within comes before what touches it from outside, disks included: where
/// they touch both are equally far.
constexpr double kEncloses = 2 * kProud;

/// Distance of a hit from within.
double before_what_touches(double exit, double near) {
  return exit - kEncloses > near ? exit - kEncloses : exit;
}

}  // namespace

ShapeTarget::ShapeTarget(const CurvedShape& shape) : is_sphere_(std::holds_alternative<Sphere>(shape)) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    centre_ = sphere->centre;
    radius_ = sphere->radius;
  } else {
    frustum_ = frustum_of(shape);
  }
  const auto [low, high] = shape_bounds(shape);
  constexpr double kMargin = 1e-6;
  low_ = low - Vec3::Constant(kMargin);
  high_ = high + Vec3::Constant(kMargin);
}

double ShapeTarget::nearest(const Vec3& origin, const Vec3& d, double near, double far) const {
  if (is_sphere_) return nearest_on_sphere(centre_ - origin, d, near, far);
  return frustum_.height > 0 ? nearest_on_mantle(origin - frustum_.base, d, near, far)
                             : on_disk(origin - frustum_.base, d, near, far);
}

double ShapeTarget::nearest_on_sphere(const Vec3& to_centre, const Vec3& d, double near, double far) const {
  const double d2 = d.squaredNorm();
  const double middle = d.dot(to_centre) / d2;
  // The distance of the centre from the ray, rather than a difference of squares, keeps small spheres exact.
  const double rest = radius_ * radius_ - (to_centre - middle * d).squaredNorm();
  if (rest < 0) return kNone;
  const double half = std::sqrt(rest / d2);
  if (middle - half > near) return middle - half < far ? middle - half : kNone;
  if (!(middle + half > near)) return kNone;
  const bool starts_within = middle - half < 0;
  const double exit = starts_within ? before_what_touches(middle + half, near) : middle + half;
  return exit < far ? exit : kNone;
}

double ShapeTarget::nearest_on_mantle(const Vec3& p, const Vec3& d, double near, double far) const {
  const Frustum& f = frustum_;
  // Radius r0 - slope h at height h: |radial part of p + t d| = that.
  const double slope = (f.r0 - f.r1) / f.height;
  const double hp = f.axis.dot(p);
  const double hd = f.axis.dot(d);
  const Vec3 rp = p - hp * f.axis;
  const Vec3 rd = d - hd * f.axis;
  const double a = rd.squaredNorm() - slope * slope * hd * hd;
  const auto from_inside = [&](double t) {
    return rd.dot(rp + t * rd) + slope * hd * (f.r0 - slope * (hp + t * hd)) > 0;
  };
  const auto reaches = [&](double t) {
    const double h = hp + t * hd;
    if (h >= 0 && h <= f.height) return true;
    if (h < -kRim || h > f.height + kRim) return false;
    // From the inside only on the way out: a ray that comes in over the rim has met what closes the end, or
    // passes the body.
    return !from_inside(t) || (h < 0) == (hd < 0);
  };
  double t0 = kNone;
  double t1 = kNone;
  if (slope == 0) {  // shift to the point nearest to the axis, as for spheres
    if (!(a > 0)) return kNone;
    const double middle = -rd.dot(rp) / a;
    const double rest = f.r0 * f.r0 - (rp + middle * rd).squaredNorm();
    if (rest < 0) return kNone;
    const double half = std::sqrt(rest / a);
    t0 = middle - half;
    t1 = middle + half;
  } else {
    const double rim = f.r0 - slope * hp;
    const double b = rd.dot(rp) + slope * hd * rim;
    const double c = rp.squaredNorm() - rim * rim;
    const double discriminant = b * b - a * c;
    if (discriminant < 0) return kNone;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    t0 = a != 0 ? q / a : kNone;
    t1 = q != 0 ? c / q : kNone;
    if (t1 < t0) std::swap(t0, t1);
  }
  // Not of rays that come in over a rim: where they meet it, what closes the end must come first.
  const double rim_here = f.r0 - slope * hp;
  const bool starts_within = hp > 0 && hp < f.height && rp.squaredNorm() < rim_here * rim_here;
  for (const double t : {t0, t1}) {
    if (!(t > near && reaches(t))) continue;
    const double hit = starts_within ? before_what_touches(t, near) : t;
    if (hit < far) return hit;
  }
  return kNone;
}

double ShapeTarget::on_disk(const Vec3& p, const Vec3& d, double near, double far) const {
  const Frustum& f = frustum_;
  const double hd = f.axis.dot(d);
  if (hd == 0) return kNone;
  const double plane = -f.axis.dot(p) / hd;
  const Vec3 at = p + plane * d;
  const Vec3 radial = at - f.axis.dot(at) * f.axis;
  const double r2 = radial.squaredNorm();
  const bool front = hd < 0;
  // Beyond the rims a back is met from within the body that the disk closes, not by rays that pass outside.
  const double way = d.dot(radial);
  const bool from_within = way > 0 && r2 - way * way / (d - hd * f.axis).squaredNorm() <= f.r0 * f.r0;
  const double outer = f.r0 + (front || from_within ? kRim : 0);
  const double inner = f.r1 > 0 ? f.r1 - (front || way < 0 ? kRim : 0) : 0;
  if (r2 > outer * outer || r2 < inner * inner) return kNone;
  // Close to the rims a back lies behind the mantle that hides it from outside.
  const bool at_rim = r2 > std::pow(f.r0 - kRimBand, 2) || (f.r1 > 0 && r2 < std::pow(f.r1 + kRimBand, 2));
  const double t = plane * (front || !at_rim ? 1 - kProud : 1 + kProud);
  return t > near && t < far ? t : kNone;
}

}  // namespace reemit

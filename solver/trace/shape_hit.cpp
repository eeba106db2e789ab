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
/// How much sooner a shape is met from within.
constexpr double kEncloses = 2 * kProud;
static_assert(kEncloses <= ShapeTarget::kSooner);

double nearest_of(double a, double b, double near, double far) {
  if (a > near && a < far) return a;
  return b > near && b < far ? b : kNone;
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
  constexpr double kBoxMargin = 1e-6;
  low_ = low - Vec3::Constant(kBoxMargin);
  high_ = high + Vec3::Constant(kBoxMargin);
}

double ShapeTarget::nearest(const Vec3& origin, const Vec3& d, double near, double far) const {
  if (is_sphere_) return nearest_on_sphere(centre_ - origin, d, near, far);
  return frustum_.height > 0 ? nearest_on_mantle(origin - frustum_.base, d, near, far)
                             : on_disk(origin - frustum_.base, d, near, far);
}

double ShapeTarget::first(const Vec3& origin, const Vec3& d, double near, double far) const {
  const double exact = nearest(origin, d, near, far + kEncloses);
  if (exact == kNone) return kNone;  // as of most shapes that are asked
  if (!encloses(origin)) return exact < far ? exact : kNone;
  const double sooner = exact - kEncloses;
  const double hit = sooner > near ? sooner : exact;
  return hit < far ? hit : kNone;
}

// Of a mantle, between its ends: rays that come in over a rim must meet first what closes that end.
bool ShapeTarget::encloses(const Vec3& point) const {
  if (is_sphere_) return (point - centre_).squaredNorm() < radius_ * radius_;
  const Vec3 from_base = point - frustum_.base;
  const double height = frustum_.axis.dot(from_base);
  if (!(height > 0 && height < frustum_.height)) return false;
  const double radius = frustum_.r0 + (frustum_.r1 - frustum_.r0) * height / frustum_.height;
  return (from_base - height * frustum_.axis).squaredNorm() < radius * radius;
}

double ShapeTarget::nearest_on_sphere(const Vec3& to_centre, const Vec3& d, double near, double far) const {
  const double d2 = d.squaredNorm();
  const double middle = d.dot(to_centre) / d2;
  // The distance of the centre from the ray, rather than a difference of squares, keeps small spheres exact.
  const double rest = radius_ * radius_ - (to_centre - middle * d).squaredNorm();
  if (rest < 0) return kNone;
  const double half = std::sqrt(rest / d2);
  return nearest_of(middle - half, middle + half, near, far);
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
  const auto reaches = [&](double t) {
    const double h = hp + t * hd;
    if (h >= 0 && h <= f.height) return true;
    if (h < -kRim || h > f.height + kRim) return false;
    // From the inside only on the way out: a ray that comes in over the rim has met what closes the end, or
    // passes the body.
    const bool from_inside = rd.dot(rp + t * rd) + slope * hd * (f.r0 - slope * h) > 0;
    return !from_inside || (h < 0) == (hd < 0);
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
  if (!(t0 > near && t0 < far && reaches(t0))) t0 = kNone;
  if (t0 < kNone) return t0;
  return t1 > near && t1 < far && reaches(t1) ? t1 : kNone;
}

double ShapeTarget::on_disk(const Vec3& p, const Vec3& d, double near, double far) const {
  const Frustum& f = frustum_;
  const double hd = f.axis.dot(d);
  if (hd == 0) return kNone;
  const double plane = -f.axis.dot(p) / hd;
  if (!(plane * (1 + kProud) > near && plane * (1 - kProud) < far)) return kNone;
  const Vec3 at = p + plane * d;
  const Vec3 radial = at - f.axis.dot(at) * f.axis;
  const double r2 = radial.squaredNorm();
  const bool front = hd < 0;
  const double way = d.dot(radial);
  if (r2 > f.r0 * f.r0) {
    // Beyond the rims a back is met from within the body that the disk closes, not by rays that pass outside.
    const bool from_within = way > 0 && r2 - way * way / (d - hd * f.axis).squaredNorm() <= f.r0 * f.r0;
    if (!(front || from_within) || r2 > (f.r0 + kRim) * (f.r0 + kRim)) return kNone;
  }
  const double inner = f.r1 > 0 ? f.r1 - (front || way < 0 ? kRim : 0) : 0;
  if (r2 < inner * inner) return kNone;
  // Close to the rims a back lies behind the mantle that hides it from outside.
  const bool at_rim = r2 > std::pow(f.r0 - kRimBand, 2) || (f.r1 > 0 && r2 < std::pow(f.r1 + kRimBand, 2));
  const double t = plane * (front || !at_rim ? 1 - kProud : 1 + kProud);
  return t > near && t < far ? t : kNone;
}

}  // namespace reemit

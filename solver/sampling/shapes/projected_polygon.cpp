#include "solver/sampling/shapes/projected_polygon.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/sampling/shapes/monotone_root.h"
#include "solver/sampling/shapes/plane_maps.h"

namespace reemit {
namespace {

using Vec2 = Eigen::Vector2d;
using Corners = std::array<Vec3, kMostCorners + 1>;

double cross2(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Term of Lambert's formula for the edge p-q: signed area between its projection and the origin.
double sector_area(const Vec3& p, const Vec3& q, const Vec3& n) {
  const Vec3 cross = p.cross(q - p);
  const double length = cross.norm();
  return length > 0 ? 0.5 * n.dot(cross) / length * std::atan2(length, p.dot(q)) : 0.0;
}

/// Slope of the plane through the origin, p and q: z = slope . (x, y). Pre: it is not vertical.
Vec2 plane_slope(const Vec3& p, const Vec3& q) {
  const Vec3 cross = p.cross(q - p);
  return -cross.head<2>() / cross.z();
}

/// Area of the sector of an arc of slope `a` from azimuth direction d0 to d, (c, s) the cosine and sine of
/// the azimuth between them, in [0, pi].
double arc_area(const Vec2& a, const Vec2& d0, const Vec2& d, double c, double s) {
  const double flat = 1 / std::sqrt(1 + a.squaredNorm());
  return 0.5 * flat * std::atan2(s, flat * (c + a.dot(d0) * a.dot(d)));
}

/// Of an arc in azimuth direction d: squared distance from the origin and squared height on the sphere.
struct Radial {
  double r2, z2;
  Radial(const Vec2& a, const Vec2& d) {
    const double z = a.dot(d);
    r2 = 1 / (1 + z * z);
    z2 = z * z * r2;
  }
};

/// Half the difference of the squared radii of two arcs: area per azimuth.
double width_at(const Vec2& outer, const Vec2& inner, const Vec2& d) {
  const double zo = outer.dot(d);
  const double zi = inner.dot(d);
  return 0.5 * (zi - zo) * (zi + zo) / ((1 + zo * zo) * (1 + zi * zi));
}

/// Azimuth of v about the direction `middle`, replaced by a monotone function of it in [-2, 2].
double azimuth_order(const Vec2& middle, const Vec2& v) {
  const double x = middle.dot(v);
  const double y = cross2(middle, v);
  const double sum = std::fabs(x) + std::fabs(y);
  if (!(sum > 0)) return 0;
  return x >= 0 ? y / sum : std::copysign(2.0, y) - y / sum;
}

Vec2 rotated(const Vec2& d, double c, double s) {
  return {d.x() * c - d.y() * s, d.x() * s + d.y() * c};
}

}  // namespace

double lambert_irradiance(std::span<const Vec3> corners, const Vec3& n) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum += sector_area(corners[i], corners[i + 1 < corners.size() ? i + 1 : 0], n);
  return std::fabs(sum);
}

ProjectedPolygon::ProjectedPolygon(const ClippedPolygon& polygon, const Vec3& n) : n_(n) {
  const Tangents tangents(n);
  e1_ = tangents.t;
  e2_ = tangents.b;
  const std::size_t count = polygon.count;
  if (count < 3) return;
  Corners q;
  std::array<double, kMostCorners + 1> area;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3& p = polygon.corner[i];
    q[i] = {p.dot(e1_), p.dot(e2_), std::max(0.0, p.dot(n))};
  }
  double sum = 0;
  double negative = 0;
  double positive = 0;
  for (std::size_t i = 0; i < count; ++i) {
    area[i] = sector_area(q[i], q[i + 1 < count ? i + 1 : 0], Vec3::UnitZ());
    sum += area[i];
    (area[i] < 0 ? negative : positive) += std::fabs(area[i]);
  }
  if (!(std::fabs(sum) > 0) || !std::isfinite(sum)) return;
  if (sum < 0) {
    std::reverse(q.begin(), q.begin() + static_cast<std::ptrdiff_t>(count));
    std::swap(positive, negative);
  }
  constexpr double kRounding = 1e-13;
  zenith_inside_ = negative <= kRounding * positive;
  if (zenith_inside_) {
    add_sectors(q, count);
  } else {
    add_strips(q, count);
  }
}

void ProjectedPolygon::add_sectors(const Corners& q, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3& a = q[i];
    const Vec3& b = q[i + 1 < count ? i + 1 : 0];
    const double area = sector_area(a, b, Vec3::UnitZ());
    if (!(area > 0)) continue;
    Sector& s = sectors_[count_++];
    s.start = a.normalized();
    Vec3 along = b - a;
    along -= s.start.dot(along) * s.start;
    s.along = along.normalized();
    s.angle = std::atan2(along.norm(), s.start.dot(b));
    s.area_to = total_;
    total_ += area;
  }
}

void ProjectedPolygon::add_strips(const Corners& q, std::size_t count) {
  Vec2 middle{0, 0};
  for (std::size_t i = 0; i < count; ++i) middle += q[i].head<2>();
  const double length = middle.norm();
  if (!(length > 0)) return;
  middle /= length;
  std::array<double, kMostCorners + 1> order;
  std::size_t first = 0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < count; ++i) {
    order[i] = azimuth_order(middle, q[i].head<2>());
    if (order[i] < order[first]) first = i;
    if (order[i] > order[last]) last = i;
  }
  const auto forward = [&](std::size_t i) { return i + 1 < count ? i + 1 : 0; };
  const auto backward = [&](std::size_t i) { return i > 0 ? i - 1 : count - 1; };
  std::size_t outer = first;  // the arcs at hand start here
  std::size_t inner = first;
  Vec2 from = q[first].head<2>().normalized();
  while (outer != last || inner != last) {
    // The nearer end of the two arcs ends the strip.
    const bool outer_ends =
        outer != last && (inner == last || order[forward(outer)] <= order[backward(inner)]);
    const std::size_t end = outer_ends ? forward(outer) : backward(inner);
    const Vec2 to = q[end].head<2>().normalized();
    const double s = cross2(from, to);
    const double c = from.dot(to);
    const std::size_t outer_end = outer == last ? outer : forward(outer);
    const std::size_t inner_end = inner == last ? inner : backward(inner);
    if (s > 0 && outer != outer_end && inner != inner_end && count_ < kMostParts) {
      Strip& strip = strips_[count_];
      strip.outer = plane_slope(q[outer], q[outer_end]);
      strip.inner = plane_slope(q[inner_end], q[inner]);
      if (strip.outer.allFinite() && strip.inner.allFinite()) {
        strip.d0 = from;
        strip.width = std::atan2(s, c);
        strip.area = arc_area(strip.outer, from, to, c, s) - arc_area(strip.inner, from, to, c, s);
        strip.area_to = total_;
        if (strip.area > 0) {
          total_ += strip.area;
          ++count_;
        }
      }
    }
    if (s > 0) from = to;
    (outer_ends ? outer : inner) = end;
  }
}

Vec3 ProjectedPolygon::sample(double u0, double u1) const {
  const double target = u0 * total_;
  std::size_t i = 0;
  if (zenith_inside_) {
    while (i + 1 < count_ && target >= sectors_[i + 1].area_to) ++i;
    const Sector& s = sectors_[i];
    const double end = i + 1 < count_ ? sectors_[i + 1].area_to : total_;
    const double angle = s.angle * (target - s.area_to) / (end - s.area_to);
    const Vec3 edge = std::cos(angle) * s.start + std::sin(angle) * s.along;
    const double inward = std::sqrt(u1);
    return to_world({inward * edge.x(), inward * edge.y(), std::sqrt(1 - u1 + u1 * edge.z() * edge.z())});
  }
  if (count_ == 0) return n_;
  while (i + 1 < count_ && target >= strips_[i + 1].area_to) ++i;
  const Strip& s = strips_[i];
  const auto area = [&](double t) {
    const double cosine = std::cos(t);
    const double sine = std::sin(t);
    const Vec2 d = rotated(s.d0, cosine, sine);
    return ValueAndSlope{arc_area(s.outer, s.d0, d, cosine, sine) - arc_area(s.inner, s.d0, d, cosine, sine),
                         width_at(s.outer, s.inner, d)};
  };
  const Vec2 d1 = rotated(s.d0, std::cos(s.width), std::sin(s.width));
  const double t = monotone_root(area, target - s.area_to, s.area, s.width, width_at(s.outer, s.inner, s.d0),
                                 width_at(s.outer, s.inner, d1));
  const Vec2 d = rotated(s.d0, std::cos(t), std::sin(t));
  const Radial outer(s.outer, d);
  const Radial inner(s.inner, d);
  const double r = std::sqrt(inner.r2 + u1 * (outer.r2 - inner.r2));
  return to_world({r * d.x(), r * d.y(), std::sqrt(std::max(0.0, inner.z2 + u1 * (outer.z2 - inner.z2)))});
}

std::array<double, 2> ProjectedPolygon::invert(const Vec3& direction) const {
  if (count_ == 0) return {0.5, 0.5};
  const Vec3 p(direction.dot(e1_), direction.dot(e2_), direction.dot(n_));
  const Vec2 xy = p.head<2>();
  const double r2 = xy.squaredNorm();
  if (zenith_inside_) {
    for (std::size_t i = 0; i < count_; ++i) {
      // The point of the edge in the same azimuth: where its circle meets the vertical plane through p.
      const Sector& s = sectors_[i];
      const double angle = std::atan2(cross2(s.start.head<2>(), xy), -cross2(s.along.head<2>(), xy));
      if (angle < -1e-12 || angle > s.angle * (1 + 1e-12)) continue;
      const Vec3 edge = std::cos(angle) * s.start + std::sin(angle) * s.along;
      const double end = i + 1 < count_ ? sectors_[i + 1].area_to : total_;
      const double share = std::clamp(angle / s.angle, 0.0, 1.0);
      return {(s.area_to + share * (end - s.area_to)) / total_,
              std::clamp(r2 / edge.head<2>().squaredNorm(), 0.0, 1.0)};
    }
    return {0.5, 0.0};
  }
  const Vec2 d = xy / std::sqrt(std::max(r2, 1e-300));
  std::size_t i = 0;
  while (i + 1 < count_ && cross2(strips_[i + 1].d0, d) >= 0) ++i;
  const Strip& s = strips_[i];
  const double sine = cross2(s.d0, d);
  const double cosine = s.d0.dot(d);
  const double share = std::clamp(arc_area(s.outer, s.d0, d, cosine, std::max(0.0, sine)) -
                                      arc_area(s.inner, s.d0, d, cosine, std::max(0.0, sine)),
                                  0.0, s.area);
  const Radial outer(s.outer, d);
  const Radial inner(s.inner, d);
  const double span = outer.r2 - inner.r2;
  return {(s.area_to + share) / total_, span > 0 ? std::clamp((r2 - inner.r2) / span, 0.0, 1.0) : 0.5};
}

}  // namespace reemit

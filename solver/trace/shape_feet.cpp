#include "solver/trace/shape_feet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "mesh/geometry/box_pairs.h"
#include "mesh/shapes/shape_contacts.h"

namespace reemit {
namespace {

/// A shape this close to a plane stands on it: the rounding of corners. One that stands off farther leaves a
/// gap that light may pass, one sunk in deeper has been cut.
constexpr double kFootTouching = 4e-6;
/// Distance from a mantle at which rays start beside it.
constexpr double kBeside = 4e-6;
/// Gap between a sphere and a face in which rays can start: several times RayTracer::kLift.
constexpr double kGap = 8e-6;
/// What snapping may have moved the corners of a cut by.
constexpr double kSnapped = 1e-4;

Vec3 across(const Vec3& offset, const Vec3& axis) {
  return offset - axis.dot(offset) * axis;
}

/// Barycentric u, v of the point of a triangle nearest to p.
std::array<double, 2> nearest_in(const std::array<Vec3, 3>& t, const Vec3& p) {
  const Vec3 e1 = t[1] - t[0];
  const Vec3 e2 = t[2] - t[0];
  const Vec3 n = e1.cross(e2);
  const double scale = 1 / n.squaredNorm();
  const double u = n.dot((p - t[0]).cross(e2)) * scale;
  const double v = n.dot(e1.cross(p - t[0])) * scale;
  if (u >= 0 && v >= 0 && u + v <= 1) return {u, v};
  double best = std::numeric_limits<double>::infinity();
  std::array<double, 2> found{};
  constexpr std::array<std::array<double, 2>, 3> kCorner{{{0, 0}, {1, 0}, {0, 1}}};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const Vec3 along = t[next] - t[k];
    const double s = std::clamp((p - t[k]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double d = (t[k] + s * along - p).squaredNorm();
    if (d >= best) continue;
    best = d;
    for (std::size_t i = 0; i < 2; ++i) found[i] = (1 - s) * kCorner[k][i] + s * kCorner[next][i];
  }
  return found;
}

Vec3 point_at(const std::array<Vec3, 3>& t, const std::array<double, 2>& at) {
  return t[0] + at[0] * (t[1] - t[0]) + at[1] * (t[2] - t[0]);
}

double distance_to(const std::array<Vec3, 3>& t, const Vec3& p) {
  return (point_at(t, nearest_in(t, p)) - p).norm();
}

/// Whether a circle lies in the plane of a triangle.
bool lies_in_plane(const Vec3& centre, const Vec3& axis, double radius, const std::array<Vec3, 3>& t,
                   const Vec3& normal) {
  return std::abs(normal.dot(centre - t[0])) + radius * axis.cross(normal).norm() <= kFootTouching;
}

/// Whether a line from `from` comes near something whose distance from a point is given.
template <class Distance>
bool comes_near(const Vec3& from, const Vec3& along, double near, Distance&& distance) {
  constexpr int kLooks = 32;
  for (int i = 0; i <= kLooks; ++i)
    if (distance(from + along * i / kLooks) <= near + along.norm() / kLooks) return true;
  return false;
}

/// What brings an offset to this length, towards `else_to` if it has none, unless it is as long already.
Vec3 push(const Vec3& offset, double length, const Vec3& else_to) {
  const double distance = offset.norm();
  if (distance >= length) return Vec3::Zero();
  return (length - distance) * (distance > 0 ? Vec3(offset / distance) : else_to);
}

}  // namespace

ShapeFeet::OnTriangle& ShapeFeet::at(std::uint32_t triangle) {
  if (index_[triangle] == kNowhere) {
    index_[triangle] = static_cast<std::uint32_t>(on_.size());
    on_.emplace_back();
    triangles_.push_back(triangle);
  }
  return on_[index_[triangle]];
}

ShapeFeet::ShapeFeet(const ZoneMesh& mesh, const std::vector<Vec3f>& corners,
                     std::span<const CurvedShape> shapes)
    : resting_(shapes.size()), touched_(shapes.size()), index_(mesh.flat_count(), kNowhere) {
  const auto triangle = [&](std::size_t t) {
    return Corners{corners[3 * t].cast<double>(), corners[3 * t + 1].cast<double>(),
                   corners[3 * t + 2].cast<double>()};
  };
  std::vector<IndexedBox> boxes;
  boxes.reserve(mesh.flat_count());
  for (std::uint32_t t = 0; t < mesh.flat_count(); ++t) {
    const auto [a, b, c] = triangle(t);
    boxes.push_back({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c), t});
  }
  const std::vector<IndexedBox> shape_boxes = boxes_of(shapes, kGap);
  std::vector<std::vector<Target>> near(shapes.size());
  for_each_box_pair(shape_boxes, boxes, [&](std::uint32_t shape, std::uint32_t t) {
    near[shape].push_back({t, triangle(t)});
  });
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    for (const Target& face : near[s])
      add_resting(s, shapes[s], face, mesh.triangle_normal(TriangleId(face.triangle)));
    if (!std::holds_alternative<Sphere>(shapes[s])) add_mantle(frustum_of(shapes[s]), mesh, near[s]);
  }
  for_each_box_pair(shape_boxes, shape_boxes, [&](std::uint32_t a, std::uint32_t b) {
    if (const auto* disk = std::get_if<Disk>(&shapes[b])) {
      add_resting_on_disk(a, shapes[a], b, *disk);
    } else if (const auto* second = std::get_if<Sphere>(&shapes[b]); second != nullptr && a < b) {
      if (const auto* first = std::get_if<Sphere>(&shapes[a])) add_spheres(a, *first, b, *second);
    }
  });
}

std::optional<ShapeFeet::Contact> ShapeFeet::contact(const CurvedShape& s, const Vec3& on_plane,
                                                     const Vec3& normal) {
  const auto rests = [&](const Vec3& p) { return std::abs(normal.dot(p - on_plane)) <= kGap; };
  Contact found;
  Resting& resting = found.resting;
  Touch& touch = found.touch;
  double radius = 0;
  if (const auto* sphere = std::get_if<Sphere>(&s)) {
    const double height = normal.dot(sphere->centre - on_plane);
    resting = {sphere->centre, Vec3::Zero(), height > 0 ? Vec3(-normal) : normal, 1};
    radius = sphere->radius;
    touch.from = sphere->centre + radius * resting.low;
    touch.along = Vec3::Zero();
  } else {
    const Frustum f = frustum_of(s);
    if (!(f.height > 0)) return std::nullopt;
    const bool above = normal.dot(f.base + 0.5 * f.height * f.axis - on_plane) > 0;
    const Vec3 down = above ? Vec3(-normal) : normal;
    const Vec3 radial = across(down, f.axis);
    if (radial.norm() < 0.5) return std::nullopt;  // stands rather than lies
    resting = {f.base, f.axis, radial.normalized(), radial.norm()};
    radius = f.r0;
    touch.from = f.base + f.r0 * resting.low;
    touch.along = f.base + f.height * f.axis + f.r1 * resting.low - touch.from;
  }
  if (radius <= 4 * kGap || !rests(touch.from) || !rests(touch.from + touch.along)) return std::nullopt;
  touch.clear = std::sqrt(2 * radius * kGap / resting.steepness);
  touch.normal = normal;
  touch.aside = touch.along.isZero() ? normal.unitOrthogonal() : normal.cross(touch.along).normalized();
  return found;
}

template <class Distance>
std::optional<std::uint32_t> ShapeFeet::rest(std::size_t shape, const CurvedShape& s, const Vec3& on_plane,
                                             const Vec3& normal, Distance&& distance) {
  const std::optional<Contact> found = contact(s, on_plane, normal);
  if (!found) return std::nullopt;
  const Touch& touch = found->touch;
  if (!comes_near(touch.from, touch.along, touch.clear, distance)) return std::nullopt;
  touches_.push_back(touch);
  resting_[shape].push_back(found->resting);
  return static_cast<std::uint32_t>(touches_.size() - 1);
}

void ShapeFeet::add_resting(std::size_t shape, const CurvedShape& s, const Target& face, const Vec3& normal) {
  const auto distance = [&](const Vec3& p) { return distance_to(face.corners, p); };
  if (const auto touch = rest(shape, s, face.corners[0], normal, distance))
    at(face.triangle).touched.push_back(*touch);
}

void ShapeFeet::add_resting_on_disk(std::size_t shape, const CurvedShape& s, std::size_t disk_shape,
                                    const Disk& disk) {
  const auto distance = [&](const Vec3& p) {
    const double from_centre = across(p - disk.centre, disk.normal).norm();
    return std::max({from_centre - disk.radius, disk.inner_radius - from_centre, 0.0});
  };
  if (const auto touch = rest(shape, s, disk.centre, disk.normal, distance))
    touched_[disk_shape].push_back(*touch);
}

// Each of the two keeps clear of the plane that touches both.
void ShapeFeet::add_spheres(std::size_t a, const Sphere& sphere_a, std::size_t b, const Sphere& sphere_b) {
  const Vec3 apart = sphere_b.centre - sphere_a.centre;
  const double distance = apart.norm();
  if (std::min(sphere_a.radius, sphere_b.radius) <= 4 * kGap ||
      std::abs(distance - sphere_a.radius - sphere_b.radius) > kGap)
    return;
  const Vec3 towards = apart / distance;
  resting_[a].push_back({sphere_a.centre, Vec3::Zero(), towards, 1});
  resting_[b].push_back({sphere_b.centre, Vec3::Zero(), -towards, 1});
}

void ShapeFeet::add_mantle(const Frustum& f, const ZoneMesh& mesh, std::span<const Target> near) {
  if (!(f.height > 0)) return;
  const double slope = (f.r1 - f.r0) / f.height;
  add_foot({f.base, f.axis, f.u, f.r0, f.height, slope, {}}, mesh, near);
  add_foot({f.base + f.height * f.axis, -f.axis, f.u, f.r1, f.height, -slope, {}}, mesh, near);
}

void ShapeFeet::add_foot(Foot foot, const ZoneMesh& mesh, std::span<const Target> near) {
  if (!(foot.radius > 4 * kBeside)) return;
  constexpr double kSector = 2 * std::numbers::pi / kFootSides;
  const double apothem = foot.radius * std::cos(0.5 * kSector);
  const Vec3 v = foot.up.cross(foot.u);
  const auto is_within_polygon = [&](const Vec3& p) {
    const Vec3 offset = across(p - foot.centre, foot.up);
    const double azimuth = std::atan2(v.dot(offset), foot.u.dot(offset));
    const double from_middle = azimuth - (std::floor(azimuth / kSector) + 0.5) * kSector;
    return offset.norm() * std::cos(from_middle) < apothem;
  };
  std::vector<std::uint32_t> beside;
  for (const auto& [t, corners] : near) {
    if (!lies_in_plane(foot.centre, foot.up, foot.radius, corners, mesh.triangle_normal(TriangleId(t))))
      continue;
    const double nearest = distance_to(corners, foot.centre);
    if (nearest > foot.radius - 1e-7) continue;
    if (is_within_polygon((corners[0] + corners[1] + corners[2]) / 3)) {
      for (const Vec3& c : corners)  // a face that could not be cut here
        if (across(c - foot.centre, foot.up).norm() > foot.radius + kSnapped) return;
      foot.within.push_back({t, corners});
    } else {
      if (nearest < apothem - kSnapped) return;
      beside.push_back(t);
    }
  }
  if (beside.empty()) return;
  const auto number = static_cast<std::uint32_t>(feet_.size());
  feet_.push_back(std::move(foot));
  for (const std::uint32_t t : beside) at(t).beside.push_back(number);
}

Vec3 ShapeFeet::clear_of(const std::vector<std::uint32_t>& touches, Vec3 p) const {
  for (const std::uint32_t k : touches) {
    const Touch& touch = touches_[k];
    const double length2 = touch.along.squaredNorm();
    const double t = length2 > 0 ? std::clamp((p - touch.from).dot(touch.along) / length2, 0.0, 1.0) : 0.0;
    p += push(across(p - touch.from - t * touch.along, touch.normal), touch.clear, touch.aside);
  }
  return p;
}

Vec3f ShapeFeet::clear_of_shapes(std::size_t triangle, const Vec3f& start) const {
  const OnTriangle& on = on_[index_[triangle]];
  Vec3 p = start.cast<double>();
  for (const std::uint32_t f : on.beside)
    p += push(across(p - feet_[f].centre, feet_[f].up), feet_[f].radius + kBeside, feet_[f].u);
  return clear_of(on.touched, p).cast<float>();
}

ShapeFeet::Place ShapeFeet::place_of(const Place& hit, const Vec3& origin, const Vec3& direction,
                                     double distance) const {
  for (const std::uint32_t number : on_[index_[hit.triangle]].beside) {
    const Foot& foot = feet_[number];
    if (foot.within.empty()) continue;
    const Vec3 point = origin + distance * direction;
    if (across(point - foot.centre, foot.up).norm() > foot.radius + kBeside) continue;
    // The side is that of the way the ray came, a little before its end, where rounding decides nothing.
    const double back = std::min(0.5 * distance, 0.01 * std::min(foot.radius, foot.height));
    const Vec3 before = point - back * direction - foot.centre;
    const double height = foot.up.dot(before);
    if (across(before, foot.up).norm() >= foot.radius + foot.widening * height) continue;
    Place best = hit;
    double smallest = std::numeric_limits<double>::infinity();
    for (const auto& [t, corners] : foot.within) {
      const std::array<double, 2> at = nearest_in(corners, point);
      const double d = (point_at(corners, at) - point).squaredNorm();
      if (d >= smallest) continue;
      smallest = d;
      best = {t, static_cast<float>(at[0]), static_cast<float>(at[1])};
    }
    return best;
  }
  return hit;
}

Vec3 ShapeFeet::clear_of_others(std::size_t shape, const Vec3& point) const {
  Vec3 p = clear_of(touched_[shape], point);
  for (const Resting& r : resting_[shape]) {
    const Vec3 centre = r.base + r.axis.dot(p - r.base) * r.axis;
    const Vec3 radial = p - centre;
    const double radius = radial.norm();
    // Cosine of the angle from `low` at which the shape is kGap above the plane.
    const double cosine = std::max(-1.0, 1 - kGap / (radius * r.steepness));
    if (!(radial.dot(r.low) > radius * cosine)) continue;
    const Vec3 aside = across(radial, r.low);
    const double length = aside.norm();
    const Vec3 side = length > 0 ? Vec3(aside / length)
                                 : (r.axis.isZero() ? r.low.unitOrthogonal() : Vec3(r.axis.cross(r.low)));
    p = centre + radius * (cosine * r.low + std::sqrt(1 - cosine * cosine) * side);
  }
  return p;
}

}  // namespace reemit

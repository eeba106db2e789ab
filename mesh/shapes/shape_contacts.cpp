#include "mesh/shapes/shape_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace reemit {
namespace {

using Points = std::array<std::optional<Vec3>, kFootSides>;

Points circle(const Vec3& centre, const Vec3& u, const Vec3& v, double radius) {
  Points points;
  for (int i = 0; i < kFootSides; ++i) {
    const double azimuth = 2 * std::numbers::pi * i / kFootSides;
    points[static_cast<std::size_t>(i)] = centre + radius * (std::cos(azimuth) * u + std::sin(azimuth) * v);
  }
  return points;
}

void append_closed(const Points& points, const PlaneFrame& plane, std::vector<PlanarSegment>& out) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& from = points[i];
    const auto& to = points[(i + 1) % points.size()];
    if (from && to) out.push_back({plane.project(*from), plane.project(*to)});
  }
}

/// Circle in which a sphere passes through a plane; nothing where it touches within `contact` only.
std::optional<Points> section_of(const Sphere& sphere, const PlaneFrame& plane, double contact) {
  const double height = plane.height(sphere.centre);
  if (std::abs(height) > sphere.radius - contact) return std::nullopt;
  const double radius = std::sqrt(sphere.radius * sphere.radius - height * height);
  return circle(sphere.centre - height * plane.normal, plane.u, plane.v, radius);
}

/// Points where the straight lines of a mantle pass through a plane.
Points section_of(const Frustum& f, const PlaneFrame& plane, double contact) {
  Points points;
  const Points wide = circle(f.base, f.u, f.v, f.r0);
  const Points narrow = circle(f.base + f.height * f.axis, f.u, f.v, f.r1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double a = plane.height(*wide[i]);
    const double b = plane.height(*narrow[i]);
    if ((a > contact && b < -contact) || (a < -contact && b > contact))
      points[i] = *wide[i] + a / (a - b) * (*narrow[i] - *wide[i]);
  }
  return points;
}

bool any_point_inside(const Vec2& from, const Vec2& to, const PlanarLoops& loops) {
  for (int i = 0; i <= kFootSides; ++i) {
    const double s = static_cast<double>(i) / kFootSides;
    if (loops.contains((1 - s) * from + s * to)) return true;
  }
  return false;
}

/// Whether a mantle reaches farther than `contact` to both sides of a plane within the loops of a face. It
/// may do so across its axis or along it, like a log that lies half in the floor.
bool passes_through(const Frustum& f, const PlaneFrame& plane, double contact, const PlanarLoops& loops) {
  // The lowest and highest lines of the mantle are among those looked at.
  const Vec3 steepest = plane.normal - f.axis.dot(plane.normal) * f.axis;
  const Vec3 u = steepest.norm() > 1e-9 ? Vec3(steepest.normalized()) : f.u;
  const Vec3 v = f.axis.cross(u);
  const Points wide = circle(f.base, u, v, f.r0);
  const Points narrow = circle(f.base + f.height * f.axis, u, v, f.r1);
  for (std::size_t i = 0; i < wide.size(); ++i) {
    const std::size_t next = (i + 1) % wide.size();
    const std::array<Vec3, 4> quad{*wide[i], *wide[next], *narrow[next], *narrow[i]};
    std::array<double, 4> height{};
    for (std::size_t k = 0; k < 4; ++k) height[k] = plane.height(quad[k]);
    if (*std::min_element(height.begin(), height.end()) >= -contact ||
        *std::max_element(height.begin(), height.end()) <= contact)
      continue;
    std::vector<Vec2> section;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t after = (k + 1) % 4;
      if ((height[k] < 0) == (height[after] < 0)) continue;
      const double t = height[k] / (height[k] - height[after]);
      section.push_back(plane.project(quad[k] + t * (quad[after] - quad[k])));
    }
    for (std::size_t k = 1; k < section.size(); ++k)
      if (any_point_inside(section[k - 1], section[k], loops)) return true;
  }
  return false;
}

bool lies_in(const Vec3& centre, double radius, const Vec3& axis, const PlaneFrame& plane, double contact) {
  const double tilt = axis.cross(plane.normal).norm();
  return std::abs(plane.height(centre)) + radius * tilt <= contact;
}

/// The line in which a disk passes through a plane.
std::optional<PlanarSegment> chord_of(const Frustum& f, const PlaneFrame& plane, double contact) {
  const Vec3 along = f.axis.cross(plane.normal);
  const double sine = along.norm();
  if (!(sine * f.r0 > contact)) return std::nullopt;
  const Vec3 towards = along.cross(f.axis) / sine;  // in the disk, down to the plane
  const double offset = plane.height(f.base) / sine;
  if (std::abs(offset) > f.r0 - contact) return std::nullopt;
  const Vec3 sign_fixed = towards.dot(plane.normal) > 0 ? Vec3(-towards) : towards;
  const Vec3 middle = f.base + offset * sign_fixed;
  const Vec3 half = std::sqrt(f.r0 * f.r0 - offset * offset) * along / sine;
  return PlanarSegment{plane.project(middle - half), plane.project(middle + half)};
}

}  // namespace

void section_with_plane(const CurvedShape& shape, const PlaneFrame& plane, double contact,
                        std::vector<PlanarSegment>& out) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    if (const auto points = section_of(*sphere, plane, contact)) append_closed(*points, plane, out);
    return;
  }
  const Frustum f = frustum_of(shape);
  const Vec3 top = f.base + f.height * f.axis;
  if (lies_in(f.base, f.r0, f.axis, plane, contact))
    append_closed(circle(f.base, f.u, f.v, f.r0), plane, out);
  if (f.r1 > 0 && lies_in(top, f.r1, f.axis, plane, contact))
    append_closed(circle(top, f.u, f.v, f.r1), plane, out);
  if (f.height > 0) {
    append_closed(section_of(f, plane, contact), plane, out);
  } else if (const auto chord = chord_of(f, plane, contact)) {
    out.push_back(*chord);
  }
}

bool is_pierced(const CurvedShape& shape, const VertexTable& vertices, const FacePiece& piece,
                double contact) {
  const PlaneFrame& plane = piece.plane;
  const PlanarLoops loops(vertices, piece, plane);
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    const auto points = section_of(*sphere, plane, contact);
    return points && std::any_of(points->begin(), points->end(), [&](const std::optional<Vec3>& p) {
             return p && loops.contains(plane.project(*p));
           });
  }
  const Frustum f = frustum_of(shape);
  if (f.height > 0) return passes_through(f, plane, contact, loops);
  const auto chord = chord_of(f, plane, contact);
  return chord && any_point_inside(chord->from, chord->to, loops);
}

std::vector<IndexedBox> boxes_of(std::span<const CurvedShape> shapes, double margin) {
  std::vector<IndexedBox> boxes;
  boxes.reserve(shapes.size());
  for (std::uint32_t i = 0; i < shapes.size(); ++i) {
    const auto [low, high] = shape_bounds(shapes[i]);
    boxes.push_back({low - Vec3::Constant(margin), high + Vec3::Constant(margin), i});
  }
  return boxes;
}

}  // namespace reemit

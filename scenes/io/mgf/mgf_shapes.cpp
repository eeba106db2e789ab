#include "scenes/io/mgf/mgf_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "scenes/model/error.h"
#include "scenes/model/measures.h"

namespace reemit {
namespace {

struct CosSin {
  double cos, sin;
};

// Step k of `steps` round a circle, steps divisible by 4. Built from one quadrant, so that the points are
// exactly symmetric and a circle run backwards has the same ones.
CosSin circle_point(int k, int steps) {
  const int quarter = steps / 4;
  const int quadrant = k / quarter % 4, rest = k % quarter;
  const auto value = [&](int i) {  // sin of i steps, 0 <= i <= quarter
    const double angle = 2 * std::numbers::pi / steps;
    return i <= quarter - i ? std::sin(i * angle) : std::cos((quarter - i) * angle);
  };
  const double c = value(quarter - rest), s = value(rest);
  constexpr std::array<std::array<int, 4>, 4> kTurn = {
      {{1, 0, 0, 1}, {0, -1, 1, 0}, {-1, 0, 0, -1}, {0, 1, -1, 0}}};
  const auto& turn = kTurn[static_cast<std::size_t>(quadrant)];
  return {turn[0] * c + turn[1] * s, turn[2] * c + turn[3] * s};
}

// Right-handed axes with `w` along a given axis. An axis and its opposite lead to the same circle points.
struct Frame {
  Vec3 u, v, w;
  Vec3 radial(const CosSin& p) const { return p.cos * u + p.sin * v; }
};

Frame frame_along(const Vec3& axis) {
  Frame frame;
  frame.w = axis.stableNormalized();
  constexpr double kTie = 1e-4;  // rounding of the axis must not decide
  const Vec3 size = frame.w.cwiseAbs();
  const double least = size.minCoeff() + kTie;
  const Vec3 helper = size.x() <= least ? Vec3::UnitX() : (size.y() <= least ? Vec3::UnitY() : Vec3::UnitZ());
  frame.u = frame.w.cross(helper).normalized();
  frame.v = frame.w.cross(frame.u);
  return frame;
}

// A grid of corners with normals, rows x columns of cells; faces look along (row direction) x (column
// direction).
struct Corner {
  Vec3 point, normal;
};

template <class At>
std::vector<Polygon> grid_faces(int rows, int columns, bool inward, const At& at) {
  std::vector<Polygon> faces;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const std::array<Corner, 4> corners = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
      Polygon face;
      for (std::size_t k = 0; k < 4; ++k) {
        const Corner& corner = corners[inward ? 3 - k : k];
        face.outer.push_back(corner.point);
        face.normals.push_back(inward ? Vec3(-corner.normal) : corner.normal);
      }
      for (Polygon& simple : split_at_seams(std::move(face))) faces.push_back(std::move(simple));  // at poles
    }
  }
  return faces;
}

void scale_to_area(std::vector<Polygon>& faces, const Vec3& centre, double area) {
  double have = 0;
  for (const Polygon& face : faces) have += loop_area(face.outer).norm();
  const double factor = have > 0 ? std::sqrt(area / have) : 1;
  for (Polygon& face : faces)
    for (Vec3& p : face.outer) p = centre + factor * (p - centre);
}

Polygon polygon_of(std::span<const MgfVertex> corners) {
  Polygon polygon;
  for (const MgfVertex& corner : corners) polygon.outer.push_back(corner.position);
  return polygon;
}

// Shading normals where corners have them; those that do not get the normal of the plane.
void add_normals(Polygon& polygon, std::span<const MgfVertex> corners) {
  if (std::none_of(corners.begin(), corners.end(), [](const MgfVertex& v) { return v.has_normal(); })) return;
  const Vec3 plane = loop_area(polygon.outer).stableNormalized();
  for (const MgfVertex& corner : corners)
    polygon.normals.push_back(corner.has_normal() ? corner.normal : plane);
}

void check_outline(std::span<const MgfVertex> outline, const std::string& where) {
  if (outline.size() < 3)
    throw InputError(where, fmt::format("an outline with {} vertices", outline.size()),
                     "Give at least 3 vertices.");
}

void check_normal(const MgfVertex& vertex, const char* entity, const std::string& where) {
  if (!vertex.has_normal())
    throw InputError(where, fmt::format("the vertex of '{}' has no normal", entity),
                     "Give the vertex an 'n' entity.");
}

std::vector<Polygon> side_faces(const std::vector<MgfVertex>& loop, const Vec3& shift) {
  std::vector<Polygon> faces;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const MgfVertex& a = loop[i];
    const MgfVertex& b = loop[(i + 1) % loop.size()];
    Polygon side;
    side.outer = {a.position, a.position + shift, b.position + shift, b.position};
    if (a.has_normal() && b.has_normal()) side.normals = {a.normal, a.normal, b.normal, b.normal};
    faces.push_back(std::move(side));
  }
  return faces;
}

using VertexAt = std::map<std::array<double, 3>, const MgfVertex*>;

std::array<double, 3> coordinates_of(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

// The corners of a simple loop that came out of an outline, with the normals they had there.
std::vector<MgfVertex> with_normals(const std::vector<Vec3>& loop, const VertexAt& outline) {
  std::vector<MgfVertex> corners;
  for (const Vec3& point : loop) corners.push_back(*outline.at(coordinates_of(point)));
  return corners;
}

}  // namespace

std::vector<Polygon> mgf_face(const std::vector<std::vector<MgfVertex>>& loops, const std::string& where) {
  for (const auto& loop : loops) check_outline(loop, where);
  Polygon polygon = polygon_of(loops[0]);
  add_normals(polygon, loops[0]);
  for (std::size_t i = 1; i < loops.size(); ++i) polygon.holes.push_back(polygon_of(loops[i]).outer);
  return split_at_seams(std::move(polygon));
}

std::vector<Polygon> mgf_prism(std::span<const MgfVertex> outline, double length, const std::string& where) {
  check_outline(outline, where);
  if (length == 0)
    throw InputError(where, "a prism of length 0", "Give its length, or use 'f' for a flat polygon.");
  const Polygon base = polygon_of(outline);
  const Vec3 shift = -length * loop_area(base.outer).stableNormalized();
  if (!(shift.squaredNorm() > 0))
    throw InputError(where, "the outline of the prism has no area", "Give an outline that spans a plane.");
  VertexAt vertex_at;
  for (const MgfVertex& vertex : outline) vertex_at.emplace(coordinates_of(vertex.position), &vertex);
  std::vector<Polygon> faces;
  for (const Polygon& cap : split_at_seams(base)) {
    Polygon opposite;
    for (const Vec3& point : cap.outer) opposite.outer.push_back(point + shift);
    std::reverse(opposite.outer.begin(), opposite.outer.end());
    for (const auto& hole : cap.holes) {
      auto& shifted = opposite.holes.emplace_back();
      for (const Vec3& point : hole) shifted.push_back(point + shift);
      for (Polygon& side : side_faces(with_normals(hole, vertex_at), shift)) faces.push_back(std::move(side));
    }
    for (Polygon& side : side_faces(with_normals(cap.outer, vertex_at), shift))
      faces.push_back(std::move(side));
    faces.push_back(std::move(opposite));
    faces.push_back(cap);
  }
  return faces;
}

MgfRoundness mgf_roundness(double radius_m, bool emits) {
  constexpr int kLeast = 16, kMost = 32;
  if (emits) return {kMost, true};
  constexpr double kLargestGap = 1e-3;  // [m]; n segments leave a gap of about r pi^2 / (2 n^2)
  const double wanted = std::numbers::pi * std::sqrt(radius_m / (2 * kLargestGap));
  return {8 * static_cast<int>(std::clamp(std::ceil(wanted / 8), kLeast / 8.0, kMost / 8.0)), false};
}

CurvedShape mgf_sphere(const Vec3& centre, double radius, const std::string& where) {
  if (radius == 0)
    throw InputError(where, "a sphere of radius 0", "Give its radius in the units of the file.");
  return Sphere{centre, std::abs(radius), radius < 0};
}

CurvedShape mgf_cone(const Vec3& a, double radius_a, const Vec3& b, double radius_b,
                     const std::string& where) {
  if (radius_a * radius_b < 0 || (radius_a == 0 && radius_b == 0))
    throw InputError(where, fmt::format("radii {} and {}", radius_a, radius_b),
                     "They must have the same sign, and at most one may be 0.");
  if ((b - a).stableNorm() == 0)
    throw InputError(where, "both ends are at the same place", "Use 'ring' for a flat disk.");
  const bool inward = radius_a + radius_b < 0;
  if (radius_a == radius_b) return Cylinder{a, b, std::abs(radius_a), inward};
  return Cone{a, b, std::abs(radius_a), std::abs(radius_b), inward};
}

CurvedShape mgf_ring(const MgfVertex& centre, double inner, double outer, const std::string& where) {
  check_normal(centre, "ring", where);
  if (!(inner >= 0 && outer > inner))
    throw InputError(where, fmt::format("radii {} and {}", inner, outer),
                     "They must satisfy 0 <= inner < outer.");
  return Disk{centre.position, centre.normal.stableNormalized(), outer, inner};
}

std::vector<Polygon> mgf_torus(const MgfVertex& centre, double inner, double outer,
                               const MgfRoundness& roundness, const std::string& where) {
  check_normal(centre, "torus", where);
  if (inner * outer < 0 || std::abs(outer) <= std::abs(inner))
    throw InputError(where, fmt::format("radii {} and {}", inner, outer),
                     "They must have the same sign, and the second must be the larger.");
  const Frame frame = frame_along(centre.normal);
  const double ring = std::abs(outer + inner) / 2;
  const double tube = std::abs(outer - inner) / 2;
  const int around = roundness.segments, across = roundness.segments / 2;
  std::vector<Polygon> faces = grid_faces(around, across, outer < 0, [&](int i, int j) {
    const Vec3 radial = frame.radial(circle_point(i % around, around));
    const CosSin p = circle_point(j % across, across);
    const Vec3 normal = p.cos * radial + p.sin * frame.w;
    return Corner{centre.position + (ring + tube * p.cos) * radial + tube * p.sin * frame.w, normal};
  });
  if (roundness.keep_area)
    scale_to_area(faces, centre.position, 4 * std::numbers::pi * std::numbers::pi * ring * tube);
  return faces;
}

}  // namespace reemit

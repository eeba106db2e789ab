#include "solver/emit/luminaire_faces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "solver/sampling/shapes/clipped_polygon.h"

namespace reemit {
namespace {

constexpr double kSlack = 1e-6;

Vec3 vector_area(const std::vector<Vec3>& corners) {
  Vec3 twice = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    twice += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  return 0.5 * twice;
}

/// Corners of a face if it is a planar convex polygon without holes; empty otherwise.
std::vector<Vec3> convex_corners(const Surface& surface, const Face& face) {
  if (!face.holes.empty() || face.outer.size() > kMostCorners) return {};
  std::vector<Vec3> corners;
  for (const std::uint32_t i : face.outer) corners.push_back(surface.positions[i]);
  const Vec3 area = vector_area(corners);
  const double size = std::sqrt(area.norm());
  if (!(size > 0)) return {};
  const Vec3 normal = area.normalized();
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 edge = corners[(i + 1) % n] - corners[i];
    const Vec3 next = corners[(i + 2) % n] - corners[(i + 1) % n];
    if (std::abs(normal.dot(corners[i] - corners[0])) > kSlack * size) return {};
    if (normal.dot(edge.cross(next)) < -kSlack * edge.norm() * next.norm()) return {};
  }
  return corners;
}

struct Pieces {
  std::vector<TriangleId> triangles;
  double area = 0;
};

}  // namespace

std::vector<LuminaireFace> luminaire_faces(const Scene& scene, const ZoneMesh& mesh) {
  std::map<std::pair<SurfaceId, std::uint32_t>, Pieces> by_face;
  for (std::size_t i = 0; i < mesh.flat_count(); ++i) {
    const TriangleId t(i);
    const BaseTriangle& triangle = mesh.triangle(t);
    if (!scene.material_of(scene.surfaces[triangle.surface.index()]).emits()) continue;
    if (!(mesh.triangle_area(t) > 0)) continue;
    Pieces& pieces = by_face[{triangle.surface, triangle.face}];
    pieces.triangles.push_back(t);
    pieces.area += mesh.triangle_area(t);
  }
  std::vector<LuminaireFace> faces;
  for (const auto& [key, pieces] : by_face) {
    const Surface& surface = scene.surfaces[key.first.index()];
    const TriangleId first = pieces.triangles.front();
    std::vector<Vec3> corners;
    if (key.second < surface.faces.size()) corners = convex_corners(surface, surface.faces[key.second]);
    if (!corners.empty() && std::abs(vector_area(corners).norm() - pieces.area) <= kSlack * pieces.area) {
      faces.push_back(
          {std::move(corners), mesh.triangle_normal(first), key.first, mesh.triangle(first).two_sided});
      continue;
    }
    for (const TriangleId t : pieces.triangles)
      faces.push_back({{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)},
                       mesh.triangle_normal(t),
                       key.first,
                       mesh.triangle(t).two_sided});
  }
  return faces;
}

}  // namespace reemit

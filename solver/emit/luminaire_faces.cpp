#include "solver/emit/luminaire_faces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "mesh/zones/zone_cells.h"
#include "scenes/model/measures.h"
#include "solver/sampling/shapes/clipped_polygon.h"

namespace reemit {
namespace {

constexpr double kSlack = 1e-6;

/// Corners of a face if it is a planar convex polygon without holes; empty otherwise.
std::vector<Vec3> convex_corners(const Surface& surface, const Face& face) {
  if (!face.holes.empty() || face.outer.size() > kMostCorners) return {};
  std::vector<Vec3> corners;
  for (const std::uint32_t i : face.outer) corners.push_back(surface.positions[i]);
  const Vec3 area = loop_area(corners);
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
  Vec3 vector_area = Vec3::Zero();  // sum of area * front normal
};

/// Front of one triangle of a face. A sliver beside a vertex that welding has moved may be tilted by any
/// angle; such a triangle takes the front of the whole face. Where a face is bent, its triangles keep their
/// own.
Vec3 front_of_piece(const ZoneMesh& mesh, TriangleId t, const Pieces& pieces) {
  constexpr double kLeastAltitude = 1e-4;  // of a triangle over its longest edge, for its own normal to count
  double longest2 = 0;
  for (int k = 0; k < 3; ++k)
    longest2 = std::max(longest2, (mesh.corner(t, (k + 1) % 3) - mesh.corner(t, k)).squaredNorm());
  if (2 * mesh.triangle_area(t) >= kLeastAltitude * longest2) return mesh.triangle_normal(t);
  return pieces.vector_area.norm() > 0 ? Vec3(pieces.vector_area.normalized()) : mesh.triangle_normal(t);
}

/// Whether a face does not emit alike everywhere: by a texture, or because not all of it is there.
bool varies(const SurfaceModel& surfaces, const ZoneMesh& mesh, TriangleId t) {
  return surfaces.emission_varies(t) || surfaces.textures().is_cut_out(mesh.triangle(t).surface);
}

}  // namespace

std::vector<LuminaireFace> luminaire_faces(const Room& room) {
  const ZoneMesh& mesh = room.mesh();
  std::map<std::pair<SurfaceId, std::uint32_t>, Pieces> by_face;
  for (std::size_t i = 0; i < mesh.flat_count(); ++i) {
    const TriangleId t(i);
    const BaseTriangle& triangle = mesh.triangle(t);
    if (!room.surfaces().emits(triangle.surface) || varies(room.surfaces(), mesh, t)) continue;
    if (!(mesh.triangle_area(t) > 0)) continue;
    Pieces& pieces = by_face[{triangle.surface, triangle.face}];
    pieces.triangles.push_back(t);
    pieces.area += mesh.triangle_area(t);
    pieces.vector_area += mesh.triangle_area(t) * mesh.triangle_normal(t);
  }
  std::vector<LuminaireFace> faces;
  for (const auto& [key, pieces] : by_face) {
    const Surface& surface = room.scene().surfaces[key.first.index()];
    const bool both_sides = room.surfaces().emits(pieces.triangles.front(), false);
    std::vector<Vec3> corners;
    if (key.second < surface.faces.size()) corners = convex_corners(surface, surface.faces[key.second]);
    const Vec3 outline_area = loop_area(corners);
    if (!corners.empty() && std::abs(outline_area.norm() - pieces.area) <= kSlack * pieces.area) {
      // The outline knows the plane, the mesh which of its sides is the front.
      const Vec3 normal = outline_area.normalized();
      const bool reversed = normal.dot(pieces.vector_area) < 0;
      faces.push_back({std::move(corners), reversed ? Vec3(-normal) : normal, key.first, both_sides});
      continue;
    }
    for (const TriangleId t : pieces.triangles)
      faces.push_back({{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)},
                       front_of_piece(mesh, t, pieces),
                       key.first,
                       both_sides});
  }
  return faces;
}

std::vector<LuminaireCell> luminaire_cells(const Room& room) {
  const ZoneMesh& mesh = room.mesh();
  const SurfaceModel& surfaces = room.surfaces();
  std::vector<LuminaireCell> result;
  if (surfaces.textures().empty()) return result;
  const ZoneCells cells(mesh);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const SideCell cell = cells.cell(i);
    const bool is_flat = !mesh.triangle(cell.triangle).is_curved();
    if (!is_flat || !varies(surfaces, mesh, cell.triangle)) continue;
    if (!surfaces.emits(cell.triangle, cell.front) || !(mesh.triangle_area(cell.triangle) > 0)) continue;
    const SurfaceId surface = mesh.triangle(cell.triangle).surface;
    const Spectrum exitance = surfaces.exitance(cells.zone(i), surface);
    if (!(exitance > 0).any()) continue;
    LuminaireCell& luminaire = result.emplace_back();
    luminaire.corners = corner_points(mesh, cell);
    luminaire.triangle = cell.triangle;
    luminaire.front = cell.front;
    luminaire.radiance = mesh.solid_share(cells.zone(i)) * (surfaces.emission_exponent(surface) + 2) /
                         (2 * std::numbers::pi) * exitance;
  }
  return result;
}

}  // namespace reemit

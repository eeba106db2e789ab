#include "mesh/shapes/room_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "mesh/geometry/box_pairs.h"
#include "mesh/geometry/disjoint_sets.h"
#include "mesh/overlap/coplanar_overlap.h"
#include "mesh/repair/polygon_repair.h"
#include "mesh/shapes/shape_contacts.h"
#include "mesh/shapes/tessellate.h"
#include "mesh/zones/zone_sizing.h"
#include "scenes/io/common/surface_geometry.h"

namespace reemit {
namespace {

/// Sides to a circle of a shape that becomes faces; multiples of kSegmentStep, so that circles with one axis
/// have their corners in the same directions.
constexpr int kFewestSegments = 8;
constexpr int kMostSegments = 32;
constexpr int kSegmentStep = 4;
/// A side may pass the circle's middle by this share of the length of a zone: what is smaller does not show
/// in the light of the room, and a room full of small round things would have most of its triangles from
/// them.
constexpr double kSagittaShare = 1.0 / 200;

/// Circle in which a mantle or a disk ends.
struct Rim {
  Vec3 centre;
  Vec3 axis;
  double radius;
  std::size_t shape;
};

std::vector<Rim> rims_of(std::span<const CurvedShape> shapes) {
  std::vector<Rim> rims;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (std::holds_alternative<Sphere>(shapes[i])) continue;
    const Frustum f = frustum_of(shapes[i]);
    rims.push_back({f.base, f.axis, f.r0, i});
    if (f.r1 > 0) rims.push_back({f.base + f.height * f.axis, f.axis, f.r1, i});
  }
  return rims;
}

/// Calls visit(i, j) for shapes that end in the same circle.
template <class Visit>
void for_each_shared_rim(std::span<const CurvedShape> shapes, const MeshTolerances& tolerances,
                         Visit&& visit) {
  const std::vector<Rim> rims = rims_of(shapes);
  std::vector<IndexedBox> boxes;
  for (std::uint32_t i = 0; i < rims.size(); ++i) {
    const Vec3 margin = Vec3::Constant(tolerances.weld);
    boxes.push_back({rims[i].centre - margin, rims[i].centre + margin, i});
  }
  for_each_box_pair(boxes, boxes, [&](std::uint32_t i, std::uint32_t j) {
    const Rim& a = rims[i];
    const Rim& b = rims[j];
    if (a.shape != b.shape && std::abs(a.radius - b.radius) <= tolerances.weld &&
        a.radius * a.axis.cross(b.axis).norm() <= tolerances.weld)
      visit(a.shape, b.shape);
  });
}

/// Shapes that end in the same circle become faces together: a round cap on a mantle of flat faces would
/// stick out between its corners and show its back.
void add_neighbours(const Scene& room, const RoomShapes& shapes, const MeshTolerances& tolerances,
                    std::vector<bool>& faceted) {
  std::vector<std::vector<std::size_t>> neighbours(shapes.exact.size());
  for_each_shared_rim(shapes.exact, tolerances,
                      [&](std::size_t a, std::size_t b) { neighbours[a].push_back(b); });
  std::vector<std::size_t> spreads;
  for (std::size_t s = 0; s < faceted.size(); ++s)
    if (faceted[s]) spreads.push_back(s);
  while (!spreads.empty()) {
    const std::size_t from = spreads.back();
    spreads.pop_back();
    for (const std::size_t s : neighbours[from]) {
      if (faceted[s] || shapes.emits(room, s)) continue;
      faceted[s] = true;
      spreads.push_back(s);
    }
  }
}

int segments_for(const CurvedShape& shape, double zone_edge) {
  const auto* sphere = std::get_if<Sphere>(&shape);
  const double radius = sphere != nullptr ? sphere->radius : frustum_of(shape).r0;
  int segments = kFewestSegments;
  while (segments < kMostSegments &&
         radius * (1 - std::cos(std::numbers::pi / segments)) > kSagittaShare * zone_edge)
    segments += kSegmentStep;
  return segments;
}

/// Sides to a circle by shape; those that end in the same circle have as many, or there would be slits
/// between them.
std::vector<int> choose_segments(const RoomShapes& shapes, const std::vector<bool>& faceted,
                                 const MeshTolerances& tolerances, double zone_edge) {
  DisjointSets joined(shapes.exact.size());
  for_each_shared_rim(shapes.exact, tolerances, [&](std::size_t a, std::size_t b) {
    if (faceted[a] && faceted[b]) joined.join(a, b);
  });
  std::vector<int> most(shapes.exact.size(), 0);
  for (std::size_t s = 0; s < faceted.size(); ++s)
    if (faceted[s])
      most[joined.find(s)] = std::max(most[joined.find(s)], segments_for(shapes.exact[s], zone_edge));
  std::vector<int> segments(shapes.exact.size(), 0);
  for (std::size_t s = 0; s < faceted.size(); ++s) segments[s] = most[joined.find(s)];
  return segments;
}

std::vector<bool> find_pierced(const Scene& room, const RoomShapes& shapes, const VertexTable& vertices,
                               const std::vector<FacePiece>& pieces, const MeshTolerances& tolerances) {
  std::vector<bool> pierced(shapes.exact.size(), false);
  std::vector<IndexedBox> boxes;
  boxes.reserve(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) boxes.push_back(box_of(vertices, pieces[i], i, 0));
  // Holes are looked up by triangle and place, which patches of shapes have not.
  for (std::size_t s = 0; s < pierced.size(); ++s) pierced[s] = shapes.is_cut_out(room, s);
  for_each_box_pair(boxes_of(shapes.exact, 0), boxes, [&](std::uint32_t s, std::uint32_t piece) {
    if (pierced[s] || shapes.emits(room, s)) return;
    // Not within the contact distance: what sticks out by less than that is a leak all the same.
    pierced[s] = is_pierced(shapes.exact[s], vertices, pieces[piece], tolerances.weld);
  });
  add_neighbours(room, shapes, tolerances, pierced);
  return pierced;
}

/// Gives the patches of one shape their corners; those at the same place are one vertex.
class CornerTable {
 public:
  CornerTable(const CurvedPatches& patches, BaseMesh& mesh) : patches_(patches), mesh_(mesh) {}

  void fill(BaseTriangle& t) {
    constexpr std::array<Barycentric, 3> kCorners{{{0, 0}, {1, 0}, {0, 1}}};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 point = patches_.point(t.patch, kCorners[k].u, kCorners[k].v);
      t.vertex[k] = find(point);
      t.normal[k] = static_cast<std::uint32_t>(mesh_.normals.size());
      mesh_.normals.push_back(patches_.normal(t.patch, kCorners[k].u, kCorners[k].v));
    }
  }

 private:
  std::uint32_t find(const Vec3& point) {
    const double tolerance = 1e-9 * std::sqrt(patches_.patch_area());
    for (const std::uint32_t known : known_)
      if ((mesh_.vertices[known] - point).squaredNorm() <= tolerance * tolerance) return known;
    known_.push_back(static_cast<std::uint32_t>(mesh_.vertices.size()));
    mesh_.vertices.push_back(point);
    return known_.back();
  }

  const CurvedPatches& patches_;
  BaseMesh& mesh_;
  std::vector<std::uint32_t> known_;  // few: a shape has at most some hundred corners
};

}  // namespace

RoomShapes separate_shapes(const Scene& room, const MeshSettings& settings,
                           const MeshTolerances& tolerances) {
  RoomShapes all;
  for (std::size_t s = 0; s < room.surfaces.size(); ++s)
    for (std::uint32_t i = 0; i < room.surfaces[s].shapes.size(); ++i) {
      all.exact.push_back(room.surfaces[s].shapes[i]);
      all.surface.emplace_back(s);
      all.index.push_back(i);
    }
  if (all.exact.empty()) return all;
  std::vector<bool> faceted(all.exact.size(), true);
  std::vector<int> segments(all.exact.size(), kMostSegments);
  if (settings.exact_shapes) {
    VertexTable vertices(tolerances.weld);
    MeshReport ignored;
    ignored.surfaces.resize(room.surfaces.size());
    const std::vector<FacePiece> pieces = repair_polygons(room, tolerances, vertices, ignored);
    faceted = find_pierced(room, all, vertices, pieces, tolerances);
    const double zone_area = wanted_zone_area(settings, zoned_area(room, pieces, all));
    segments = choose_segments(all, faceted, tolerances, std::sqrt(zone_area));
  }
  RoomShapes result;
  FacetedShapes& facets = result.facets;
  facets.all = !settings.exact_shapes;
  for (std::size_t i = 0; i < all.exact.size(); ++i) {
    if (!faceted[i]) {
      result.exact.push_back(all.exact[i]);
      result.surface.push_back(all.surface[i]);
      result.index.push_back(all.index[i]);
      continue;
    }
    if (!result.faceted) result.faceted = room;
    Surface& surface = result.faceted->surfaces[all.surface[i].index()];
    const std::size_t first = surface.faces.size();
    append_faces(all.exact[i], segments[i], surface);
    facets.fewest_sides = facets.count == 0 ? segments[i] : std::min(facets.fewest_sides, segments[i]);
    facets.most_sides = std::max(facets.most_sides, segments[i]);
    facets.round_area += shape_area(all.exact[i]);
    for (std::size_t f = first; f < surface.faces.size(); ++f)
      facets.flat_area += face_area(surface, surface.faces[f]);
    ++facets.count;
  }
  return result;
}

double zoned_area(const Scene& scene, const std::vector<FacePiece>& pieces, const RoomShapes& shapes) {
  double area = 0;
  for (const FacePiece& p : pieces) area += (p.two_sided ? 2 : 1) * p.area;
  for (std::size_t i = 0; i < shapes.exact.size(); ++i)
    area += (shapes.is_two_sided(scene, i) ? 2 : 1) * shape_area(shapes.exact[i]);
  return area;
}

void append_patches(const Scene& scene, const RoomShapes& shapes, BaseMesh& mesh, MeshReport& report) {
  for (std::size_t i = 0; i < shapes.exact.size(); ++i) {
    const CurvedPatches patches(shapes.exact[i]);
    CornerTable corners(patches, mesh);
    BaseTriangle t;
    t.surface = shapes.surface[i];
    t.face = shapes.index[i];
    t.two_sided = shapes.is_two_sided(scene, i);
    t.shape = static_cast<std::uint32_t>(i);
    for (t.patch = 0; t.patch < patches.count(); ++t.patch) {
      corners.fill(t);
      mesh.triangles.push_back(t);
    }
    SurfaceAreas& areas = report.surfaces[t.surface.index()];
    areas.input += shape_area(shapes.exact[i]);
    areas.meshed += shape_area(shapes.exact[i]);
  }
  mesh.shapes = shapes.exact;
  const FacetedShapes& facets = shapes.facets;
  if (facets.count > 0)
    report.warnings.push_back(fmt::format(
        "{} round shape(s) were replaced by flat faces with {} sides to a circle, {}; together they have "
        "{:.1f} % "
        "less area{}",
        facets.count,
        facets.fewest_sides == facets.most_sides
            ? fmt::format("{}", facets.most_sides)
            : fmt::format("{} to {}", facets.fewest_sides, facets.most_sides),
        facets.all ? "because this method needs flat zones"
                   : "because other faces pass through them or they are cut-outs",
        100 * (1 - facets.flat_area / facets.round_area), facets.all ? " and, as luminaires, power" : ""));
}

}  // namespace reemit

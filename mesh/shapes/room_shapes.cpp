#include "mesh/shapes/room_shapes.h"

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "mesh/geometry/box_pairs.h"
#include "mesh/overlap/coplanar_overlap.h"
#include "mesh/repair/polygon_repair.h"
#include "mesh/shapes/shape_contacts.h"
#include "mesh/shapes/tessellate.h"

namespace reemit {
namespace {

/// Around a full circle of a shape that becomes faces.
constexpr int kFacetSegments = 32;

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

/// Shapes that end in the same circle become faces together: a round cap on a mantle of flat faces would
/// stick out between its corners and show its back.
void add_neighbours(const Scene& room, const RoomShapes& shapes, const MeshTolerances& tolerances,
                    std::vector<bool>& faceted) {
  const std::vector<Rim> rims = rims_of(shapes.exact);
  std::vector<IndexedBox> boxes;
  for (std::uint32_t i = 0; i < rims.size(); ++i) {
    const Vec3 margin = Vec3::Constant(tolerances.weld);
    boxes.push_back({rims[i].centre - margin, rims[i].centre + margin, i});
  }
  std::vector<std::vector<std::size_t>> neighbours(shapes.exact.size());
  for_each_box_pair(boxes, boxes, [&](std::uint32_t i, std::uint32_t j) {
    const Rim& a = rims[i];
    const Rim& b = rims[j];
    if (a.shape != b.shape && std::abs(a.radius - b.radius) <= tolerances.weld &&
        a.radius * a.axis.cross(b.axis).norm() <= tolerances.weld)
      neighbours[a.shape].push_back(b.shape);
  });
  std::vector<std::size_t> spreads;
  for (std::size_t s = 0; s < faceted.size(); ++s)
    if (faceted[s]) spreads.push_back(s);
  while (!spreads.empty()) {
    const std::size_t from = spreads.back();
    spreads.pop_back();
    for (const std::size_t s : neighbours[from]) {
      if (faceted[s] || room.material_of(room.surfaces[shapes.surface[s].index()]).emits()) continue;
      faceted[s] = true;
      spreads.push_back(s);
    }
  }
}

std::vector<bool> find_pierced(const Scene& room, const RoomShapes& shapes,
                               const MeshTolerances& tolerances) {
  std::vector<bool> pierced(shapes.exact.size(), false);
  VertexTable vertices(tolerances.weld);
  MeshReport ignored;
  ignored.surfaces.resize(room.surfaces.size());
  const std::vector<FacePiece> pieces = repair_polygons(room, tolerances, vertices, ignored);
  std::vector<IndexedBox> boxes;
  boxes.reserve(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) boxes.push_back(box_of(vertices, pieces[i], i, 0));
  for_each_box_pair(boxes_of(shapes.exact, 0), boxes, [&](std::uint32_t s, std::uint32_t piece) {
    if (pierced[s] || room.material_of(room.surfaces[shapes.surface[s].index()]).emits()) return;
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

RoomShapes separate_shapes(const Scene& room, bool exact_shapes, const MeshTolerances& tolerances) {
  RoomShapes all;
  for (std::size_t s = 0; s < room.surfaces.size(); ++s)
    for (std::uint32_t i = 0; i < room.surfaces[s].shapes.size(); ++i) {
      all.exact.push_back(room.surfaces[s].shapes[i]);
      all.surface.emplace_back(s);
      all.index.push_back(i);
    }
  if (all.exact.empty()) return all;
  const std::vector<bool> faceted =
      exact_shapes ? find_pierced(room, all, tolerances) : std::vector<bool>(all.exact.size(), true);
  RoomShapes result;
  result.all = !exact_shapes;
  for (std::size_t i = 0; i < all.exact.size(); ++i) {
    if (!faceted[i]) {
      result.exact.push_back(all.exact[i]);
      result.surface.push_back(all.surface[i]);
      result.index.push_back(all.index[i]);
      continue;
    }
    if (!result.faceted) result.faceted = room;
    append_faces(all.exact[i], kFacetSegments, result.faceted->surfaces[all.surface[i].index()]);
    ++result.replaced;
  }
  return result;
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
  if (shapes.replaced > 0)
    report.warnings.push_back(fmt::format(
        "{} round shape(s) were replaced by flat faces with {} sides to a circle, {}; they have up to 1.5 % "
        "less area and, as luminaires, power",
        shapes.replaced, kFacetSegments,
        shapes.all ? "because this method needs flat zones" : "because other faces pass through them"));
}

}  // namespace reemit

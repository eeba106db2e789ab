#include "mesh/build_mesh.h"

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "mesh/contact/contact_split.h"
#include "mesh/model/mesh_tolerances.h"
#include "mesh/overlap/coplanar_overlap.h"
#include "mesh/overlap/near_pieces.h"
#include "mesh/pieces/edge_points.h"
#include "mesh/repair/dropped_luminaires.h"
#include "mesh/repair/duplicate_faces.h"
#include "mesh/repair/face_checks.h"
#include "mesh/repair/orientation.h"
#include "mesh/repair/polygon_repair.h"
#include "mesh/shapes/room_shapes.h"
#include "mesh/triangulate/conform_triangles.h"
#include "mesh/triangulate/triangulate_groups.h"
#include "mesh/zones/zone_sizing.h"
#include "scenes/model/error.h"
#include "scenes/model/measures.h"
#include "scenes/model/memory.h"

namespace reemit {
namespace {

// Only triangles clearly worse than wanted are improved: a rectangle of 1:4 stays two triangles.
constexpr double kToleratedAngle = 0.7;
// Triangles whose sides are below this many zone edges, or whose area is below this part of a zone, may have
// any shape.
constexpr double kFreeLength = 3;
constexpr double kFreeArea = 0.5;

double area_of(const VertexTable& vertices, const RawTriangle& t) {
  return triangle_area(vertices[t.vertex[0]], vertices[t.vertex[1]], vertices[t.vertex[2]]);
}

void book_areas(const VertexTable& vertices, const std::vector<FacePiece>& pieces, const GroupTriangles& cut,
                MeshReport& report) {
  std::vector<double> meshed(pieces.size(), 0.0);
  for (const RawTriangle& t : cut.triangles)
    for (const std::size_t piece : {t.piece, t.back})
      if (piece != Keepers::kNobody) meshed[piece] += area_of(vertices, t);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    SurfaceAreas& areas = report.surfaces[pieces[p].surface.index()];
    areas.meshed += meshed[p];
    areas.removed += cut.covered[p];
    if (meshed[p] + cut.covered[p] <= 0) {
      areas.removed += pieces[p].area;
      areas.collapsed += pieces[p].area;
      report.changes.push_back({pieces[p].surface, pieces[p].face, FaceChange::kDegenerate});
    } else {
      areas.welded += pieces[p].area - meshed[p] - cut.covered[p];
    }
  }
}

// The faces that round shapes became come after those as read.
void note_faceted(const Scene& room, const Scene& faceted, MeshReport& report) {
  for (std::size_t s = 0; s < room.surfaces.size(); ++s)
    for (std::size_t f = room.surfaces[s].faces.size(); f < faceted.surfaces[s].faces.size(); ++f)
      report.changes.push_back({SurfaceId(s), static_cast<std::uint32_t>(f), FaceChange::kFaceted});
}

// Numbers the vertices and normals that triangles use, in the order of their use.
class BaseMeshBuilder {
 public:
  BaseMeshBuilder(const VertexTable& vertices, const std::vector<FacePiece>& pieces)
      : vertices_(vertices), pieces_(pieces), index_(vertices.size(), BaseTriangle::kFlat) {}

  BaseMesh build(const std::vector<RawTriangle>& triangles) {
    mesh_.triangles.reserve(triangles.size());
    for (const RawTriangle& raw : triangles) {
      const FacePiece& piece = pieces_[raw.piece];
      BaseTriangle t;
      for (std::size_t k = 0; k < 3; ++k) {
        t.vertex[k] = vertex(raw.vertex[k]);
        if (piece.smooth) t.normal[k] = normal(piece.shading_normal(vertices_, vertices_[raw.vertex[k]]));
      }
      t.surface = piece.surface;
      t.face = piece.face;
      t.two_sided = piece.two_sided || raw.back != Keepers::kNobody;
      mesh_.triangles.push_back(t);
      if (raw.back == Keepers::kNobody) continue;
      mesh_.backs.resize(mesh_.triangles.size());
      mesh_.backs.back() = {pieces_[raw.back].surface, pieces_[raw.back].face};
    }
    return std::move(mesh_);
  }

 private:
  std::uint32_t vertex(std::uint32_t v) {
    if (index_[v] == BaseTriangle::kFlat) {
      index_[v] = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(vertices_[v]);
    }
    return index_[v];
  }
  std::uint32_t normal(const Vec3& n) {
    const auto [it, is_new] =
        normals_.try_emplace({n.x(), n.y(), n.z()}, static_cast<std::uint32_t>(mesh_.normals.size()));
    if (is_new) mesh_.normals.push_back(n);
    return it->second;
  }

  const VertexTable& vertices_;
  const std::vector<FacePiece>& pieces_;
  std::vector<std::uint32_t> index_;
  std::map<std::array<double, 3>, std::uint32_t> normals_;
  BaseMesh mesh_;
};

// Before minutes are spent on a room that ends without memory.
void check_memory_for(const Scene& room) {
  // Triangles that touch nothing take this much until they are base triangles, others more.
  constexpr double kLeastBytesPerFace = 500;
  std::size_t faces = 0;
  for (const Surface& surface : room.surfaces) faces += surface.faces.size();
  check_memory(fmt::format("{}: meshing {} faces", room.source.empty() ? "room" : room.source, faces),
               kLeastBytesPerFace * static_cast<double>(faces), available_memory());
}

/// The same for what was asked of the number of zones; what cannot even be counted is refused elsewhere.
void check_memory_for_zones(const Scene& room, double zones) {
  if (zones > 1e9) return;
  // Of the mesh, and of what a solve adds up in each band; measured in large rooms it is a tenth more.
  const double least_bytes_per_zone = 250 + 130 * static_cast<double>(room.bands.count());
  check_memory(fmt::format("{}: {:.3g} zones (--zones, --zone-area)",
                           room.source.empty() ? "room" : room.source, zones),
               least_bytes_per_zone * zones, available_memory());
}

}  // namespace

MeshResult build_mesh(const Scene& room, const MeshSettings& settings, const WorkWatch& watch) {
  watch.at(0);
  check_faces(room);
  check_memory_for(room);
  if (!(settings.smallest_angle_deg >= 0 && settings.smallest_angle_deg <= 30))
    throw InputError("smallest angle", fmt::format("{} degrees is out of range", settings.smallest_angle_deg),
                     "use a value from 0 to 30");
  const MeshTolerances tolerances = MeshTolerances::of(bounds(room));
  const RoomShapes shapes = separate_shapes(room, settings, tolerances);
  const Scene& scene = shapes.faceted ? *shapes.faceted : room;
  MeshReport report;
  report.surfaces.resize(scene.surfaces.size());
  VertexTable vertices(tolerances.weld);

  std::vector<FacePiece> pieces = repair_polygons(scene, tolerances, vertices, report);
  watch.at(0.1);
  drop_duplicate_faces(scene, pieces, report);
  orient_faces(scene, vertices, pieces, report);
  double total_area = 0;
  for (const FacePiece& p : pieces) total_area += p.area;
  for (const CurvedShape& shape : shapes.exact) total_area += shape_area(shape);
  if (!(total_area > 0))
    throw InputError(scene.source.empty() ? "room" : scene.source, "there is no face with an area",
                     "check that the file holds polygons, and its unit of length");
  const double area_of_zones = zoned_area(scene, pieces, shapes);
  const double zone_area = wanted_zone_area(settings, area_of_zones);
  check_memory_for_zones(scene, area_of_zones / zone_area);
  const double zone_edge = std::sqrt(zone_area);

  std::optional<NearPieces> near(std::in_place, vertices, pieces);
  PieceGroups groups =
      group_overlapping_pieces(scene, pieces, *near, tolerances, WorkStep(watch, 0.2, 0.4), vertices);
  const ContactCuts cuts = find_contact_cuts(scene, pieces, groups, *near, tolerances,
                                             WorkStep(watch, 0.4, 0.6), vertices, shapes.exact);
  near.reset();
  if (cuts.ignored > 0)
    report.warnings.push_back(fmt::format(
        "{} faces touch so many others that they were cut along the longest contacts only", cuts.ignored));
  std::vector<std::uint32_t> on_edges = std::move(groups.crossings);
  on_edges.insert(on_edges.end(), cuts.on_boundary.begin(), cuts.on_boundary.end());
  watch.at(0.6);
  insert_vertices_on_edges(vertices, on_edges, tolerances.weld, pieces);

  const TriangleQuality quality{.smallest_angle_deg = kToleratedAngle * settings.smallest_angle_deg,
                                .free_length = kFreeLength * zone_edge,
                                .free_area = kFreeArea * zone_area,
                                .most_new_points = 1'000'000};
  GroupTriangles cut = triangulate_groups(scene, pieces, groups, cuts, tolerances, quality,
                                          WorkStep(watch, 0.7, 0.85), vertices, report);
  watch.at(0.85);
  conform_triangles(vertices, tolerances.weld, cut.triangles);
  const double smallest_area = kSmallestArea * tolerances.diagonal * tolerances.diagonal;
  std::erase_if(cut.triangles, [&](const RawTriangle& t) { return area_of(vertices, t) <= smallest_area; });
  book_areas(vertices, pieces, cut, report);

  BaseMesh base = BaseMeshBuilder(vertices, pieces).build(cut.triangles);
  append_patches(scene, shapes, base, report);
  if (!base.backs.empty()) base.backs.resize(base.triangles.size());
  check_dropped_luminaires(scene, tolerances.weld, report);
  note_faceted(room, scene, report);
  tidy(report.changes);
  size_zones(base, zone_area);
  return {ZoneMesh(std::move(base)), std::move(report)};
}

}  // namespace reemit

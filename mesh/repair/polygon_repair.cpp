#include "mesh/repair/polygon_repair.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "mesh/pieces/face_notes.h"
#include "mesh/pieces/planar_triangulation.h"
#include "mesh/pieces/segment_crossings.h"
#include "mesh/pieces/texture_split.h"
#include "scenes/io/common/polygon_loops.h"
#include "scenes/model/error.h"
#include "scenes/model/measures.h"

namespace reemit {
namespace {

/// A shading normal whose cosine to the normal of its plane is less than 1 by no more, 0.03 degrees, bends
/// nothing.
constexpr double kUnbent = 1e-7;

// A corner of a polygon: where it was read and which vertex it became.
struct Corner {
  Vec3 read;
  std::uint32_t vertex;
  Vec3 normal;  // zero = none
};

// Outline and holes of one face.
struct FaceLoops {
  std::vector<std::vector<Corner>> loops;
};

Vec3 vector_area_as_read(const std::vector<Corner>& loop) {
  return loop_area(loop, [](const Corner& corner) -> const Vec3& { return corner.read; });
}

double filled_area(const PlanarTriangulation& cut) {
  double filled = 0;
  for (const auto& [a, b, c] : cut.triangles) {
    const Vec2 ab = cut.points[b] - cut.points[a];
    const Vec2 ac = cut.points[c] - cut.points[a];
    filled += 0.5 * (ab.x() * ac.y() - ab.y() * ac.x());
  }
  return filled;
}

class PolygonRepair {
 public:
  PolygonRepair(const Scene& scene, const MeshTolerances& tolerances, VertexTable& vertices,
                MeshReport& report)
      : scene_(scene), tolerances_(tolerances), vertices_(vertices), report_(report) {}

  std::vector<FacePiece> run();

 private:
  void reserve();
  void repair(SurfaceId surface, std::uint32_t face);
  FaceLoops read(SurfaceId surface, std::uint32_t face);
  std::vector<Corner> read_loop(SurfaceId surface, const std::vector<std::uint32_t>& loop,
                                const std::vector<std::uint32_t>& normals);
  bool weld(FaceLoops& polygon);
  std::vector<FaceLoops> split_welded_seams(FaceLoops face);
  double repair_part(SurfaceId surface, std::uint32_t face, const FaceLoops& part, double area_as_read);
  void drop(const FacePiece& piece, double area);
  void note(FaceChange change, SurfaceId surface, std::uint32_t face) {
    report_.changes.push_back({surface, face, change});
  }
  bool finish_plane(FacePiece& piece, const FaceLoops& polygon, double& deviation) const;
  bool add_crossed_halves(const FacePiece& piece, const FaceLoops& polygon);
  void add_new_corners(const FacePiece& piece, const PlanarTriangulation& cut, std::vector<Corner>& corners);
  void add_triangle(const FacePiece& like, const std::array<Corner, 3>& corners);
  void add_polygon(FacePiece piece, const FaceLoops& polygon);
  void add_split(const FacePiece& piece, const FaceLoops& polygon);
  bool add_texture_split(const FacePiece& piece, const FaceLoops& polygon);
  PlanarTriangulation triangulate(const FacePiece& piece, const FaceLoops& polygon,
                                  std::vector<Corner>& corners) const;
  InputError bad_face(const FacePiece& piece, const std::string& problem, const std::string& advice) const {
    return {"face " + face_name(scene_, piece.surface, piece.face), problem, advice};
  }

  const Scene& scene_;
  const MeshTolerances& tolerances_;
  VertexTable& vertices_;
  MeshReport& report_;
  std::vector<FacePiece> pieces_;
  FaceNotes bent_;
  FaceNotes crossed_;
  FaceNotes degenerate_;
  double largest_bend_ = 0;
};

std::vector<Corner> PolygonRepair::read_loop(SurfaceId surface, const std::vector<std::uint32_t>& loop,
                                             const std::vector<std::uint32_t>& normals) {
  const Surface& s = scene_.surfaces[surface.index()];
  std::vector<Corner> out;
  out.reserve(loop.size());
  for (std::size_t i = 0; i < loop.size(); ++i) {
    Vec3 normal = Vec3::Zero();
    if (i < normals.size() && normals[i] < s.normals.size()) normal = s.normals[normals[i]];
    if (!normal.allFinite()) normal.setZero();
    out.push_back({s.positions[loop[i]], 0, normal});
  }
  return out;
}

FaceLoops PolygonRepair::read(SurfaceId surface, std::uint32_t face) {
  const Face& f = scene_.surfaces[surface.index()].faces[face];
  FaceLoops polygon;
  polygon.loops.push_back(read_loop(surface, f.outer, f.normals));
  for (const auto& hole : f.holes) polygon.loops.push_back(read_loop(surface, hole, {}));
  return polygon;
}

// Returns whether that moved a corner, by more than what rounding does to coordinates of transformed objects,
// or merged some.
bool PolygonRepair::weld(FaceLoops& polygon) {
  const double still = 0.01 * tolerances_.weld;
  bool changed = false;
  for (std::vector<Corner>& loop : polygon.loops) {
    for (Corner& c : loop) {
      c.vertex = vertices_.weld(c.read);
      changed |= (vertices_[c.vertex] - c.read).squaredNorm() > still * still;
    }
    const std::size_t corners = loop.size();
    const auto same = [](const Corner& a, const Corner& b) { return a.vertex == b.vertex; };
    loop.erase(std::unique(loop.begin(), loop.end(), same), loop.end());
    while (loop.size() > 1 && same(loop.front(), loop.back())) loop.pop_back();
    changed |= loop.size() != corners;
  }
  const auto collapsed = [](const std::vector<Corner>& loop) { return loop.size() < 3; };
  polygon.loops.erase(std::remove_if(polygon.loops.begin() + 1, polygon.loops.end(), collapsed),
                      polygon.loops.end());
  return changed;
}

// The parts of a face whose outline draws holes or islands by seams whose ends only welding made equal
// (readers have split the others); the face itself if it does not.
std::vector<FaceLoops> PolygonRepair::split_welded_seams(FaceLoops face) {
  std::vector<std::uint32_t> outline;
  for (const Corner& c : face.loops[0]) outline.push_back(c.vertex);
  std::sort(outline.begin(), outline.end());
  if (std::adjacent_find(outline.begin(), outline.end()) == outline.end()) return {std::move(face)};
  const auto positions = [&](const std::vector<Corner>& loop) {
    std::vector<Vec3> out;
    for (const Corner& c : loop) out.push_back(vertices_[c.vertex]);
    return out;
  };
  Polygon welded{.outer = positions(face.loops[0]), .normals = {}, .holes = {}};
  for (const Corner& c : face.loops[0]) welded.normals.push_back(c.normal);
  for (std::size_t i = 1; i < face.loops.size(); ++i) welded.holes.push_back(positions(face.loops[i]));
  std::vector<FaceLoops> parts;
  const auto corner = [&](const Vec3& p, const Vec3& normal) { return Corner{p, vertices_.weld(p), normal}; };
  for (const Polygon& island : split_at_seams(std::move(welded))) {
    FaceLoops& part = parts.emplace_back();
    std::vector<Corner>& loop = part.loops.emplace_back();
    for (std::size_t i = 0; i < island.outer.size(); ++i)
      loop.push_back(corner(island.outer[i], island.normals[i]));
    for (const auto& hole : island.holes) {
      std::vector<Corner>& corners = part.loops.emplace_back();
      for (const Vec3& p : hole) corners.push_back(corner(p, Vec3::Zero()));
    }
  }
  if (parts.empty()) parts.push_back(std::move(face));
  return parts;
}

void PolygonRepair::drop(const FacePiece& piece, double area) {
  ++report_.degenerate_faces;
  SurfaceAreas& areas = report_.surfaces[piece.surface.index()];
  areas.input += area;
  areas.removed += area;
  areas.collapsed += area;
  degenerate_.add(scene_, piece.surface, piece.face);
  note(FaceChange::kDegenerate, piece.surface, piece.face);
}

// Fits the plane; false if the polygon encloses no area. `deviation`: largest distance of a corner from the
// plane.
bool PolygonRepair::finish_plane(FacePiece& piece, const FaceLoops& polygon, double& deviation) const {
  if (polygon.loops[0].size() < 3) return false;
  piece.loops.clear();
  for (const std::vector<Corner>& loop : polygon.loops) {
    Loop& out = piece.loops.emplace_back();
    for (const Corner& c : loop) out.push_back(c.vertex);
  }
  const Loop& outline = piece.loops[0];
  Vec3 low = vertices_[outline[0]];
  Vec3 high = low;
  Vec3 sum = Vec3::Zero();
  for (const std::uint32_t v : outline) {
    low = low.cwiseMin(vertices_[v]);
    high = high.cwiseMax(vertices_[v]);
    sum += vertices_[v] - vertices_[outline[0]];
  }
  piece.diameter = (high - low).norm();
  const Vec3 area = outline_area(vertices_, outline);
  const double smallest = std::max(kSmallestArea * tolerances_.diagonal * tolerances_.diagonal,
                                   0.5 * tolerances_.weld * piece.diameter);
  if (area.norm() <= smallest) return false;
  const Vec3 centre = vertices_[outline[0]] + sum / static_cast<double>(outline.size());
  piece.plane = PlaneFrame::make(centre, area.normalized());
  deviation = 0;
  for (const Loop& loop : piece.loops)
    for (const std::uint32_t v : loop)
      deviation = std::max(deviation, std::abs(piece.plane.height(vertices_[v])));
  return true;
}

PlanarTriangulation PolygonRepair::triangulate(const FacePiece& piece, const FaceLoops& polygon,
                                               std::vector<Corner>& corners) const {
  std::vector<Vec2> points;
  std::vector<std::array<std::uint32_t, 2>> segments;
  for (const std::vector<Corner>& loop : polygon.loops) {
    const auto first = static_cast<std::uint32_t>(points.size());
    const auto count = static_cast<std::uint32_t>(loop.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      corners.push_back(loop[i]);
      points.push_back(piece.plane.project(vertices_[loop[i].vertex]));
      segments.push_back({first + i, first + (i + 1) % count});
    }
  }
  std::vector<PlanarSegment> lines;
  lines.reserve(segments.size());
  for (const auto& [a, b] : segments) lines.push_back({points[a], points[b]});
  if (count_crossings(lines, kMostOutlineCrossings) > kMostOutlineCrossings)
    throw bad_face(piece,
                   fmt::format("its outline of {} corners crosses itself or its holes more than {} times",
                               points.size(), kMostOutlineCrossings),
                   "check the order of its corners, or split it into simple polygons");
  const PlanarLoops loops(vertices_, piece, piece.plane);
  return triangulate_planar(points, segments, [&](const Vec2& p) { return loops.contains(p); }, {});
}

// Takes the points that a triangulation added into the corners of its face.
void PolygonRepair::add_new_corners(const FacePiece& piece, const PlanarTriangulation& cut,
                                    std::vector<Corner>& corners) {
  for (std::size_t i = corners.size(); i < cut.points.size(); ++i) {
    const Vec3 p = piece.plane.lift(cut.points[i]);
    corners.push_back({p, vertices_.weld(p), Vec3::Zero()});
  }
}

// An outline like a figure 8 may enclose as much area backwards as forwards, which leaves the whole no front:
// each half has that of its own winding. False if there are no halves.
bool PolygonRepair::add_crossed_halves(const FacePiece& piece, const FaceLoops& polygon) {
  const std::vector<Corner>& loop = polygon.loops[0];
  Vec3 widest = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Vec3 n = (loop[i].read - loop[0].read).cross(loop[i + 1].read - loop[0].read);
    if (n.squaredNorm() > widest.squaredNorm()) widest = n;
  }
  const double size = tolerances_.weld * piece.diameter;
  if (widest.norm() <= size) return false;
  FacePiece flat = piece;
  flat.plane = PlaneFrame::make(vertices_[loop[0].vertex], widest.normalized());
  std::vector<Corner> corners;
  const PlanarTriangulation cut = triangulate(flat, polygon, corners);
  if (filled_area(cut) <= 2 * size) return false;
  add_new_corners(flat, cut, corners);
  const PlanarLoops loops(vertices_, flat, flat.plane);
  for (auto [a, b, c] : cut.triangles) {
    const Vec2 middle = (cut.points[a] + cut.points[b] + cut.points[c]) / 3;
    if (winding_number(loops.loops[0], middle) < 0) std::swap(b, c);
    add_triangle(flat, {corners[a], corners[b], corners[c]});
  }
  crossed_.add(scene_, piece.surface, piece.face);
  note(FaceChange::kCrossed, piece.surface, piece.face);
  return true;
}

void PolygonRepair::add_triangle(const FacePiece& like, const std::array<Corner, 3>& corners) {
  FacePiece piece = like;
  FaceLoops polygon;
  polygon.loops.emplace_back(corners.begin(), corners.end());
  piece.area = triangle_area(corners[0].read, corners[1].read, corners[2].read);
  double deviation = 0;
  if (!finish_plane(piece, polygon, deviation)) {
    SurfaceAreas& areas = report_.surfaces[piece.surface.index()];
    areas.input += piece.area;
    areas.removed += piece.area;
    areas.collapsed += piece.area;
    return;
  }
  piece.smooth = false;
  for (std::size_t k = 0; k < 3; ++k) {
    piece.corner[k] = corners[k].vertex;
    Vec3 n = corners[k].normal;
    const double length = n.norm();
    n = length > 0 ? Vec3(n / length) : piece.plane.normal;
    if (n.dot(piece.plane.normal) < 0) n = -n;  // the front is where the corners run counter-clockwise
    piece.smooth |= n.dot(piece.plane.normal) < 1 - kUnbent;
    piece.corner_normal[k] = n;
  }
  report_.surfaces[piece.surface.index()].input += piece.area;
  pieces_.push_back(std::move(piece));
}

void PolygonRepair::add_polygon(FacePiece piece, const FaceLoops& polygon) {
  double area = vector_area_as_read(polygon.loops[0]).norm();
  for (std::size_t i = 1; i < polygon.loops.size(); ++i) area -= vector_area_as_read(polygon.loops[i]).norm();
  std::vector<Corner> corners;
  const PlanarTriangulation cut = triangulate(piece, polygon, corners);
  const double filled = filled_area(cut);
  // Welding moves corners by less than the weld distance; a larger gap means crossing loops, whose area is
  // what they fill.
  const double slack = 8 * tolerances_.weld * piece.diameter * static_cast<double>(corners.size());
  if (std::abs(filled - area) > slack + 1e-9 * area) {
    crossed_.add(scene_, piece.surface, piece.face);
    note(FaceChange::kCrossed, piece.surface, piece.face);
    area = filled;
  }
  piece.area = area;
  if (filled <= tolerances_.weld * piece.diameter) {
    drop(piece, area);
    return;
  }
  report_.surfaces[piece.surface.index()].input += area;
  pieces_.push_back(std::move(piece));
}

void PolygonRepair::add_split(const FacePiece& piece, const FaceLoops& polygon) {
  std::vector<Corner> corners;
  const PlanarTriangulation cut = triangulate(piece, polygon, corners);
  add_new_corners(piece, cut, corners);
  for (const auto& t : cut.triangles) add_triangle(piece, {corners[t[0]], corners[t[1]], corners[t[2]]});
}

// Where texture coordinates bend within a face, its triangles are those over which they are interpolated.
bool PolygonRepair::add_texture_split(const FacePiece& piece, const FaceLoops& polygon) {
  const Surface& surface = scene_.surfaces[piece.surface.index()];
  const Face& face = surface.faces[piece.face];
  if (!scene_.is_textured(surface) || polygon.loops.size() > 1 ||
      polygon.loops[0].size() != face.outer.size() || has_affine_texture(surface, face))
    return false;
  const std::vector<Corner>& corners = polygon.loops[0];
  for (const auto& t : texture_triangles(surface, face))
    add_triangle(piece, {corners[t[0]], corners[t[1]], corners[t[2]]});
  return true;
}

// Returns the largest distance of a corner from the plane of the part [m] if the eye can see it, else 0.
double PolygonRepair::repair_part(SurfaceId surface, std::uint32_t face, const FaceLoops& part,
                                  double area_as_read) {
  const Material& material = scene_.material_of(scene_.surfaces[surface.index()]);
  FacePiece piece;
  piece.surface = surface;
  piece.face = face;
  piece.two_sided = material.two_sided;
  piece.emits = material.emits();
  piece.emits_both_sides = material.emits_both_sides;
  piece.is_matt = !piece.emits && !scene_.is_textured(scene_.surfaces[surface.index()]) &&
                  !material.non_diffuse.reflects_specularly() &&
                  !material.non_diffuse.transmits_specularly() && !material.non_diffuse.transmits_diffusely();
  double deviation = 0;
  if (!finish_plane(piece, part, deviation)) {
    if (part.loops[0].size() > 3 && add_crossed_halves(piece, part)) return 0;
    drop(piece, area_as_read);
    return 0;
  }
  const std::vector<Corner>& outline = part.loops[0];
  if (outline.size() == 3 && part.loops.size() == 1) {
    add_triangle(piece, {outline[0], outline[1], outline[2]});
    return 0;
  }
  // Which side a normal points to does not matter: add_triangle turns it to the front.
  const bool shaded = std::any_of(outline.begin(), outline.end(), [&](const Corner& c) {
    return c.normal.squaredNorm() > 0 &&
           std::abs(c.normal.normalized().dot(piece.plane.normal)) < 1 - kUnbent;
  });
  const double bend = deviation > kVisiblyBent * piece.diameter ? deviation : 0;
  if (add_texture_split(piece, part)) return bend;
  if (shaded || deviation > kPlanar * piece.diameter)
    add_split(piece, part);
  else
    add_polygon(std::move(piece), part);
  return bend;
}

void PolygonRepair::repair(SurfaceId surface, std::uint32_t face) {
  FaceLoops polygon = read(surface, face);
  const double area_as_read = vector_area_as_read(polygon.loops[0]).norm();
  if (weld(polygon)) note(FaceChange::kWelded, surface, face);
  const std::vector<FaceLoops> parts = split_welded_seams(std::move(polygon));
  double bend = 0;
  for (const FaceLoops& part : parts)
    bend = std::max(
        bend, repair_part(surface, face, part,
                          parts.size() == 1 ? area_as_read : vector_area_as_read(part.loops[0]).norm()));
  if (bend == 0) return;
  ++report_.nonplanar_faces;
  bent_.add(scene_, surface, face);
  note(FaceChange::kNonPlanar, surface, face);
  largest_bend_ = std::max(largest_bend_, bend);
}

// Most rooms have about as many pieces as faces, and far fewer vertices than corners.
void PolygonRepair::reserve() {
  std::size_t faces = 0;
  std::size_t positions = 0;
  for (const Surface& surface : scene_.surfaces) {
    faces += surface.faces.size();
    positions += surface.positions.size();
  }
  pieces_.reserve(faces);
  vertices_.reserve(positions);
}

std::vector<FacePiece> PolygonRepair::run() {
  reserve();
  for (std::size_t s = 0; s < scene_.surfaces.size(); ++s)
    for (std::size_t f = 0; f < scene_.surfaces[s].faces.size(); ++f)
      repair(SurfaceId(s), static_cast<std::uint32_t>(f));
  if (degenerate_.count() > 0)
    report_.warnings.push_back(
        fmt::format("{} faces without area were left out: {}", degenerate_.count(), degenerate_.names()));
  if (bent_.count() > 0)
    report_.warnings.push_back(
        fmt::format("{} polygons are not planar (by up to {:.3g} m) and were split into "
                    "triangles: {}",
                    bent_.count(), largest_bend_, bent_.names()));
  if (crossed_.count() > 0)
    report_.warnings.push_back(
        fmt::format("{} polygons have an outline or holes that cross; the area they enclose was "
                    "filled: {}",
                    crossed_.count(), crossed_.names()));
  return std::move(pieces_);
}

}  // namespace

std::vector<FacePiece> repair_polygons(const Scene& scene, const MeshTolerances& tolerances,
                                       VertexTable& vertices, MeshReport& report) {
  return PolygonRepair(scene, tolerances, vertices, report).run();
}

}  // namespace reemit

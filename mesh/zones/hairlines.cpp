#include "mesh/zones/hairlines.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/squared_distance_3.h>
#include <Eigen/Geometry>

#include "mesh/geometry/vertex_table.h"

namespace reemit {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// An edge that is so near another triangle may lie against it [of the longest side of the mesh].
constexpr double kNear = 1e-5;
/// What is left out at the ends of an edge, where its neighbours begin. A hairline shorter than that loses
/// less than one ray of 1e11.
constexpr double kEnds = 10 * kNear;
/// Pairs of an open edge and a triangle that are looked at, and triangles whose edges are counted: some 0.1 s
/// for each.
constexpr std::size_t kMostPairs = 1'000'000;
constexpr std::size_t kMostTriangles = 100'000;

Kernel::Point_3 to_cgal(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

using Corners = std::array<std::uint32_t, 3>;

/// By triangle, the places of its corners: surfaces have vertices of their own.
std::vector<Corners> places_of_corners(const BaseMesh& mesh, VertexTable& places) {
  std::vector<Corners> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const BaseTriangle& t : mesh.triangles) {
    Corners& corners = triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) corners[k] = places.weld(mesh.vertices[t.vertex[k]]);
  }
  return triangles;
}

/// Edges of one triangle only.
std::vector<Edge> open_edges(const std::vector<Corners>& triangles) {
  std::map<Edge, int> uses;
  for (const Corners& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
  std::vector<Edge> open;
  for (const auto& [edge, count] : uses)
    if (count == 1) open.push_back(edge);
  return open;
}

bool is_near(const Kernel::Segment_3& segment, const std::array<Kernel::Point_3, 3>& corner,
             double distance) {
  const double square = distance * distance;
  for (std::size_t k = 0; k < 3; ++k)
    if (CGAL::squared_distance(segment, Kernel::Segment_3(corner[k], corner[(k + 1) % 3])) < square)
      return true;
  const Kernel::Triangle_3 triangle(corner[0], corner[1], corner[2]);
  return CGAL::squared_distance(segment.source(), triangle) < square || CGAL::do_intersect(segment, triangle);
}

}  // namespace

bool may_have_hairlines(const BaseMesh& mesh) {
  if (!mesh.shapes.empty()) return true;
  if (mesh.triangles.empty()) return false;
  if (mesh.triangles.size() > kMostTriangles) return true;
  VertexTable places(0);
  const std::vector<Corners> triangles = places_of_corners(mesh, places);
  const std::vector<Edge> open = open_edges(triangles);
  if (open.size() * triangles.size() > kMostPairs) return true;

  Eigen::AlignedBox3d box;
  for (const Vec3& p : places.points()) box.extend(p);
  const double size = box.sizes().maxCoeff();
  return std::any_of(open.begin(), open.end(), [&](const Edge& edge) {
    const Vec3& from = places[edge.first];
    const Vec3& to = places[edge.second];
    const double length = (to - from).norm();
    if (length < 4 * kEnds * size) return true;
    const Vec3 end = kEnds * size / length * (to - from);
    const Kernel::Segment_3 segment(to_cgal(from + end), to_cgal(to - end));
    return std::any_of(triangles.begin(), triangles.end(), [&](const Corners& t) {
      if (std::count(t.begin(), t.end(), edge.first) > 0 && std::count(t.begin(), t.end(), edge.second) > 0)
        return false;  // its own
      return is_near(segment, {to_cgal(places[t[0]]), to_cgal(places[t[1]]), to_cgal(places[t[2]])},
                     kNear * size);
    });
  });
}

}  // namespace reemit

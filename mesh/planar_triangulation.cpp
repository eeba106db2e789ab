// Points lie on edges only up to rounding, and CGAL's refinement may find itself in a face where it should
// not be. Its checks must then stop it in every build, not only in debug builds.
#define CGAL_DEBUG

#include "mesh/planar_triangulation.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace reemit {
namespace {

constexpr std::uint32_t kNone = PlanarTriangulation::kNone;

struct VertexInfo {
  std::uint32_t index = kNone;
  bool before_refinement = false;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<VertexInfo, Kernel>;
using FaceBase = CGAL::Delaunay_mesh_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_predicates_tag>;
using FaceHandle = Cdt::Face_handle;
using VertexHandle = Cdt::Vertex_handle;

Vec2 to_vec(const Cdt::Point& p) {
  return {p.x(), p.y()};
}

std::array<Vec2, 3> corners(const FaceHandle& f) {
  return {to_vec(f->vertex(0)->point()), to_vec(f->vertex(1)->point()), to_vec(f->vertex(2)->point())};
}

struct Shape {
  double squared_sine;    // of the smallest angle
  double squared_length;  // of the longest side
  double area;

  bool matters(const TriangleQuality& quality) const {
    return squared_length > quality.free_length * quality.free_length && area > quality.free_area;
  }
};

Shape shape_of(const FaceHandle& f) {
  const auto [a, b, c] = corners(f);
  const Vec2 ab = b - a;
  const Vec2 ac = c - a;
  const double cross = ab.x() * ac.y() - ab.y() * ac.x();
  std::array<double, 3> side2{ab.squaredNorm(), ac.squaredNorm(), (c - b).squaredNorm()};
  std::sort(side2.begin(), side2.end());
  const double product = side2[1] * side2[2];  // the smallest angle lies between the two longer sides
  return {product > 0 ? cross * cross / product : 0.0, side2[2], 0.5 * std::abs(cross)};
}

double squared_sine_of(double degrees) {
  const double s = std::sin(degrees * std::numbers::pi / 180);
  return s * s;
}

// The criterion that CGAL's mesher asks: small angles count only in triangles that are not small themselves.
class AngleCriteria {
 public:
  using Face_handle = FaceHandle;
  using Quality = double;

  explicit AngleCriteria(const TriangleQuality& quality) : is_bad_(quality) {}

  class Is_bad {
   public:
    explicit Is_bad(const TriangleQuality& quality)
        : quality_(quality), squared_sine_(squared_sine_of(quality.smallest_angle_deg)) {}
    CGAL::Mesh_2::Face_badness operator()(Quality q) const {
      return q < squared_sine_ ? CGAL::Mesh_2::BAD : CGAL::Mesh_2::NOT_BAD;
    }
    CGAL::Mesh_2::Face_badness operator()(const Face_handle& f, Quality& q) const {
      const Shape shape = shape_of(f);
      // A triangle as thin as rounding has no usable circumcentre; its neighbours are refined instead.
      constexpr double kFlat = 1e-20;
      q = shape.matters(quality_) && shape.squared_sine > kFlat ? shape.squared_sine : 1.0;
      return operator()(q);
    }

   private:
    TriangleQuality quality_;
    double squared_sine_;
  };
  Is_bad is_bad_object() const { return is_bad_; }

 private:
  Is_bad is_bad_;
};

// Connected parts of the triangulation between constrained edges.
struct Regions {
  std::vector<std::vector<FaceHandle>> faces;
  std::vector<Vec2> point;
};

template <class Admit>
Regions find_regions(const Cdt& cdt, Admit admit) {
  Regions regions;
  CGAL::Unique_hash_map<FaceHandle, bool> seen(false);
  std::vector<FaceHandle> stack;
  for (auto it = cdt.finite_faces_begin(); it != cdt.finite_faces_end(); ++it) {
    const FaceHandle start = it;
    if (seen[start] || !admit(start)) continue;
    auto& faces = regions.faces.emplace_back();
    Vec2 best_point = Vec2::Zero();
    double best_roundness = -1;
    seen[start] = true;
    stack.push_back(start);
    while (!stack.empty()) {
      const FaceHandle f = stack.back();
      stack.pop_back();
      faces.push_back(f);
      const auto [a, b, c] = corners(f);
      const Shape shape = shape_of(f);
      // Proportional to the squared height over the longest side: the roomiest triangle is asked for the
      // region.
      const double roundness = shape.squared_sine * shape.squared_length;
      if (roundness > best_roundness) {
        best_roundness = roundness;
        best_point = (a + b + c) / 3;
      }
      for (int i = 0; i < 3; ++i) {
        const FaceHandle g = f->neighbor(i);
        if (f->is_constrained(i) || cdt.is_infinite(g) || seen[g] || !admit(g)) continue;
        seen[g] = true;
        stack.push_back(g);
      }
    }
    regions.point.push_back(best_point);
  }
  return regions;
}

// Meshes are worth refining only when a triangle is clearly worse than wanted: a 1:4 rectangle is left alone.
constexpr double kTolerated = 0.7;

bool wants_refinement(const Cdt& cdt, const TriangleQuality& quality) {
  if (quality.smallest_angle_deg <= 0 || quality.most_new_points == 0) return false;
  const double limit = squared_sine_of(kTolerated * quality.smallest_angle_deg);
  for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f) {
    if (!f->is_in_domain()) continue;
    const Shape shape = shape_of(f);
    if (shape.matters(quality) && shape.squared_sine < limit) return true;
  }
  return false;
}

// CGAL prints before it throws; we fall back instead, which is nothing to tell the user.
void silence_cgal() {
  static std::once_flag once;
  std::call_once(
      once, [] { CGAL::set_error_handler([](const char*, const char*, const char*, int, const char*) {}); });
}

// Returns false if the limit on new points was met.
bool refine(Cdt& cdt, const TriangleQuality& quality) {
  using Mesher = CGAL::Delaunay_mesher_2<Cdt, AngleCriteria>;
  Mesher mesher(cdt, AngleCriteria(quality));
  mesher.init(true);
  const std::size_t limit = cdt.number_of_vertices() + quality.most_new_points;
  // A step may refuse its point and mark another for later, so steps are bounded as well as points.
  std::size_t steps = 20 * quality.most_new_points;
  while (!mesher.is_edges_refinement_done() || !mesher.is_refinement_done()) {
    if (cdt.number_of_vertices() >= limit || steps == 0) return false;
    --steps;
    if (!mesher.try_one_step_refine_mesh()) break;
  }
  return true;
}

// The numbered vertex at the end of the chain of constrained edges that leaves `from` towards `next`.
std::uint32_t end_of_chain(const Cdt& cdt, VertexHandle from, VertexHandle next) {
  while (!next->info().before_refinement) {
    VertexHandle onward;
    auto edge = cdt.incident_edges(next);
    const auto first = edge;
    do {
      if (cdt.is_infinite(*edge) || !edge->first->is_constrained(edge->second)) continue;
      const VertexHandle a = edge->first->vertex(Cdt::cw(edge->second));
      const VertexHandle b = edge->first->vertex(Cdt::ccw(edge->second));
      const VertexHandle other = a == next ? b : a;
      if (other != from) onward = other;
    } while (++edge != first);
    if (onward == VertexHandle()) return kNone;
    from = next;
    next = onward;
  }
  return next->info().index;
}

std::array<std::uint32_t, 2> segment_of(const Cdt& cdt, VertexHandle v) {
  std::array<std::uint32_t, 2> ends{kNone, kNone};
  std::size_t found = 0;
  auto edge = cdt.incident_edges(v);
  const auto first = edge;
  do {
    if (cdt.is_infinite(*edge) || !edge->first->is_constrained(edge->second)) continue;
    const VertexHandle a = edge->first->vertex(Cdt::cw(edge->second));
    const VertexHandle b = edge->first->vertex(Cdt::ccw(edge->second));
    if (found < 2) ends[found] = end_of_chain(cdt, v, a == v ? b : a);
    ++found;
  } while (++edge != first);
  if (found != 2 || ends[0] == kNone || ends[1] == kNone) return {kNone, kNone};
  return ends;
}

void insert_input(Cdt& cdt, const std::vector<Vec2>& points,
                  const std::vector<std::array<std::uint32_t, 2>>& segments) {
  std::vector<VertexHandle> handle;
  handle.reserve(points.size());
  FaceHandle hint;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const VertexHandle v = cdt.insert(Cdt::Point(points[i].x(), points[i].y()), hint);
    if (v->info().index == kNone) v->info() = {static_cast<std::uint32_t>(i), true};
    hint = v->face();
    handle.push_back(v);
  }
  for (const auto& [a, b] : segments)
    if (handle[a] != handle[b]) cdt.insert_constraint(handle[a], handle[b]);
}

}  // namespace

PlanarTriangulation triangulate_planar(const std::vector<Vec2>& points,
                                       const std::vector<std::array<std::uint32_t, 2>>& segments,
                                       const std::function<bool(const Vec2&)>& inside,
                                       const TriangleQuality& quality) {
  PlanarTriangulation out;
  out.points = points;
  silence_cgal();
  Cdt cdt;
  insert_input(cdt, points, segments);
  if (cdt.dimension() < 2) return out;
  for (auto v = cdt.finite_vertices_begin(); v != cdt.finite_vertices_end(); ++v) {
    if (v->info().index != kNone) continue;
    v->info() = {static_cast<std::uint32_t>(out.points.size()), true};
    out.points.push_back(to_vec(v->point()));
    out.on_segment.push_back({kNone, kNone});
  }

  for (auto f = cdt.all_faces_begin(); f != cdt.all_faces_end(); ++f) f->set_in_domain(false);
  const Regions all = find_regions(cdt, [](const FaceHandle&) { return true; });
  for (std::size_t r = 0; r < all.faces.size(); ++r) {
    const bool is_inside = inside(all.point[r]);
    for (const FaceHandle& f : all.faces[r]) f->set_in_domain(is_inside);
  }
  if (wants_refinement(cdt, quality)) {
    try {
      Cdt refined = cdt;
      if (refine(refined, quality)) cdt.swap(refined);
    } catch (const CGAL::Failure_exception&) {
      // Thinner than rounding somewhere: the unrefined triangulation stays.
    }
  }
  for (auto v = cdt.finite_vertices_begin(); v != cdt.finite_vertices_end(); ++v) {
    if (v->info().index != kNone) continue;
    v->info().index = static_cast<std::uint32_t>(out.points.size());
    out.points.push_back(to_vec(v->point()));
    out.on_segment.push_back(segment_of(cdt, v));
  }
  const Regions kept = find_regions(cdt, [](const FaceHandle& f) { return f->is_in_domain(); });
  for (std::size_t r = 0; r < kept.faces.size(); ++r) {
    out.region_point.push_back(kept.point[r]);
    for (const FaceHandle& f : kept.faces[r]) {
      out.triangles.push_back(
          {f->vertex(0)->info().index, f->vertex(1)->info().index, f->vertex(2)->info().index});
      out.region.push_back(static_cast<std::uint32_t>(r));
    }
  }
  return out;
}

}  // namespace reemit

#include "mesh/pieces/planar_triangulation.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>
#include <utility>

// It advises a class for many cascaded crossings, which here are too few to need it.
#define CGAL_NO_CDT_2_WARNING
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/Unique_hash_map.h>

namespace reemit {
namespace {

constexpr std::uint32_t kNone = PlanarTriangulation::kNone;

struct VertexInfo {
  std::uint32_t index = kNone;
};
struct FaceInfo {
  bool inside = false;
};

// Crossings of segments have rounded coordinates.
struct RoundedCrossings {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Tag = CGAL::Exact_predicates_tag;
};

// Crossings of segments have exact coordinates until the end.
struct ExactCrossings {
  using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
  using Tag = CGAL::Exact_intersections_tag;
};

template <class Policy, class Kernel = typename Policy::Kernel,
          class Vertex = CGAL::Triangulation_vertex_base_with_info_2<VertexInfo, Kernel>,
          class Face = CGAL::Constrained_triangulation_face_base_2<
              Kernel, CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel>>>
using CdtOf =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex, Face>,
                                               typename Policy::Tag>;

template <class Point>
Vec2 to_vec(const Point& p) {
  return {CGAL::to_double(p.x()), CGAL::to_double(p.y())};
}

template <class FaceHandle>
std::array<Vec2, 3> corners(const FaceHandle& f) {
  return {to_vec(f->vertex(0)->point()), to_vec(f->vertex(1)->point()), to_vec(f->vertex(2)->point())};
}

struct Shape {
  double squared_sine;    // of the smallest angle
  double squared_length;  // of the longest side
  double area;
};

template <class FaceHandle>
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

// Connected parts of the triangulation between constrained edges.
template <class Cdt>
struct Regions {
  std::vector<std::vector<typename Cdt::Face_handle>> faces;
  std::vector<Vec2> point;
};

template <class Cdt, class Admit>
Regions<Cdt> find_regions(const Cdt& cdt, Admit admit) {
  using FaceHandle = typename Cdt::Face_handle;
  Regions<Cdt> regions;
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

// CGAL prints before it throws; we fall back instead, which is nothing to tell the user.
void silence_cgal() {
  static std::once_flag once;
  std::call_once(
      once, [] { CGAL::set_error_handler([](const char*, const char*, const char*, int, const char*) {}); });
}

template <class Policy>
class Triangulator {
  using Cdt = CdtOf<Policy>;
  using FaceHandle = typename Cdt::Face_handle;
  using VertexHandle = typename Cdt::Vertex_handle;

 public:
  Triangulator(const std::vector<Vec2>& points, const std::vector<std::array<std::uint32_t, 2>>& segments,
               const std::function<bool(const Vec2&)>& inside)
      : inside_(inside) {
    out_.points = points;
    insert_input(segments);
    number_crossings(points.size());
    mark_inside();
  }

  /// Returns false if more points than allowed would be needed.
  bool refine(const TriangleQuality& quality);
  PlanarTriangulation result();

 private:
  struct LongSide {
    double squared_length;
    std::array<std::uint32_t, 2> ends;
  };

  void insert_input(const std::vector<std::array<std::uint32_t, 2>>& segments);
  void number_crossings(std::size_t given);
  void mark_inside();
  std::vector<LongSide> sides_to_split(const TriangleQuality& quality) const;
  void split(const LongSide& side);

  const std::function<bool(const Vec2&)>& inside_;
  Cdt cdt_;
  std::vector<VertexHandle> handle_;  // by index of the point
  PlanarTriangulation out_;
};

template <class Policy>
void Triangulator<Policy>::insert_input(const std::vector<std::array<std::uint32_t, 2>>& segments) {
  FaceHandle hint;
  for (std::size_t i = 0; i < out_.points.size(); ++i) {
    const VertexHandle v = cdt_.insert(typename Cdt::Point(out_.points[i].x(), out_.points[i].y()), hint);
    if (v->info().index == kNone) v->info().index = static_cast<std::uint32_t>(i);
    hint = v->face();
    handle_.push_back(v);
  }
  for (const auto& [a, b] : segments)
    if (handle_[a] != handle_[b]) cdt_.insert_constraint(handle_[a], handle_[b]);
}

template <class Policy>
void Triangulator<Policy>::number_crossings(std::size_t given) {
  for (auto v = cdt_.finite_vertices_begin(); v != cdt_.finite_vertices_end(); ++v) {
    if (v->info().index != kNone) continue;
    v->info().index = static_cast<std::uint32_t>(out_.points.size());
    out_.points.push_back(to_vec(v->point()));
    handle_.push_back(v);
  }
  out_.on_segment.resize(out_.points.size() - given, {kNone, kNone});
}

template <class Policy>
void Triangulator<Policy>::mark_inside() {
  if (cdt_.dimension() < 2) return;
  for (auto f = cdt_.all_faces_begin(); f != cdt_.all_faces_end(); ++f) f->info().inside = false;
  const Regions<Cdt> all = find_regions(cdt_, [](const FaceHandle&) { return true; });
  for (std::size_t r = 0; r < all.faces.size(); ++r) {
    const bool is_inside = inside_(all.point[r]);
    for (const FaceHandle& f : all.faces[r]) f->info().inside = is_inside;
  }
}

template <class Policy>
auto Triangulator<Policy>::sides_to_split(const TriangleQuality& quality) const -> std::vector<LongSide> {
  const double sine = std::sin(quality.smallest_angle_deg * std::numbers::pi / 180);
  // A triangle as thin as rounding cannot be improved.
  constexpr double kFlat = 1e-20;
  std::vector<LongSide> sides;
  for (auto f = cdt_.finite_faces_begin(); f != cdt_.finite_faces_end(); ++f) {
    if (!f->info().inside) continue;
    const Shape shape = shape_of(f);
    if (shape.squared_sine >= sine * sine || shape.squared_sine <= kFlat || shape.area <= quality.free_area ||
        shape.squared_length <= quality.free_length * quality.free_length)
      continue;
    LongSide longest{-1, {0, 0}};
    for (int i = 0; i < 3; ++i) {
      const VertexHandle a = f->vertex(Cdt::ccw(i));
      const VertexHandle b = f->vertex(Cdt::cw(i));
      const double length2 = (to_vec(a->point()) - to_vec(b->point())).squaredNorm();
      if (length2 <= longest.squared_length) continue;
      const auto [low, high] = std::minmax(a->info().index, b->info().index);
      longest = {length2, {low, high}};
    }
    sides.push_back(longest);
  }
  std::sort(sides.begin(), sides.end(), [](const LongSide& x, const LongSide& y) {
    return x.squared_length != y.squared_length ? x.squared_length > y.squared_length : x.ends < y.ends;
  });
  sides.erase(std::unique(sides.begin(), sides.end(),
                          [](const LongSide& x, const LongSide& y) { return x.ends == y.ends; }),
              sides.end());
  return sides;
}

template <class Policy>
void Triangulator<Policy>::split(const LongSide& side) {
  const auto [a, b] = side.ends;
  FaceHandle f;
  int i = 0;
  if (!cdt_.is_edge(handle_[a], handle_[b], f, i)) return;  // an earlier point of this round took it away
  const Vec2 middle = 0.5 * (out_.points[a] + out_.points[b]);
  const typename Cdt::Point p(middle.x(), middle.y());
  const bool on_segment = f->is_constrained(i);
  const VertexHandle v = on_segment ? cdt_.insert(p, Cdt::EDGE, f, i) : cdt_.insert(p, f);
  if (v->info().index != kNone) return;
  v->info().index = static_cast<std::uint32_t>(out_.points.size());
  handle_.push_back(v);
  out_.points.push_back(middle);
  out_.on_segment.push_back(on_segment ? side.ends : std::array<std::uint32_t, 2>{kNone, kNone});
}

template <class Policy>
bool Triangulator<Policy>::refine(const TriangleQuality& quality) {
  if (cdt_.dimension() < 2 || quality.smallest_angle_deg <= 0) return true;
  const std::size_t limit = out_.points.size() + quality.most_new_points;
  for (;;) {
    const std::vector<LongSide> sides = sides_to_split(quality);
    if (sides.empty()) return true;
    if (out_.points.size() + sides.size() > limit) return false;
    const std::size_t before = out_.points.size();
    for (const LongSide& side : sides) split(side);
    if (out_.points.size() == before) return true;
    mark_inside();
  }
}

template <class Policy>
PlanarTriangulation Triangulator<Policy>::result() {
  if (cdt_.dimension() < 2) return std::move(out_);
  const Regions<Cdt> kept = find_regions(cdt_, [](const FaceHandle& f) { return f->info().inside; });
  for (std::size_t r = 0; r < kept.faces.size(); ++r) {
    out_.region_point.push_back(kept.point[r]);
    for (const FaceHandle& f : kept.faces[r]) {
      out_.triangles.push_back(
          {f->vertex(0)->info().index, f->vertex(1)->info().index, f->vertex(2)->info().index});
      out_.region.push_back(static_cast<std::uint32_t>(r));
    }
  }
  return std::move(out_);
}

template <class Policy>
PlanarTriangulation triangulate(const std::vector<Vec2>& points,
                                const std::vector<std::array<std::uint32_t, 2>>& segments,
                                const std::function<bool(const Vec2&)>& inside,
                                const TriangleQuality& quality) {
  if (quality.most_new_points > 0) {
    try {
      Triangulator<Policy> refined(points, segments, inside);
      if (refined.refine(quality)) return refined.result();
    } catch (const CGAL::Failure_exception&) {
      // Something is thinner than rounding; without refinement it may still do.
    }
  }
  try {
    return Triangulator<Policy>(points, segments, inside).result();
  } catch (const CGAL::Failure_exception&) {
    return {};
  }
}

}  // namespace

PlanarTriangulation triangulate_planar(const std::vector<Vec2>& points,
                                       const std::vector<std::array<std::uint32_t, 2>>& segments,
                                       const std::function<bool(const Vec2&)>& inside,
                                       const TriangleQuality& quality, Crossings crossings) {
  silence_cgal();
  return crossings == Crossings::kRounded ? triangulate<RoundedCrossings>(points, segments, inside, quality)
                                          : triangulate<ExactCrossings>(points, segments, inside, quality);
}

}  // namespace reemit

#include "scenes/io/common/polygon_loops.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "scenes/model/measures.h"

namespace reemit {
namespace {

struct Loop {
  std::vector<Vec3> corners;
  std::vector<Vec3> normals;
  std::vector<TexturePoint> texture_points;
};

using Key = std::array<double, 3>;

Key key_of(const Vec3& p) {
  return {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};
}  // -0 and 0 are the same place

// Walks the outline and cuts off a loop whenever a corner comes back that is still on the path.
std::vector<Loop> cut_at_repeated_corners(const Polygon& polygon) {
  std::vector<Loop> loops;
  std::vector<std::size_t> path;
  std::map<Key, std::size_t> position;  // of the corners on the path
  const auto cut_off = [&](std::size_t from) {
    Loop loop;
    for (std::size_t i = from; i < path.size(); ++i) {
      loop.corners.push_back(polygon.outer[path[i]]);
      if (!polygon.normals.empty()) loop.normals.push_back(polygon.normals[path[i]]);
      if (!polygon.texture_points.empty()) loop.texture_points.push_back(polygon.texture_points[path[i]]);
    }
    if (loop.corners.size() >= 3) loops.push_back(std::move(loop));
  };
  for (std::size_t i = 0; i < polygon.outer.size(); ++i) {
    const Key key = key_of(polygon.outer[i]);
    if (const auto seen = position.find(key); seen != position.end()) {
      const std::size_t from = seen->second;
      cut_off(from);
      for (std::size_t k = from; k < path.size(); ++k) position.erase(key_of(polygon.outer[path[k]]));
      path.resize(from);
    }
    position[key] = path.size();
    path.push_back(i);
  }
  cut_off(0);
  return loops;
}

using Point = Eigen::Vector2d;

// A loop seen along the largest component of the polygon's area.
struct FlatLoop {
  std::vector<Point> points;

  FlatLoop(const std::vector<Vec3>& corners, Eigen::Index dropped) {
    for (const Vec3& c : corners) points.emplace_back(c[(dropped + 1) % 3], c[(dropped + 2) % 3]);
  }
  const Point& next(std::size_t i) const { return points[(i + 1) % points.size()]; }
};

bool contains(const FlatLoop& loop, const Point& p) {
  bool inside = false;
  for (std::size_t i = 0; i < loop.points.size(); ++i) {
    const Point &a = loop.points[i], &b = loop.next(i);
    if ((a[1] > p[1]) != (b[1] > p[1]) && p[0] < (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1]) + a[0])
      inside = !inside;
  }
  return inside;
}

// Whether one loop lies in another. They may touch: asked is the corner or middle of an edge of the inner one
// that is farthest from the rim of the outer one.
bool encloses(const FlatLoop& outer, const FlatLoop& inner) {
  double farthest = -1;
  Point asked(0, 0);
  const auto consider = [&](const Point& p) {
    double to_rim = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < outer.points.size(); ++k)
      to_rim = std::min(to_rim, squared_distance_to_segment(p, outer.points[k], outer.next(k)));
    if (to_rim <= farthest) return;
    farthest = to_rim;
    asked = p;
  };
  for (std::size_t i = 0; i < inner.points.size(); ++i) {
    const Point &a = inner.points[i], &b = inner.next(i);
    consider(a);
    consider(0.5 * (a + b));
  }
  return contains(outer, asked);
}

// The loops of an outline, largest first, without those that enclose nothing: what is left of a seam that is
// one edge on the way there and several on the way back.
std::vector<Loop> loops_with_area(std::vector<Loop> loops) {
  const auto area = [](const Loop& l) { return loop_area(l.corners).norm(); };
  std::stable_sort(loops.begin(), loops.end(),
                   [&](const Loop& a, const Loop& b) { return area(a) > area(b); });
  if (!(area(loops[0]) > 0)) return {std::move(loops[0])};
  constexpr double kNothing = 1e-12;  // of the largest, far above the rounding of an area
  std::erase_if(loops,
                [&, smallest = kNothing * area(loops[0])](const Loop& l) { return area(l) <= smallest; });
  return loops;
}

void turn(Loop& loop) {
  std::reverse(loop.corners.begin(), loop.corners.end());
  std::reverse(loop.normals.begin(), loop.normals.end());
  std::reverse(loop.texture_points.begin(), loop.texture_points.end());
}

}  // namespace

std::vector<Polygon> split_at_seams(Polygon polygon) {
  std::vector<Loop> loops = cut_at_repeated_corners(polygon);
  if (loops.empty()) return {};
  loops = loops_with_area(std::move(loops));
  if (loops.size() == 1) {
    polygon.outer = std::move(loops[0].corners);
    polygon.normals = std::move(loops[0].normals);
    polygon.texture_points = std::move(loops[0].texture_points);
    return {std::move(polygon)};
  }
  Eigen::Index dropped = 0;
  loop_area(loops[0].corners).cwiseAbs().maxCoeff(&dropped);
  std::vector<FlatLoop> flat;
  std::vector<std::size_t> depth;      // number of loops around each
  std::vector<std::size_t> island_of;  // that which the loop bounds, from outside or inside
  std::size_t islands = 0;
  Vec3 front = Vec3::Zero();  // area of the outermost loops
  for (std::size_t i = 0; i < loops.size(); ++i) {
    flat.emplace_back(loops[i].corners, dropped);
    depth.push_back(0);
    island_of.push_back(islands);
    for (std::size_t k = 0; k < i; ++k)
      if (encloses(flat[k], flat[i])) {
        ++depth[i];
        island_of[i] = island_of[k];
      }
    if (depth[i] == 0) front += loop_area(loops[i].corners);
    if (depth[i] % 2 == 0) island_of[i] = islands++;
  }
  // Encloses as much area backwards as forwards: it has no front, which is not for a reader to decide.
  if (!(front.norm() > 1e-12 * loop_area(loops[0].corners).norm())) return {std::move(polygon)};

  std::vector<Polygon> out(islands);
  std::vector<std::size_t> outline;  // by island
  for (std::size_t i = 0; i < loops.size(); ++i) {
    Polygon& island = out[island_of[i]];
    if (depth[i] % 2 != 0) {
      island.holes.push_back(std::move(loops[i].corners));
      continue;
    }
    if (loop_area(loops[i].corners).dot(front) < 0) turn(loops[i]);
    island.outer = std::move(loops[i].corners);
    island.normals = std::move(loops[i].normals);
    island.texture_points = std::move(loops[i].texture_points);
    outline.push_back(i);
  }
  for (auto& hole : polygon.holes) {
    std::size_t home = 0;  // the smallest island around it
    for (std::size_t k = 0; k < islands; ++k)
      if (encloses(flat[outline[k]], FlatLoop(hole, dropped))) home = k;
    out[home].holes.push_back(std::move(hole));
  }
  return out;
}

}  // namespace reemit

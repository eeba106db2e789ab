#include "scenes/io/polygon_loops.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace reemit {
namespace {

struct Loop {
  std::vector<Vec3> corners;
  std::vector<Vec3> normals;
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

// Whether `point` is inside the loop, both projected along the loop's largest area component.
bool contains(const std::vector<Vec3>& loop, const Vec3& point) {
  Eigen::Index drop = 0;
  loop_area(loop).cwiseAbs().maxCoeff(&drop);
  const Eigen::Index u = (drop + 1) % 3, v = (drop + 2) % 3;
  bool inside = false;
  for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
    const Vec3 &a = loop[i], &b = loop[j];
    if ((a[v] > point[v]) != (b[v] > point[v]) &&
        point[u] < (b[u] - a[u]) * (point[v] - a[v]) / (b[v] - a[v]) + a[u])
      inside = !inside;
  }
  return inside;
}

// The smallest island around a hole; the first, which is the largest, if the hole only touches one.
std::size_t island_around(const std::vector<Polygon>& islands, const std::vector<Vec3>& hole) {
  const Vec3 middle = (hole[0] + hole[1] + hole[2]) / 3;
  std::size_t best = 0;
  for (std::size_t i = 1; i < islands.size(); ++i)
    if (contains(islands[i].outer, middle)) best = i;
  return best;
}

}  // namespace

Vec3 loop_area(const std::vector<Vec3>& loop) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) sum += (loop[i] - loop[0]).cross(loop[i + 1] - loop[0]);
  return sum / 2;
}

std::vector<Polygon> split_at_seams(Polygon polygon) {
  std::vector<Loop> loops = cut_at_repeated_corners(polygon);
  if (loops.empty()) return {};
  if (loops.size() == 1) {
    polygon.outer = std::move(loops[0].corners);
    polygon.normals = std::move(loops[0].normals);
    return {std::move(polygon)};
  }
  std::stable_sort(loops.begin(), loops.end(), [](const Loop& a, const Loop& b) {
    return loop_area(a.corners).squaredNorm() > loop_area(b.corners).squaredNorm();
  });
  const Vec3 front = loop_area(loops[0].corners);
  std::vector<Polygon> islands;
  for (Loop& loop : loops)
    if (loop_area(loop.corners).dot(front) >= 0) islands.push_back({loop.corners, loop.normals, {}});
  for (Loop& loop : loops)
    if (loop_area(loop.corners).dot(front) < 0)
      islands[island_around(islands, loop.corners)].holes.push_back(std::move(loop.corners));
  for (auto& hole : polygon.holes) islands[island_around(islands, hole)].holes.push_back(std::move(hole));
  return islands;
}

}  // namespace reemit

#include "bench/hit_paths/polygon_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "bench/hit_paths/quadric_hit.h"

namespace reemit::hit_paths {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kLeaf = 4;
/// Share of the room's diagonal within which parallel polygons lie in one plane. The mesher's own tolerance
/// need not be known: rooms that depend on it are ambiguous.
constexpr double kSamePlane = 1e-7;
/// Deviation from the plane, as a share of the size, above which a polygon is taken as a fan of triangles.
constexpr double kBent = 1e-6;

Vec3 vector_area(const std::vector<Vec3>& loop) {
  Vec3 twice = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) twice += (loop[i] - loop[0]).cross(loop[i + 1] - loop[0]);
  return 0.5 * twice;
}

bool is_inside(const std::vector<std::vector<Eigen::Vector2d>>& loops, const Eigen::Vector2d& p) {
  bool inside = false;
  for (const auto& loop : loops)
    for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
      if ((loop[i].y() > p.y()) == (loop[j].y() > p.y())) continue;
      const double x =
          loop[i].x() + (p.y() - loop[i].y()) / (loop[j].y() - loop[i].y()) * (loop[j].x() - loop[i].x());
      if (p.x() < x) inside = !inside;
    }
  return inside;
}

void grow(Box& box, const Box& other) {
  box.min = box.min.cwiseMin(other.min);
  box.max = box.max.cwiseMax(other.max);
}

Box empty_box() {
  return {Vec3::Constant(kInfinity), Vec3::Constant(-kInfinity)};
}

bool crosses(const Box& box, const Vec3& origin, const Vec3& inverse, double far) {
  double near = 0;
  for (int k = 0; k < 3; ++k) {
    const double a = (box.min[k] - origin[k]) * inverse[k];
    const double b = (box.max[k] - origin[k]) * inverse[k];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near <= far;
}

}  // namespace

PolygonRoom::PolygonRoom(const Scene& scene) : diagonal_(bounds(scene).size().norm()) {
  for (const Surface& surface : scene.surfaces) {
    const Material& material = scene.material_of(surface);
    for (const Face& face : surface.faces) add_face(surface, face, material);
    for (const CurvedShape& shape : surface.shapes) add_shape(shape, material);
  }
  const Vec3 slack = Vec3::Constant(1e-9 * diagonal_);
  for (Part& part : parts_) {
    part.box.min -= slack;
    part.box.max += slack;
  }
  order_.resize(parts_.size());
  std::iota(order_.begin(), order_.end(), 0U);
  if (!parts_.empty()) build(0, parts_.size());
  find_twins();
}

void PolygonRoom::add_face(const Surface& surface, const Face& face, const Material& material) {
  std::vector<std::vector<Vec3>> loops;
  const auto add_loop = [&](const std::vector<std::uint32_t>& indices) {
    std::vector<Vec3>& loop = loops.emplace_back();
    for (const std::uint32_t i : indices) loop.push_back(surface.positions[i]);
  };
  add_loop(face.outer);
  for (const auto& hole : face.holes) add_loop(hole);
  const Vec3 area = vector_area(loops[0]);
  const double size = std::sqrt(area.norm());
  if (!(size > 0)) return;
  const Vec3 normal = area.normalized();
  double bend = 0;
  for (const Vec3& p : loops[0]) bend = std::max(bend, std::abs(normal.dot(p - loops[0][0])));
  if (bend <= kBent * size || loops.size() > 1 || loops[0].size() == 3) {
    add_polygon(std::move(loops), material);
    return;
  }
  for (std::size_t i = 1; i + 1 < loops[0].size(); ++i)
    add_polygon({{loops[0][0], loops[0][i], loops[0][i + 1]}}, material);
}

void PolygonRoom::add_polygon(std::vector<std::vector<Vec3>> loops, const Material& material) {
  const Vec3 area = vector_area(loops[0]);
  if (!(area.norm() > 0)) return;
  Polygon polygon;
  polygon.normal = area.normalized();
  polygon.origin = loops[0][0];
  polygon.u = polygon.normal.unitOrthogonal();
  polygon.v = polygon.normal.cross(polygon.u);
  Part part;
  part.box = empty_box();
  part.material = &material;
  part.polygon = static_cast<std::uint32_t>(polygons_.size());
  for (const auto& loop : loops) {
    auto& flat = polygon.loops.emplace_back();
    for (const Vec3& p : loop) {
      flat.emplace_back(polygon.u.dot(p - polygon.origin), polygon.v.dot(p - polygon.origin));
      grow(part.box, {p, p});
    }
  }
  polygons_.push_back(std::move(polygon));
  parts_.push_back(std::move(part));
}

void PolygonRoom::add_shape(const CurvedShape& shape, const Material& material) {
  Part part;
  std::tie(part.box.min, part.box.max) = shape_bounds(shape);
  part.material = &material;
  part.shape = static_cast<std::uint32_t>(shapes_.size());
  shapes_.push_back(shape);
  parts_.push_back(std::move(part));
}

std::uint32_t PolygonRoom::build(std::size_t first, std::size_t last) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Box box = empty_box();
  Box middles = empty_box();
  for (std::size_t i = first; i < last; ++i) {
    grow(box, parts_[order_[i]].box);
    const Vec3 c = parts_[order_[i]].box.centre();
    grow(middles, {c, c});
  }
  nodes_[index].box = box;
  if (last - first <= kLeaf) {
    nodes_[index].first = static_cast<std::uint32_t>(first);
    nodes_[index].count = static_cast<std::uint32_t>(last - first);
    return index;
  }
  int axis = 0;
  middles.size().maxCoeff(&axis);
  const auto middle = order_.begin() + static_cast<std::ptrdiff_t>((first + last) / 2);
  std::nth_element(order_.begin() + static_cast<std::ptrdiff_t>(first), middle,
                   order_.begin() + static_cast<std::ptrdiff_t>(last), [&](std::uint32_t a, std::uint32_t b) {
                     return parts_[a].box.centre()[axis] < parts_[b].box.centre()[axis];
                   });
  build(first, (first + last) / 2);
  nodes_[index].first = build((first + last) / 2, last);
  return index;
}

template <class Use>
void PolygonRoom::walk(const Vec3& origin, const Vec3& direction, double& far, Use&& use) const {
  if (nodes_.empty()) return;
  const Vec3 inverse = direction.cwiseInverse();
  std::array<std::uint32_t, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t index = stack[--depth];
    const Node& node = nodes_[index];
    if (!crosses(node.box, origin, inverse, far)) continue;
    if (node.count == 0) {
      // The child that lies nearer along the ray is looked at first.
      const std::uint32_t left = index + 1;
      const std::uint32_t right = node.first;
      const bool left_first = (nodes_[left].box.centre() - nodes_[right].box.centre()).dot(direction) < 0;
      stack[depth++] = left_first ? right : left;
      stack[depth++] = left_first ? left : right;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) use(order_[i]);
  }
}

void PolygonRoom::find_twins() {
  const double slack = kSamePlane * diagonal_;
  for (std::uint32_t i = 0; i < parts_.size(); ++i) {
    if (parts_[i].shape != kNoShape) continue;
    const Polygon& a = polygons_[parts_[i].polygon];
    std::vector<std::uint32_t> open{0};
    const Box box{parts_[i].box.min - Vec3::Constant(slack), parts_[i].box.max + Vec3::Constant(slack)};
    while (!open.empty()) {
      const std::uint32_t index = open.back();
      open.pop_back();
      const Node& node = nodes_[index];
      if ((node.box.min.array() > box.max.array()).any() || (node.box.max.array() < box.min.array()).any())
        continue;
      if (node.count == 0) {
        open.push_back(index + 1);
        open.push_back(node.first);
        continue;
      }
      for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
        const std::uint32_t j = order_[k];
        if (j == i || parts_[j].shape != kNoShape) continue;
        const Polygon& b = polygons_[parts_[j].polygon];
        if (a.normal.cross(b.normal).norm() * parts_[j].box.size().norm() > slack) continue;
        if (std::abs(a.normal.dot(b.origin - a.origin)) <= slack) parts_[i].twins.push_back(j);
      }
    }
    std::sort(parts_[i].twins.begin(), parts_[i].twins.end());
  }
}

std::optional<double> PolygonRoom::meet(const Part& part, const Vec3& origin, const Vec3& direction,
                                        double near, double far, Vec3& normal) const {
  if (part.shape != kNoShape)
    return nearest_on_shape(shapes_[part.shape], origin, direction, near, far, normal);
  const Polygon& polygon = polygons_[part.polygon];
  const double slope = polygon.normal.dot(direction);
  if (slope == 0) return std::nullopt;
  const double t = polygon.normal.dot(polygon.origin - origin) / slope;
  if (!(t > near && t < far)) return std::nullopt;
  const Vec3 p = origin + t * direction - polygon.origin;
  if (!is_inside(polygon.loops, {polygon.u.dot(p), polygon.v.dot(p)})) return std::nullopt;
  normal = polygon.normal;
  return t;
}

/// Where several polygons lie in one plane, a luminaire that shines towards the ray wins, then what turns its
/// front to it, then the one that was read first. Of matt ones back to back each has its side, whether
/// two-sided or not.
const PolygonRoom::Part& PolygonRoom::winner(std::uint32_t part, const Vec3& point,
                                             const Vec3& direction) const {
  const auto faces_ray = [&](std::uint32_t i) {
    return polygons_[parts_[i].polygon].normal.dot(direction) < 0;
  };
  const auto rank = [&](std::uint32_t i) {
    const Material& m = *parts_[i].material;
    const bool shines = m.emits() && (faces_ray(i) || m.emits_both_sides);
    return std::pair(shines ? 0 : faces_ray(i) || m.two_sided ? 1 : 2, i);
  };
  const auto is_matt = [&](std::uint32_t i) {
    const NonDiffusePart& of_light = parts_[i].material->non_diffuse;
    return !parts_[i].material->emits() && !of_light.reflects_specularly() &&
           !of_light.transmits_specularly() && !of_light.transmits_diffusely();
  };
  const auto wins = [&](std::uint32_t i, std::uint32_t other) {
    if (faces_ray(i) != faces_ray(other) && is_matt(i) && is_matt(other)) return faces_ray(i);
    return rank(i) < rank(other);
  };
  std::uint32_t best = part;
  for (const std::uint32_t twin : parts_[part].twins) {
    const Polygon& polygon = polygons_[parts_[twin].polygon];
    const Vec3 p = point - polygon.origin;
    if (is_inside(polygon.loops, {polygon.u.dot(p), polygon.v.dot(p)}) && wins(twin, best)) best = twin;
  }
  return parts_[best];
}

std::optional<RoomHit> PolygonRoom::closest(const RayStart& start, const Vec3& direction,
                                            bool through_backs) const {
  double near = 1e-11 * diagonal_;
  const std::vector<std::uint32_t>* left = nullptr;
  if (start.part != RayStart::kFree) left = &parts_[start.part].twins;
  for (;;) {
    double far = kInfinity;
    std::uint32_t found = RayStart::kFree;
    Vec3 normal = Vec3::UnitZ();
    walk(start.point, direction, far, [&](std::uint32_t i) {
      const bool leaves = i == start.part && parts_[i].shape == kNoShape;
      if (leaves || (left != nullptr && std::binary_search(left->begin(), left->end(), i))) return;
      const double from = i == start.part ? std::max(near, 1e-9 * diagonal_) : near;
      Vec3 n;
      if (const auto t = meet(parts_[i], start.point, direction, from, far, n)) {
        far = *t;
        found = i;
        normal = n;
      }
    });
    if (found == RayStart::kFree) return std::nullopt;
    RoomHit hit;
    hit.distance = far;
    hit.point = start.point + far * direction;
    const Part& part = winner(found, hit.point, direction);
    hit.part = static_cast<std::uint32_t>(&part - parts_.data());
    if (part.shape == kNoShape) normal = polygons_[part.polygon].normal;
    hit.front = normal.dot(direction) < 0;
    hit.normal = hit.front ? normal : Vec3(-normal);
    hit.material = part.material;
    if (!through_backs || hit.front || part.material->two_sided) return hit;
    near = far + 1e-11 * diagonal_;
  }
}

}  // namespace reemit::hit_paths

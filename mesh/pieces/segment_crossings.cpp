#include "mesh/pieces/segment_crossings.h"

#include <cstdint>
#include <utility>
#include <vector>

#include "mesh/geometry/box_tree.h"
#include "mesh/pieces/convex_region.h"
#include "mesh/pieces/plane_boxes.h"

namespace reemit {
namespace {

// On which side of the line from a to b: positive left of it.
double side(const Vec2& a, const Vec2& b, const Vec2& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

bool opposite(double x, double y) {
  return (x > 0 && y < 0) || (x < 0 && y > 0);
}

Vec3 in_space(const Vec2& p) {
  return {p.x(), p.y(), 0};
}

}  // namespace

std::size_t count_crossings(std::span<const PlanarSegment> segments, std::size_t most) {
  if (segments.size() * segments.size() / 2 <= most) return 0;  // there cannot be too many
  std::vector<IndexedBox> boxes;
  boxes.reserve(segments.size());
  for (const PlanarSegment& s : segments)
    boxes.push_back(box_in_plane(s.from.cwiseMin(s.to), s.from.cwiseMax(s.to), boxes.size()));
  const BoxTree tree(std::move(boxes));
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < segments.size() && count <= most; ++i) {
    const auto& [a, b] = segments[i];
    const auto region = ConvexRegion::of_edge(in_space(a), in_space(b), 0);
    tree.visit([&](const Vec3& low, const Vec3& high) { return count <= most && region.touches(low, high); },
               [&, &a = a, &b = b](std::uint32_t j) {
                 if (j <= i) return;
                 const auto& [c, d] = segments[j];
                 if (opposite(side(a, b, c), side(a, b, d)) && opposite(side(c, d, a), side(c, d, b)))
                   ++count;
               });
  }
  return count;
}

}  // namespace reemit

#include "mesh/geometry/box_pairs.h"

#include <algorithm>

namespace reemit {

void for_each_box_pair(const std::vector<IndexedBox>& a, const std::vector<IndexedBox>& b,
                       const std::function<void(std::uint32_t, std::uint32_t)>& visit) {
  const BoxTree tree(b);
  std::vector<std::uint32_t> near;
  for (const IndexedBox& box : a) {
    near.clear();
    const auto touches = [&](const Vec3& low, const Vec3& high) {
      return (low.array() <= box.max.array()).all() && (high.array() >= box.min.array()).all();
    };
    tree.visit(touches, [&](std::uint32_t j) { near.push_back(j); });
    std::sort(near.begin(), near.end());
    for (const std::uint32_t j : near) visit(box.index, j);
  }
}

}  // namespace reemit

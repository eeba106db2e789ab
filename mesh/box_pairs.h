#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "scenes/model/vec.h"

namespace reemit {

/// Axis-aligned box with the index of what it holds.
struct IndexedBox {
  Vec3 min;
  Vec3 max;
  std::uint32_t index = 0;
};

/// Calls `visit(i, j)` with the indices of every two boxes of the list that touch, once, with i < j, in
/// ascending order.
void for_each_box_pair(const std::vector<IndexedBox>& boxes,
                       const std::function<void(std::uint32_t, std::uint32_t)>& visit);

/// Calls `visit(i, j)` for every box i of `a` and box j of `b` that touch, in ascending order.
void for_each_box_pair(const std::vector<IndexedBox>& a, const std::vector<IndexedBox>& b,
                       const std::function<void(std::uint32_t, std::uint32_t)>& visit);

}  // namespace reemit

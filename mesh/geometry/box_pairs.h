#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "mesh/geometry/box_tree.h"

namespace reemit {

/// Calls `visit(i, j)` for every box i of `a` and box j of `b` that touch: in the order of `a`, and by
/// ascending j. No pairs are stored.
void for_each_box_pair(const std::vector<IndexedBox>& a, const std::vector<IndexedBox>& b,
                       const std::function<void(std::uint32_t, std::uint32_t)>& visit);

}  // namespace reemit

#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scenes/model/vec.h"

namespace reemit {

/// Axis-aligned box with the index of what it holds.
struct IndexedBox {
  Vec3 min;
  Vec3 max;
  std::uint32_t index = 0;
};

/// Boxes in a binary tree of bounding boxes, to ask for those that may touch something thinner than a box of
/// its own: a slanted wall, a long edge. Building takes n log n, memory about 90 bytes per box; nothing is
/// stored per pair.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::vector<IndexedBox> boxes);

  /// Calls `visit(index)` for every box that `admit(min, max)` admits, in an order that depends on the boxes
  /// alone. `admit` is also asked about boxes around several: it must admit what holds an admitted box.
  template <class Admit, class Visit>
  void visit(const Admit& admit, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, 64> waiting;  // deeper than a balanced tree of 2^32 boxes
    std::size_t count = 0;
    waiting[count++] = 0;
    while (count > 0) {
      const std::uint32_t at = waiting[--count];
      const Node& node = nodes_[at];
      if (!admit(node.min, node.max)) continue;
      if (node.right != 0) {
        waiting[count++] = node.right;
        waiting[count++] = at + 1;
        continue;
      }
      for (std::uint32_t i = node.begin; i < node.end; ++i)
        if (admit(boxes_[i].min, boxes_[i].max)) visit(boxes_[i].index);
    }
  }

 private:
  struct Node {
    Vec3 min;
    Vec3 max;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t right = 0;  // the left child follows its parent; 0 = a leaf
  };
  void build(std::uint32_t begin, std::uint32_t end);

  std::vector<IndexedBox> boxes_;
  std::vector<Node> nodes_;
};

}  // namespace reemit

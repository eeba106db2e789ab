#include "mesh/geometry/box_tree.h"

#include <algorithm>
#include <utility>

namespace reemit {
namespace {

constexpr std::uint32_t kLeaf = 4;  // boxes

}  // namespace

BoxTree::BoxTree(std::vector<IndexedBox> boxes) : boxes_(std::move(boxes)) {
  nodes_.reserve(boxes_.size());
  if (!boxes_.empty()) build(0, static_cast<std::uint32_t>(boxes_.size()));
}

void BoxTree::build(std::uint32_t begin, std::uint32_t end) {
  const std::size_t at = nodes_.size();
  Node node{.min = boxes_[begin].min, .max = boxes_[begin].max, .begin = begin, .end = end};
  Vec3 low = boxes_[begin].min + boxes_[begin].max;  // of twice the centres
  Vec3 high = low;
  for (std::uint32_t i = begin + 1; i < end; ++i) {
    node.min = node.min.cwiseMin(boxes_[i].min);
    node.max = node.max.cwiseMax(boxes_[i].max);
    const Vec3 centre = boxes_[i].min + boxes_[i].max;
    low = low.cwiseMin(centre);
    high = high.cwiseMax(centre);
  }
  nodes_.push_back(node);
  if (end - begin <= kLeaf) return;
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;  // by count: boxes in one place stay balanced
  std::nth_element(boxes_.begin() + begin, boxes_.begin() + middle, boxes_.begin() + end,
                   [axis](const IndexedBox& a, const IndexedBox& b) {
                     const double x = a.min[axis] + a.max[axis];
                     const double y = b.min[axis] + b.max[axis];
                     return x != y ? x < y : a.index < b.index;
                   });
  build(begin, middle);
  nodes_[at].right = static_cast<std::uint32_t>(nodes_.size());
  build(middle, end);
}

}  // namespace reemit

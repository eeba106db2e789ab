#pragma once
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace reemit {

/// Union-find. The representative of a set is its smallest member, so results do not depend on the order of
/// joins.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) {
    i = find(i);
    j = find(j);
    if (i > j) std::swap(i, j);
    parent_[j] = i;
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace reemit

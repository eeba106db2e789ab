#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace reemit {

/// A straight edge between two vertices.
struct VertexEdge {
  std::uint32_t from;
  std::uint32_t to;
};

/// The edges of many polygons, each once, from the smaller vertex to the larger. Sorted by place in memory:
/// edges number four bytes each while they are collected, and none has to be hashed.
class EdgeSet {
 public:
  /// `for_each(visit)` calls visit(a, b) for every edge, a != b, in either direction and as often as it
  /// occurs; it is asked twice.
  template <class ForEach>
  EdgeSet(std::size_t vertices, const ForEach& for_each) : first_(vertices + 1, 0) {
    for_each([&](std::uint32_t a, std::uint32_t b) { ++first_[std::min(a, b) + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::uint32_t> ends(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for_each([&](std::uint32_t a, std::uint32_t b) { ends[next[std::min(a, b)]++] = std::max(a, b); });
    edges_.reserve(ends.size() / 2);
    for (std::size_t v = 0; v < vertices; ++v) {
      const auto begin = ends.begin() + static_cast<std::ptrdiff_t>(first_[v]);
      const auto end = ends.begin() + static_cast<std::ptrdiff_t>(first_[v + 1]);
      std::sort(begin, end);
      first_[v] = edges_.size();
      for (auto it = begin; it != end; ++it)
        if (it == begin || *it != *(it - 1)) edges_.push_back({static_cast<std::uint32_t>(v), *it});
    }
    first_.back() = edges_.size();
  }

  const std::vector<VertexEdge>& edges() const { return edges_; }
  /// Number of an edge of the set, given in either direction.
  std::size_t index(std::uint32_t a, std::uint32_t b) const {
    const auto [from, to] = std::minmax(a, b);
    const auto begin = edges_.begin() + static_cast<std::ptrdiff_t>(first_[from]);
    const auto end = edges_.begin() + static_cast<std::ptrdiff_t>(first_[from + 1]);
    const auto at =
        std::lower_bound(begin, end, to, [](const VertexEdge& e, std::uint32_t v) { return e.to < v; });
    return static_cast<std::size_t>(at - edges_.begin());
  }

 private:
  std::vector<std::size_t> first_;  // edge, by smaller vertex, and one past the last
  std::vector<VertexEdge> edges_;
};

}  // namespace reemit

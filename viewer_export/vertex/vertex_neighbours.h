#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace reemit {

/// Which vertices of a mesh share a triangle.
class VertexNeighbours {
 public:
  VertexNeighbours(std::size_t vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles);

  /// In ascending order.
  std::span<const std::uint32_t> of(std::size_t vertex) const {
    return {neighbours_.data() + first_[vertex], neighbours_.data() + first_[vertex + 1]};
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> neighbours_;
};

}  // namespace reemit

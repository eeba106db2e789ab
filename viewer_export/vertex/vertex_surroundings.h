#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "viewer_export/vertex/vertex_neighbours.h"
#include "viewer_export/vertex/vertex_ring.h"

namespace reemit {

/// The vertices around one, on its smooth part of a surface, nearer ones first.
struct Surrounding {
  static constexpr std::size_t kHops = 5;  ///< Edges to each side that are looked at: some 90 vertices.

  std::vector<std::uint32_t> vertices;        ///< The vertex itself first.
  std::array<std::size_t, kHops + 1> upto{};  ///< How many are within so many edges.
  std::vector<double> x, y;                   ///< Their places in its tangent plane [m], itself at 0.
};

/// Finds surroundings; one for each thread. What it is made from must outlive it.
class Surroundings {
 public:
  Surroundings(const VertexRings& rings, const VertexNeighbours& neighbours)
      : rings_(rings), neighbours_(neighbours), seen_in_(rings.size(), 0) {}

  /// Good until the next call.
  const Surrounding& of(std::size_t vertex);

 private:
  const VertexRings& rings_;
  const VertexNeighbours& neighbours_;
  Surrounding found_;
  std::uint64_t visit_ = 0;
  std::vector<std::uint64_t> seen_in_;  // by vertex: the visit that found it last
};

}  // namespace reemit

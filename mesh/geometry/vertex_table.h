#pragma once
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "scenes/model/vec.h"

namespace reemit {

/// All vertices of the mesh. Points closer than the weld distance become one vertex with one position, so
/// that faces which share a corner share it bit by bit.
class VertexTable {
 public:
  /// `weld`: distance [m] within which points are one; 0 = only equal points.
  explicit VertexTable(double weld) : weld_(weld) {}

  /// Index of the vertex at `p`: the nearest one within the weld distance (the first of equals), else a new
  /// one.
  std::uint32_t weld(const Vec3& p);

  /// Makes room for this many, so that they need not be moved when there are more.
  void reserve(std::size_t points) {
    points_.reserve(points);
    cells_.reserve(points);
  }

  const Vec3& operator[](std::uint32_t i) const { return points_[i]; }
  std::size_t size() const { return points_.size(); }
  const std::vector<Vec3>& points() const { return points_; }

 private:
  /// Twice as wide as the weld distance; of equal points alone where that is 0.
  struct Cell {
    std::int64_t x, y, z;
    bool operator==(const Cell&) const = default;
  };
  struct CellHash {
    std::size_t operator()(const Cell& c) const;
  };
  Cell cell_of(const Vec3& p) const;

  double weld_;
  std::vector<Vec3> points_;
  std::unordered_multimap<Cell, std::uint32_t, CellHash> cells_;
};

}  // namespace reemit

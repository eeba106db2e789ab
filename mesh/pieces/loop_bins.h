#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/pieces/face_piece.h"

namespace reemit {

/// Winding numbers around a loop of many corners: its edges sorted into strips along y, so that a question
/// looks at the edges of one strip only.
class LoopBins {
 public:
  explicit LoopBins(const std::vector<Vec2>& loop);
  /// The same as winding_number(loop, p).
  int winding(const Vec2& p) const;

 private:
  struct Edge {
    Vec2 from;
    Vec2 to;
  };
  std::size_t bin_of(double y) const;

  double low_ = 0;
  double bins_per_metre_ = 0;
  std::size_t bins_ = 1;
  std::vector<std::uint32_t> first_;  // by strip, and one past the last
  std::vector<Edge> edges_;           // strip by strip
};

}  // namespace reemit

#include "mesh/geometry/vertex_table.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace reemit {

std::size_t VertexTable::CellHash::operator()(const Cell& c) const {
  auto h = static_cast<std::uint64_t>(c.x) * 0x9e3779b97f4a7c15ULL;
  h = (h ^ (h >> 29) ^ static_cast<std::uint64_t>(c.y)) * 0xbf58476d1ce4e5b9ULL;
  h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(c.z)) * 0x94d049bb133111ebULL;
  return static_cast<std::size_t>(h ^ (h >> 31));
}

VertexTable::Cell VertexTable::cell_of(const Vec3& p) const {
  static constexpr double kFarthest =
      4e18;  // rooms this far from 0 in terms of their size have lost all digits anyway
  const auto index = [this](double x) {
    if (weld_ == 0) return std::bit_cast<std::int64_t>(x + 0.0);  // which makes one zero of the two
    return static_cast<std::int64_t>(std::floor(std::clamp(x / (2 * weld_), -kFarthest, kFarthest)));
  };
  return {index(p.x()), index(p.y()), index(p.z())};
}

std::uint32_t VertexTable::weld(const Vec3& p) {
  // The box around p touches at most two cells along each axis.
  const Vec3 reach = Vec3::Constant(weld_);
  const Cell low = cell_of(p - reach);
  const Cell high = cell_of(p + reach);
  std::uint32_t best = 0;
  double best_distance = weld_ * weld_;
  bool found = false;
  for (std::int64_t x = low.x; x <= high.x; ++x) {
    for (std::int64_t y = low.y; y <= high.y; ++y) {
      for (std::int64_t z = low.z; z <= high.z; ++z) {
        const auto [begin, end] = cells_.equal_range({x, y, z});
        for (auto it = begin; it != end; ++it) {
          const double d = (points_[it->second] - p).squaredNorm();
          if (d < best_distance || (d == best_distance && (!found || it->second < best))) {
            best_distance = d;
            best = it->second;
            found = true;
          }
        }
      }
    }
  }
  if (found) return best;
  const auto added = static_cast<std::uint32_t>(points_.size());
  points_.push_back(p);
  cells_.emplace(cell_of(p), added);
  return added;
}

}  // namespace reemit

#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "scenes/model/vec.h"

namespace reemit {

/// Points in cubic cells, for all that lie within a radius of a place; rebuilt for each size of the cells.
class PhotonGrid {
 public:
  PhotonGrid() = default;
  /// Of the points `numbers` among the places. `cell` > 0: edge of a cell, twice the largest radius that will
  /// be asked for.
  PhotonGrid(const std::vector<Vec3f>& places, const std::vector<std::uint32_t>& numbers, float cell);

  /// Calls use(point number, squared distance) for every point within `radius` <= cell/2 of a place, in the
  /// same order each time.
  template <class Use>
  void visit(const Vec3f& place, float radius, const Use& use) const {
    visit_some(place, radius, std::numeric_limits<std::uint32_t>::max(),
               [&use](std::uint32_t number, float d2, float) { use(number, d2); });
  }
  /// The same of at most `most` points of each cell, those that came first: use(point number, squared
  /// distance, points of the cell for each that is looked at).
  template <class Use>
  void visit_some(const Vec3f& place, float radius, std::uint32_t most, const Use& use) const {
    if (table_.empty()) return;
    const float r2 = radius * radius;
    std::array<std::int64_t, 3> low{};
    for (int k = 0; k < 3; ++k)
      low[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor(place[k] / cell_ - 0.5F));
    for (std::int64_t corner = 0; corner < 8; ++corner) {
      const std::uint64_t key =
          key_of(low[0] + (corner & 1), low[1] + (corner >> 1 & 1), low[2] + (corner >> 2));
      for (std::size_t slot = slot_of(key); table_[slot].end != 0; slot = (slot + 1) & (table_.size() - 1)) {
        if (table_[slot].key != key) continue;
        const std::uint32_t all = table_[slot].end - table_[slot].begin;
        const std::uint32_t looked_at = std::min(all, most);
        const float scale = static_cast<float>(all) / static_cast<float>(looked_at);
        for (std::uint32_t i = table_[slot].begin; i < table_[slot].begin + looked_at; ++i)
          if (const float d2 = (points_[i].place - place).squaredNorm(); d2 < r2)
            use(points_[i].number, d2, scale);
        break;
      }
    }
  }

 private:
  struct Point {
    Vec3f place;
    std::uint32_t number;
  };
  struct Cell {
    std::uint64_t key = 0;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;  // 0: there is no such cell
  };

  static std::uint64_t key_of(std::int64_t i, std::int64_t j, std::int64_t k) {
    constexpr std::int64_t kOffset = 1 << 20;
    const auto bits = [](std::int64_t n) { return static_cast<std::uint64_t>(n + kOffset) & 0x1fffff; };
    return bits(i) << 42 | bits(j) << 21 | bits(k);
  }
  std::uint64_t key_of(const Vec3f& p) const {
    const auto cell = [this](float x) { return static_cast<std::int64_t>(std::floor(x / cell_)); };
    return key_of(cell(p.x()), cell(p.y()), cell(p.z()));
  }
  std::size_t slot_of(std::uint64_t key) const {
    return static_cast<std::size_t>(key * 0x9e3779b97f4a7c15ULL >> 20) & (table_.size() - 1);
  }

  float cell_ = 1;
  std::vector<Point> points_;  // by cell
  std::vector<Cell> table_;    // open addressing, at most half full
};

}  // namespace reemit

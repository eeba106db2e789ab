#include "solver/gather/photon_grid.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace reemit {

PhotonGrid::PhotonGrid(const std::vector<Vec3f>& places, const std::vector<std::uint32_t>& numbers,
                       float cell)
    : cell_(cell) {
  if (numbers.empty()) return;
  std::vector<std::uint64_t> keys(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) keys[i] = key_of(places[numbers[i]]);
  std::vector<std::uint32_t> order(numbers.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
  std::size_t cells = 0;
  for (std::size_t i = 0; i < order.size(); ++i) cells += i == 0 || keys[order[i]] != keys[order[i - 1]];
  table_.resize(2 * std::bit_ceil(cells));
  points_.reserve(order.size());
  for (std::size_t i = 0; i < order.size();) {
    const std::uint64_t key = keys[order[i]];
    Cell found{key, static_cast<std::uint32_t>(i), 0};
    for (; i < order.size() && keys[order[i]] == key; ++i) {
      const std::uint32_t number = numbers[order[i]];
      points_.push_back({places[number], number});
    }
    found.end = static_cast<std::uint32_t>(i);
    std::size_t slot = slot_of(key);
    while (table_[slot].end != 0) slot = (slot + 1) & (table_.size() - 1);
    table_[slot] = found;
  }
}

}  // namespace reemit

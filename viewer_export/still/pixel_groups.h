#pragma once
#include <cstdint>

#include "solver/gather/point_sampler.h"

namespace reemit {

/// Place of a pixel among those of its square of 64 x 64, in Morton order: every aligned square of 2^k x 2^k
/// of them is a run of numbers, whose points are a net ([AW20] sec. 3).
inline AmongNeighbours place_in_group(std::uint32_t column, std::uint32_t row) {
  constexpr int kLog2Side = 6;
  AmongNeighbours place{(std::uint64_t{row >> kLog2Side} << 32) | (column >> kLog2Side), 0, 2 * kLog2Side};
  for (int bit = 0; bit < kLog2Side; ++bit)
    place.number |= (((column >> bit) & 1U) | ((row >> bit) & 1U) << 1) << (2 * bit);
  return place;
}

}  // namespace reemit

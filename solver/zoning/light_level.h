#pragma once
#include <algorithm>
#include <cmath>

namespace reemit {

/// Logarithm of the light above what counts as dim, in a room of this mean radiance > 0: what sides that
/// share a zone should have in common.
inline double light_level(double radiance, double room_mean) {
  constexpr double kDim = 0.3;
  return std::log1p(std::max(0.0, radiance) / (kDim * room_mean));
}

/// How uneven light of this mean and variance on a cell is: the variance over the square of the room's mean,
/// and over the root of the light on the cell. Differences as such would put nearly all zones where it is
/// brightest, where packets then meet each less; relative ones put them where it is too dark to matter.
inline double unevenness(double mean, double variance, double room_mean) {
  if (!(room_mean > 0)) return 0;
  const double level = 1 + std::max(0.0, mean) / room_mean;
  return std::max(0.0, variance) / (room_mean * room_mean * std::sqrt(level));
}

}  // namespace reemit

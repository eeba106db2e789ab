#pragma once
#include <cstdint>

namespace reemit {

/// Names the random numbers of one path; each bounce takes its own steps of the generator.
struct PathKey {
  std::uint64_t index = 0;  ///< Pixel, vertex or zone.
  std::uint32_t batch = 0;  ///< Pass or replicate.
  std::uint32_t path = 0;   ///< Number of the path within the batch, < kMostPaths.
  std::uint32_t part = 0;   ///< Part of the zone solution that is read, < RadianceField::parts().

  static constexpr std::uint32_t kStepsPerPath = 4096;
  static constexpr std::uint32_t kMostPaths = 1U << 20;
  std::uint32_t step(std::uint32_t number) const { return path * kStepsPerPath + number; }
};

}  // namespace reemit

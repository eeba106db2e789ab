#pragma once
#include <cstdint>

namespace reemit {

/// Names the random numbers of one path; each bounce takes its own steps of the generator.
struct PathKey {
  std::uint64_t index = 0;  ///< Pixel, vertex or zone.
  std::uint32_t batch = 0;  ///< Pass or replicate.
  std::uint32_t path = 0;   ///< Number of the path within the batch, < kMostPaths.
  std::uint32_t part = 0;   ///< Part of the zone solution that is read, < RadianceField::parts().

  /// Added to the index: by paths that are aimed at bright zones from where they begin; by the choice of what
  /// is aimed at further on; times the number of the bounce and one, by paths that are aimed there.
  static constexpr std::uint64_t kOfAimed = std::uint64_t{1} << 42;
  static constexpr std::uint64_t kOfAiming = std::uint64_t{1} << 43;
  static constexpr std::uint64_t kOfAimedBounce = std::uint64_t{1} << 44;
  static constexpr std::uint32_t kStepsPerPath = 4096;
  static constexpr std::uint32_t kMostPaths = 1U << 20;
  std::uint32_t step(std::uint32_t number) const { return path * kStepsPerPath + number; }
};

}  // namespace reemit

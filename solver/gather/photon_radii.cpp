#include "solver/gather/photon_radii.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

namespace reemit {
namespace {

/// Photons of a cell of the grid that are looked at where they only tell how dense they are: beside a lamp
/// there may be very many, on faces that do not count.
constexpr std::uint32_t kMostOfCell = 64;

/// Photons one after the other in order of their places, each of which begins with the radius of the last.
constexpr std::size_t kNeighbours = 64;

constexpr float kCodesPerOctave = 24;

/// The code of the radius that is closest.
std::uint8_t code_of_radius(float radius) {
  const float code = std::round(kCodesPerOctave * std::log2(kLargestPhotonRadius / radius));
  return static_cast<std::uint8_t>(std::clamp(code, 0.0F, 255.0F));
}

std::vector<std::uint32_t> numbers_below(std::size_t end) {
  std::vector<std::uint32_t> numbers(end);
  std::iota(numbers.begin(), numbers.end(), 0U);
  return numbers;
}

}  // namespace

float photon_radius(std::uint8_t code) {
  return kLargestPhotonRadius * std::exp2(-static_cast<float>(code) / kCodesPerOctave);
}

std::size_t level_of_radius(float radius) {
  std::size_t level = 0;
  while (level + 1 < kRadiusLevels && radius_of_level(level + 1) >= radius) ++level;
  return level;
}

PhotonRadii::PhotonRadii(CausticPhotons pilot, float share)
    : pilot_(std::move(pilot)), enough_(share * kPhotonsInRadius) {
  const std::vector<std::uint32_t> all = numbers_below(pilot_.size());
  for (std::size_t level = 0; level < kRadiusLevels; ++level)
    grids_[level] = PhotonGrid(pilot_.places, all, 2 * radius_of_level(level));
}

void PhotonRadii::set(CausticPhotons& photons, const StopToken* stop) const {
  photons.radius_codes.assign(photons.size(), 0);
  std::vector<std::uint32_t> order = numbers_below(photons.size());
  order = PhotonGrid(photons.places, order, 2 * radius_of_level(kRadiusLevels - 1)).numbers();
  tbb::parallel_for(std::size_t{0}, order.size(), kNeighbours, [&](std::size_t begin) {
    std::size_t levels = 0;
    const std::size_t end = std::min(order.size(), begin + kNeighbours);
    for (std::size_t k = begin; k < end; ++k) {
      if (stop != nullptr && stop->requested()) return;
      const std::uint32_t i = order[k];
      photons.radius_codes[i] = code_of_radius(radius_at(photons.normals[i], photons.places[i], levels));
    }
  });
}

float PhotonRadii::radius_at(const Vec3f& normal, const Vec3f& place, std::size_t& levels) const {
  const auto found_within = [&](std::size_t level, float enough) {
    const float radius = radius_of_level(level);
    float found = 0;
    grids_[level].visit_some(place, radius, kMostOfCell, [&](std::uint32_t i, float d2, float scale) {
      if (pilot_.is_on_face(i, normal, place, radius)) found += 2 * scale * (1 - d2 / (radius * radius));
      return found < enough;
    });
    return found;
  };
  const auto is_enough = [&](std::size_t level) { return found_within(level, enough_) >= enough_; };
  const std::size_t before = levels;
  while (levels > 0 && !is_enough(levels - 1)) --levels;
  if (levels == before)
    while (levels < kRadiusLevels && is_enough(levels)) ++levels;
  if (levels == 0) return kLargestPhotonRadius;
  const float found = found_within(levels - 1, std::numeric_limits<float>::infinity());
  return radius_of_level(levels - 1) * std::sqrt(enough_ / found);
}

}  // namespace reemit

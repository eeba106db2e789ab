#include "solver/gather/photon_radii.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

namespace reemit {
namespace {

/// Photons of a cell of the grid that are looked at where they only tell how dense they are: beside a lamp
/// there may be very many, on faces that do not count.
constexpr std::uint32_t kMostOfCell = 64;

/// Neighbours that are looked at one after the other, each of which begins with the radius of the last.
constexpr std::size_t kNeighbours = 64;
/// Photons as near to another on their face as this share of its radius have the same radius: what is dense
/// there is dense here, and the count that says so is good to a sixth.
constexpr float kSameRadius = 0.25F;

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

/// Bits of a number of 21 bits at every third place.
std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

/// Numbers of places in [-1,1]^3 in Morton order, in which those close to each other mostly follow each
/// other.
std::vector<std::uint32_t> in_morton_order(const std::vector<Vec3f>& places) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order(places.size());
  tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      constexpr float kCells = 1 << 20;
      const float cell = std::clamp((places[i][axis] + 1) * (kCells / 2), 0.0F, kCells);
      code |= spread_bits(static_cast<std::uint64_t>(cell)) << axis;
    }
    order[i] = {code, static_cast<std::uint32_t>(i)};
  });
  tbb::parallel_sort(order);
  std::vector<std::uint32_t> numbers;
  for (const auto& [code, number] : order) numbers.push_back(number);
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
  tbb::parallel_for(std::size_t{0}, kRadiusLevels, [&](std::size_t level) {
    grids_[level] = PhotonGrid(pilot_.places, all, 2 * radius_of_level(level));
  });
}

void PhotonRadii::set(std::span<CausticPhotons> parts, const StopToken* stop) const {
  struct Place {
    std::uint32_t part, photon;
  };
  std::vector<Place> all;
  std::vector<Vec3f> places;
  for (std::uint32_t p = 0; p < parts.size(); ++p) {
    parts[p].radius_codes.assign(parts[p].size(), 0);
    places.insert(places.end(), parts[p].places.begin(), parts[p].places.end());
    for (std::uint32_t i = 0; i < parts[p].size(); ++i) all.push_back({p, i});
  }
  const std::vector<std::uint32_t> order = in_morton_order(places);
  const std::size_t blocks = (order.size() + kNeighbours - 1) / kNeighbours;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    struct Known {
      Place at;
      float reach;  // of its radius
      std::uint8_t code;
    };
    std::vector<Known> known;
    std::size_t levels = 0;
    const std::size_t end = std::min(order.size(), (block + 1) * kNeighbours);
    for (std::size_t k = block * kNeighbours; k < end; ++k) {
      if (stop != nullptr && stop->requested()) return;
      const Place at = all[order[k]];
      CausticPhotons& photons = parts[at.part];
      const Vec3f& normal = photons.normals[at.photon];
      const Vec3f& place = photons.places[at.photon];
      const auto found = std::find_if(known.begin(), known.end(), [&](const Known& other) {
        const CausticPhotons& those = parts[other.at.part];
        return (those.places[other.at.photon] - place).squaredNorm() < other.reach * other.reach &&
               those.is_on_face(other.at.photon, normal, place, other.reach);
      });
      if (found == known.end()) {
        const float radius = radius_at(normal, place, levels);
        known.push_back({at, kSameRadius * radius, code_of_radius(radius)});
        photons.radius_codes[at.photon] = known.back().code;
      } else {
        photons.radius_codes[at.photon] = found->code;
      }
    }
  });
}

float PhotonRadii::radius_at(const Vec3f& normal, const Vec3f& place, std::size_t& levels) const {
  const auto found_within = [&](std::size_t level) {
    const float radius = radius_of_level(level);
    float found = 0;
    grids_[level].visit_some(place, radius, kMostOfCell, [&](std::uint32_t i, float d2, float scale) {
      if (pilot_.is_on_face(i, normal, place, radius)) found += 2 * scale * (1 - d2 / (radius * radius));
    });
    return found;
  };
  const std::size_t before = levels;
  float found = 0;  // at the last of the levels
  while (levels > 0 && (found = found_within(levels - 1)) < enough_) --levels;
  for (; levels >= before && levels < kRadiusLevels; ++levels) {
    const float closer = found_within(levels);
    if (closer < enough_) break;
    found = closer;
  }
  return levels == 0 ? kLargestPhotonRadius : radius_of_level(levels - 1) * std::sqrt(enough_ / found);
}

}  // namespace reemit

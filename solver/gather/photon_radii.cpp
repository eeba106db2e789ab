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

/// Bits of a number of 21 bits at every third place.
std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

/// Number of the cell that holds a place in [-1,1]^3; places whose numbers follow each other mostly lie close
/// to each other.
std::uint64_t morton_number(const Vec3f& place) {
  constexpr float kCells = 1 << 20;
  std::uint64_t number = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float cell = std::clamp((place[axis] + 1) * (kCells / 2), 0.0F, kCells);
    number |= spread_bits(static_cast<std::uint64_t>(cell)) << axis;
  }
  return number;
}

}  // namespace

float photon_radius(std::uint8_t code) {
  return kLargestPhotonRadius * std::exp2(-static_cast<float>(code) / kCodesPerOctave);
}

std::array<PhotonGrid, kRadiusLevels> grids_by_radius(const CausticPhotons& photons) {
  std::array<std::vector<std::uint32_t>, kRadiusLevels> of_level;
  for (std::uint32_t i = 0; i < photons.size(); ++i)
    of_level[level_of_radius(photon_radius(photons.radius_codes[i]))].push_back(i);
  std::array<PhotonGrid, kRadiusLevels> grids;
  for (std::size_t level = 0; level < kRadiusLevels; ++level)
    grids[level] = PhotonGrid(photons.places, of_level[level], 2 * radius_of_level(level));
  return grids;
}

std::size_t level_of_radius(float radius) {
  std::size_t level = 0;
  while (level + 1 < kRadiusLevels && radius_of_level(level + 1) >= radius) ++level;
  return level;
}

PhotonRadii::PhotonRadii(CausticPhotons pilot, float share)
    : pilot_(std::move(pilot)), enough_(share * kPhotonsInRadius) {
  std::vector<std::uint32_t> all(pilot_.size());
  std::iota(all.begin(), all.end(), 0U);
  tbb::parallel_for(std::size_t{0}, kRadiusLevels, [&](std::size_t level) {
    grids_[level] = PhotonGrid(pilot_.places, all, 2 * radius_of_level(level));
  });
}

/// Finds the radii of photons that lie close to each other, one after the other.
class PhotonRadii::Neighbours {
 public:
  Neighbours(const PhotonRadii& radii, std::span<const CausticPhotons> parts)
      : radii_(radii), parts_(parts) {}

  std::uint8_t code_of(const Photon& photon) {
    const CausticPhotons::Place place = parts_[photon.part].place(photon.number);
    const auto same = std::find_if(known_.begin(), known_.end(), [&](const Known& known) {
      const CausticPhotons& part = parts_[known.photon.part];
      return (part.places[known.photon.number] - place.at).squaredNorm() < known.reach * known.reach &&
             part.is_on_face(known.photon.number, place, known.reach);
    });
    if (same != known_.end()) return same->code;
    const float radius = radii_.radius_at(place, levels_);
    known_.push_back({photon, kSameRadius * radius, code_of_radius(radius)});
    return known_.back().code;
  }

 private:
  struct Known {
    Photon photon;
    float reach;  // within which others have its radius
    std::uint8_t code;
  };

  const PhotonRadii& radii_;
  std::span<const CausticPhotons> parts_;
  std::size_t levels_ = 0;
  std::vector<Known> known_;
};

void PhotonRadii::set(std::span<CausticPhotons> parts, const StopToken* stop) const {
  std::vector<std::pair<std::uint64_t, Photon>> order;
  for (std::uint32_t p = 0; p < parts.size(); ++p) {
    parts[p].radius_codes.assign(parts[p].size(), 0);
    for (std::uint32_t i = 0; i < parts[p].size(); ++i)
      order.push_back({morton_number(parts[p].places[i]), {p, i}});
  }
  tbb::parallel_sort(order);
  const std::size_t blocks = (order.size() + kNeighbours - 1) / kNeighbours;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    Neighbours neighbours(*this, parts);
    const std::size_t end = std::min(order.size(), (block + 1) * kNeighbours);
    for (std::size_t k = block * kNeighbours; k < end; ++k) {
      if (stop != nullptr && stop->requested()) return;
      const Photon photon = order[k].second;
      parts[photon.part].radius_codes[photon.number] = neighbours.code_of(photon);
    }
  });
}

float PhotonRadii::radius_at(const CausticPhotons::Place& place, std::size_t& levels) const {
  const auto found_within = [&](std::size_t level) {
    const float radius = radius_of_level(level);
    float found = 0;
    grids_[level].visit_some(place.at, radius, kMostOfCell, [&](std::uint32_t i, float d2, float scale) {
      if (pilot_.is_on_face(i, place, radius)) found += 2 * scale * (1 - d2 / (radius * radius));
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

#include "solver/shoot/arrival_points.h"

#include <algorithm>

namespace reemit {
namespace {

/// Points that are kept although a zone then has several: more cost cache misses and change little ...
constexpr std::size_t kEnoughPoints = 16'384;
/// ... unless very many packets would share one.
constexpr std::size_t kMostSharing = 8;
constexpr std::uint32_t kSweepNumbers = 255;
constexpr int kSweepShift = 56;

}  // namespace

ArrivalPoints::ArrivalPoints(std::size_t zones, std::uint32_t packets) {
  zones = std::max<std::size_t>(1, zones);
  const std::size_t enough = std::max<std::size_t>(kEnoughPoints, packets / kMostSharing) / zones;
  per_zone_ = std::max<std::size_t>(1, std::min<std::size_t>(enough, packets / zones));
  written_.resize(zones * per_zone_);
  read_.resize(zones * per_zone_);
}

void ArrivalPoints::begin(std::uint32_t sweep) {
  std::swap(written_, read_);
  read_key_ = sweep_key_;
  const std::uint64_t number = sweep % kSweepNumbers + 1;
  sweep_key_ = number << kSweepShift;
  // Where the numbers start again, what stands in the table would look newer than what comes. It holds the
  // sweep before last, which nobody reads any more.
  if (sweep >= kSweepNumbers && number <= 2) std::fill(written_.begin(), written_.end(), 0);
}

}  // namespace reemit

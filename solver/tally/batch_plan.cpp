#include "solver/tally/batch_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/solution/solution.h"

namespace reemit {
namespace {

/// Unit of packets by default: large enough that what a batch costs beside its rays, which is work for every
/// zone, is the smaller part.
std::uint64_t default_unit(std::size_t zones) {
  constexpr std::uint64_t kSmallest = 65536;
  constexpr std::size_t kZonesPerPacket = 4;
  return std::max<std::uint64_t>(kSmallest, zones / kZonesPerPacket);
}
/// Packets per zone in a batch that has grown up. Each sweep looks at all zones with power: fewer packets
/// make that the larger part of the work.
constexpr std::uint64_t kPacketsPerZone = 16;
/// Packets of a batch for each batch of the run. Shooting scales every band to its exact sum, so a batch is a
/// ratio estimate, biased by about (variance of colours)/packets; its noise is sqrt(variance/packets). With
/// as many packets for each of n batches the bias of the mean is an eighth of its noise at most.
constexpr double kPacketsPerBatch = 64;
/// Batches after which they grow in any case, such that each is at most so small a part of what is done. The
/// sums of batch groups are of single precision: what is added must not drown in their rounding. So a run of
/// 10^12 packets in a small room has 10^5 batches instead of 10^7, none of which costs much if cut off.
constexpr std::int64_t kManyBatches = 1 << 14;
/// Up to this size, at which a batch takes no more memory than those of large rooms do: it keeps points and
/// packets that wait. 2^42 quanta leave each packet 2^18, whose rounding at a hit is no bias to speak of.
constexpr std::uint64_t kMostGrownPackets = std::uint64_t{1} << 24;
/// The number of a batch has 32 bits.
constexpr std::int64_t kMostBatches = std::numeric_limits<std::uint32_t>::max();
constexpr std::int64_t kRound = static_cast<std::int64_t>(ZoneSums::kGroups);

}  // namespace

BatchPlan::BatchPlan(const SolverSettings& settings, std::size_t zones, std::uint64_t unit_packets) {
  std::uint64_t unit = default_unit(zones);
  if (settings.batch_packets > 0) {
    unit = settings.batch_packets;
    goes_on_growing_ = false;
    if (settings.packets > 0)
      weight_of_packets_ = static_cast<std::int64_t>(std::max<std::uint64_t>(1, settings.packets / unit));
  } else {
    largest_weight_ = static_cast<std::int64_t>((kPacketsPerZone * zones + unit - 1) / unit);
    if (settings.packets > 0) {
      const double unbiased = std::sqrt(static_cast<double>(settings.packets) / kPacketsPerBatch);
      const double least =
          std::min<double>(std::max(2, settings.smallest_batch_count), std::max(2.0, unbiased));
      const std::uint64_t units =
          std::max(static_cast<std::uint64_t>(least), (settings.packets + unit - 1) / unit);
      weight_of_packets_ = static_cast<std::int64_t>(std::min(units, settings.packets));
      unit = settings.packets / static_cast<std::uint64_t>(weight_of_packets_);
    }
  }
  if (unit_packets > 0 && unit_packets != unit) {
    unit = std::min(unit_packets, kMostBatchPackets);
    if (settings.packets > 0)
      weight_of_packets_ = static_cast<std::int64_t>(std::max<std::uint64_t>(settings.packets / unit, 1));
  }
  unit_packets_ = static_cast<std::uint32_t>(std::max<std::uint64_t>(unit, 1));
  const auto most = static_cast<std::int64_t>(kMostBatchPackets / unit_packets_);
  largest_weight_ = std::clamp<std::int64_t>(largest_weight_, 1, most);
}

std::int64_t BatchPlan::next_weight(std::int64_t batches, std::int64_t done) const {
  if (batches >= kMostBatches) return 0;
  const std::int64_t most_grown =
      goes_on_growing_ ? static_cast<std::int64_t>(kMostGrownPackets / unit_packets_) : 0;
  const std::int64_t most = std::max(largest_weight_, most_grown);
  std::int64_t weight = 1;
  std::int64_t before = 0;  // weight of all rounds before the one that this batch is in
  for (std::int64_t rounds = batches / kRound; rounds > 0 && weight < most;) {
    std::int64_t alike = 1;  // rounds of this weight
    if (weight >= largest_weight_) {
      const std::int64_t until = (weight + 1) * kManyBatches - before;
      alike = std::clamp<std::int64_t>((until - 1) / (kRound * weight) + 1, 1, rounds);
    }
    rounds -= alike;
    before += alike * kRound * weight;
    const std::int64_t as_planned = std::clamp<std::int64_t>(before / kRound, 1, largest_weight_);
    weight = std::max(as_planned, std::min(before / kManyBatches, most_grown));
  }
  return weight_of_packets_ > 0 ? std::clamp<std::int64_t>(weight_of_packets_ - done, 0, weight) : weight;
}

}  // namespace reemit

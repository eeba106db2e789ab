#include "solver/shoot/arrival_points.h"

#include <algorithm>
#include <cstring>

#include "scenes/model/instruction_sets.h"
#include "solver/sampling/split_mix.h"

namespace reemit {
namespace {

/// Points that are kept although a zone then has several: more cost cache misses and change little ...
constexpr std::size_t kEnoughPoints = 16'384;
/// ... unless very many packets would share one.
constexpr std::size_t kMostSharing = 8;
constexpr std::uint32_t kSweepNumbers = 255;
constexpr int kSweepShift = 56;
/// Lowest rank of a packet, and how often one counts at most.
constexpr std::int32_t kMostMissed = 15;
constexpr float kMostRepeats = 0x1p20F;

}  // namespace

ArrivalPoints::ArrivalPoints(const ZoneMesh& mesh, std::uint32_t packets) : mesh_(&mesh) {
  const std::size_t zones = std::max<std::size_t>(1, mesh.zone_count());
  const std::size_t enough = std::max<std::size_t>(kEnoughPoints, packets / kMostSharing) / zones;
  per_zone_ = std::max<std::size_t>(1, std::min<std::size_t>(enough, packets / zones));
  written_.resize(zones * per_zone_);
  read_.resize(zones * per_zone_);
  all_have_points_ = true;
  for (std::size_t z = mesh.cell_zone_count(); z < mesh.zone_count(); ++z)
    all_have_points_ = all_have_points_ && mesh.member_count(ZoneId(z)) <= kFractions;
}

void ArrivalPoints::begin(std::uint32_t sweep, double mean_power, std::uint64_t random) {
  over_mean_ = static_cast<float>(1 / mean_power);
  std::swap(written_, read_);
  read_key_ = sweep_key_;
  read_mask_ = sweep_mask_;
  sweep_mask_ = random & ((std::uint64_t{1} << kPointBits) - 1);
  const std::uint64_t number = sweep % kSweepNumbers + 1;
  sweep_key_ = number << kSweepShift;
  // Where the numbers start again, what stands in the table would look newer than what comes. It holds the
  // sweep before last, which nobody reads any more.
  if (sweep >= kSweepNumbers && number <= 2) std::fill(written_.begin(), written_.end(), 0);
}

REEMIT_FOR_INSTRUCTION_SETS
void ArrivalPoints::find16(const TrianglePoints16& __restrict points, const std::uint32_t* __restrict zones,
                           const float* __restrict power, const std::uint32_t (*__restrict random)[16],
                           ArrivalLanes& __restrict arrived) const {
  const auto first_group = static_cast<std::uint32_t>(mesh_->cell_zone_count());
  const std::uint64_t per_zone = per_zone_;
  const std::uint64_t sweep_key = sweep_key_;
  const std::uint64_t mask = sweep_mask_;
  const float over_mean = over_mean_;
  alignas(64) std::uint32_t u[16];
  alignas(64) std::uint32_t v[16];
  alignas(64) std::uint32_t in_parts[16];
  alignas(64) std::uint32_t rank[16];
  std::uint32_t any_group = 0;
  for (int lane = 0; lane < 16; ++lane) {
    const bool in_group = (zones[lane] >= first_group) & (zones[lane] != ZoneMesh::kNone);
    any_group |= in_group ? 1U : 0U;
    const std::int32_t parts = in_group ? std::int32_t{kMemberFractions} : std::int32_t{kFractions};
    const auto i = static_cast<std::int32_t>(points.u[lane] * static_cast<float>(parts));
    const auto j = static_cast<std::int32_t>(points.v[lane] * static_cast<float>(parts));
    u[lane] = static_cast<std::uint32_t>(i < 0 ? 0 : i > parts - 1 ? parts - 1 : i);
    v[lane] = static_cast<std::uint32_t>(j < 0 ? 0 : j > parts - 1 ? parts - 1 : j);
    in_parts[lane] = static_cast<std::uint32_t>(parts);
  }
  alignas(64) float missed_by[16];
  alignas(64) std::int32_t counts[16];
  for (int lane = 0; lane < 16; ++lane) {
    const float chance = static_cast<float>(static_cast<std::int32_t>(random[1][lane] >> 8)) * 0x1p-24F;
    // Stronger packets count several times, the remainder by chance.
    const float worth = power[lane] * over_mean;
    const float at_most = worth < kMostRepeats ? worth : kMostRepeats;
    const auto whole = static_cast<std::int32_t>(at_most);
    const std::int32_t one_more = chance < at_most - static_cast<float>(whole) ? 1 : 0;
    counts[lane] = whole + one_more;
    missed_by[lane] = chance / worth;
  }
  alignas(64) std::int32_t missed_bits[16];
  std::memcpy(missed_bits, missed_by, sizeof missed_by);
  for (int lane = 0; lane < 16; ++lane) {
    // Weaker ones count with odds of their power, else by how far they missed it, in powers of two.
    const std::int32_t missed = (missed_bits[lane] >> 23 & 0xff) - 126;
    const std::int32_t below = missed > kMostMissed ? kMostMissed : missed;
    rank[lane] = static_cast<std::uint32_t>(counts[lane] > 0 ? kMostMissed : kMostMissed - below);
    arrived.repeats[lane] = static_cast<std::uint32_t>(counts[lane] > 1 ? counts[lane] - 1 : 0);
  }
  for (int lane = 0; lane < 16; ++lane) {
    const std::uint64_t zone = zones[lane] == ZoneMesh::kNone ? 0 : zones[lane];
    arrived.place[lane] = zone * per_zone + (std::uint64_t{random[0][lane]} * per_zone >> 32);
    arrived.key[lane] = sweep_key | rank[lane] * kLeastOfRank |
                        (random[0][lane] & kMostRandom) << kPointBits |
                        ((std::uint64_t{u[lane]} * in_parts[lane] | v[lane]) ^ mask);
  }
  for (int lane = 0; any_group != 0 && lane < 16; ++lane) {
    if (in_parts[lane] != kMemberFractions) continue;
    const std::uint64_t member = mesh_->member(TriangleId(points.triangle[lane]), points.front[lane]);
    const bool has = has_points(ZoneId(zones[lane]));
    arrived.key[lane] = has ? arrived.key[lane] ^ member << kFractionBits : 0;
    arrived.repeats[lane] = has ? arrived.repeats[lane] : 0;
  }
}

void ArrivalPoints::repeat(std::uint64_t place, std::uint64_t key, std::uint32_t times) {
  const std::uint64_t first = place / per_zone_ * per_zone_;
  const std::uint64_t without_random = key & ~(kMostRandom << kPointBits);
  // One packet's own numbers, which need not be better than that.
  SplitMix numbers(key ^ (place << 17));
  for (std::uint32_t i = 0; i < times; ++i) {
    const std::uint64_t x = numbers.next();
    put(first + ((x >> 32) * per_zone_ >> 32), without_random | (x & kMostRandom) << kPointBits);
  }
}

}  // namespace reemit

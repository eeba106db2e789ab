#include "solver/shoot/arrival_points.h"

#include <algorithm>

#include "scenes/model/instruction_sets.h"

namespace reemit {
namespace {

/// Points that are kept although a zone then has several: more cost cache misses and change little ...
constexpr std::size_t kEnoughPoints = 16'384;
/// ... unless very many packets would share one.
constexpr std::size_t kMostSharing = 8;
constexpr std::uint32_t kSweepNumbers = 255;
constexpr int kSweepShift = 56;

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

void ArrivalPoints::begin(std::uint32_t sweep) {
  std::swap(written_, read_);
  read_key_ = sweep_key_;
  const std::uint64_t number = sweep % kSweepNumbers + 1;
  sweep_key_ = number << kSweepShift;
  // Where the numbers start again, what stands in the table would look newer than what comes. It holds the
  // sweep before last, which nobody reads any more.
  if (sweep >= kSweepNumbers && number <= 2) std::fill(written_.begin(), written_.end(), 0);
}

REEMIT_FOR_INSTRUCTION_SETS
void ArrivalPoints::find16(const TrianglePoints16& __restrict points, const std::uint32_t* __restrict zones,
                           const std::uint32_t* __restrict bits, ArrivalLanes& __restrict arrived) const {
  const auto first_group = static_cast<std::uint32_t>(mesh_->cell_zone_count());
  const std::uint64_t per_zone = per_zone_;
  const std::uint64_t sweep_key = sweep_key_;
  alignas(64) std::uint32_t u[16];
  alignas(64) std::uint32_t v[16];
  alignas(64) std::uint32_t in_parts[16];
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
  for (int lane = 0; lane < 16; ++lane) {
    const std::uint64_t zone = zones[lane] == ZoneMesh::kNone ? 0 : zones[lane];
    arrived.place[lane] = zone * per_zone + (std::uint64_t{bits[lane]} * per_zone >> 32);
    arrived.key[lane] = sweep_key | std::uint64_t{bits[lane] & 0xffffU} << 40 |
                        std::uint64_t{u[lane]} * in_parts[lane] | v[lane];
  }
  for (int lane = 0; any_group != 0 && lane < 16; ++lane) {
    if (in_parts[lane] != kMemberFractions) continue;
    const std::uint64_t member = mesh_->member(TriangleId(points.triangle[lane]), points.front[lane]);
    arrived.key[lane] = has_points(ZoneId(zones[lane])) ? arrived.key[lane] | member << 20 : 0;
  }
}

}  // namespace reemit

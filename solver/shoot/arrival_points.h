#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/zones/zone_mesh.h"

namespace reemit {

/// (u,v) of a point of a base triangle.
struct BarycentricPoint {
  float u, v;
};
/// The same of a member of a group of sides.
struct MemberPoint {
  std::uint32_t member;
  float u, v;
};

/// Where 16 packets met zones (ArrivalPoints::find16).
struct alignas(64) ArrivalLanes {
  std::uint64_t place[16];    ///< That the packet competes for.
  std::uint64_t key[16];      ///< What it would write there.
  std::uint32_t repeats[16];  ///< How many further places it competes for, since it carries much.
};

/// Where the packets of a sweep met the zones: up to a few points of each, chosen by chance, whichever thread
/// brings them, with odds in proportion to the power that packets carry, all channels together. In the next
/// sweep the zone's packets leave from them, so that light stays in the part of the zone that it fell on.
/// Points are rounded to 2^-18 of their base triangle, in groups, whose triangles are small, to 2^-9.
///
/// Packets are made alike: one with w times the mean power competes as w packets would, on the mean, and
/// whole ones go before those that chance has left out. Of a zone that only such have met, the weakest of the
/// mean are thinned out by factors of two until some are left, so that the odds hold among them too.
class ArrivalPoints {
 public:
  /// One point per zone, or more where there are few zones and many `packets`. The mesh must outlive it.
  ArrivalPoints(const ZoneMesh& mesh, std::uint32_t packets);

  /// Groups of very many sides have none: packets leave them from anywhere.
  bool has_points(ZoneId zone) const {
    return all_have_points_ || !mesh_->is_group(zone) || mesh_->member_count(zone) <= kFractions;
  }

  /// Points added from here on belong to `sweep`; those of the sweep before can be read. Sweeps count from 0.
  /// `mean_power` > 0: of its packets, in any unit; `random`: bits of its own, which decide where two packets
  /// have drawn the same number.
  void begin(std::uint32_t sweep, double mean_power, std::uint64_t random);

  /// What 16 packets would write where that met the zones at points of their base triangles; `power`: of
  /// each, in the unit of the mean; `random`: two numbers of 32 bits of each. Nothing of use where a zone is
  /// ZoneMesh::kNone or has no points.
  void find16(const TrianglePoints16& points, const std::uint32_t* zones, const float* power,
              const std::uint32_t (*random)[16], ArrivalLanes& arrived) const;
  /// Asks for the memory that `add` will look at, before it is needed.
  void ask_for(const ArrivalLanes& arrived, int lane) const {
    __builtin_prefetch(&written_[arrived.place[lane]], 1);
  }
  /// Adds the packet of a lane. Any thread.
  void add(const ArrivalLanes& arrived, int lane) {
    put(arrived.place[lane], arrived.key[lane]);
    if (arrived.repeats[lane] > 0) repeat(arrived.place[lane], arrived.key[lane], arrived.repeats[lane]);
  }

  /// The points of the sweep before in one zone, dealt out evenly to the packets that it sends.
  class Dealer {
   public:
    Dealer() = default;
    /// Where packet k leaves; none if nothing arrived in the zone.
    std::optional<BarycentricPoint> point(std::uint32_t k) const {
      const std::uint64_t key = this->key(k);
      if (key == 0) return std::nullopt;
      return BarycentricPoint{coordinate(key >> kFractionBits, kFractions), coordinate(key, kFractions)};
    }
    /// The same for a zone that is a group.
    std::optional<MemberPoint> point_in_group(std::uint32_t k) const {
      const std::uint64_t key = this->key(k);
      if (key == 0) return std::nullopt;
      return MemberPoint{static_cast<std::uint32_t>(key >> kFractionBits & (kFractions - 1)),
                         coordinate(key >> kMemberBits, kMemberFractions), coordinate(key, kMemberFractions)};
    }

   private:
    /// 0 if nothing arrived in the zone.
    std::uint64_t key(std::uint32_t k) const {
      const auto first = static_cast<std::size_t>(k * step_ >> 32);
      for (std::size_t i = 0; i < count_; ++i) {
        const std::uint64_t key = own_[first + i < count_ ? first + i : first + i - count_];
        if (key >= least_) return key ^ mask_;
      }
      return 0;
    }
    friend class ArrivalPoints;
    Dealer(std::span<const std::uint64_t> own, std::uint64_t oldest, std::uint64_t mask,
           std::uint32_t packets)
        : own_(own.data()),
          count_(own.size()),
          least_(oldest),
          mask_(mask),
          step_((std::uint64_t{count_} << 32) / packets) {
      for (const std::uint64_t key : own) least_ = std::max(least_, key & ~(kLeastOfRank - 1));
    }
    const std::uint64_t* own_ = nullptr;
    std::size_t count_ = 0;
    std::uint64_t least_ = 0;  // key of the zone's best rank
    std::uint64_t mask_ = 0;
    std::uint64_t step_ = 0;  // places from one packet to the next, in fixed point
  };
  /// `packets` > 0: how many the zone sends.
  Dealer deal(ZoneId zone, std::uint32_t packets) const {
    return {std::span(read_).subspan(zone.index() * per_zone_, per_zone_), read_key_, read_mask_, packets};
  }

 private:
  // A key, from its highest bit: 8 of the sweep, so that its points hide older ones; 4 of the rank; 16 random
  // ones, of which the largest wins; 36 of the point, under a mask.
  static constexpr int kFractionBits = 18;
  static constexpr int kMemberBits = 9;
  static constexpr int kPointBits = 2 * kFractionBits;
  static constexpr std::uint32_t kFractions = 1U << kFractionBits;
  static constexpr std::uint32_t kMemberFractions = 1U << kMemberBits;
  static constexpr int kRandomBits = 16;
  static constexpr std::uint64_t kMostRandom = (std::uint64_t{1} << kRandomBits) - 1;
  static constexpr std::uint64_t kLeastOfRank = std::uint64_t{1} << (kPointBits + kRandomBits);
  static float coordinate(std::uint64_t low_bits, std::uint32_t parts) {
    return 1.0F / static_cast<float>(parts) * static_cast<float>(low_bits & (parts - 1));
  }
  /// The order of the keys decides, not that of the threads.
  void put(std::uint64_t place, std::uint64_t key) {
    const std::atomic_ref<std::uint64_t> slot(written_[place]);
    std::uint64_t seen = slot.load(std::memory_order_relaxed);
    while (seen < key && !slot.compare_exchange_weak(seen, key, std::memory_order_relaxed)) {
    }
  }
  /// The same at more places of its zone, with other random numbers.
  void repeat(std::uint64_t place, std::uint64_t key, std::uint32_t times);

  const ZoneMesh* mesh_;
  bool all_have_points_;
  std::size_t per_zone_;
  std::vector<std::uint64_t> written_;  // [zone * per_zone + place], of this sweep
  std::vector<std::uint64_t> read_;     // of the sweep before
  std::uint64_t sweep_key_ = 0;         // highest bits of every key of this sweep
  std::uint64_t read_key_ = 0;          // of the sweep before
  std::uint64_t sweep_mask_ = 0;  // of points, so that no part of a zone wins where numbers are the same
  std::uint64_t read_mask_ = 0;
  float over_mean_ = 1;  // of power
};

}  // namespace reemit

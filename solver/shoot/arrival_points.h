#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>
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
  std::uint64_t place[16];  ///< That the packet competes for.
  std::uint64_t key[16];    ///< What it would write there.
};

/// Where the packets of a sweep met the zones: up to a few points of each, chosen by chance with equal odds
/// for every packet, whichever thread brings it. In the next sweep the zone's packets leave from them, so
/// that light stays in the part of the zone that it fell on. Points are rounded to 2^-20 of their base
/// triangle, in groups, whose triangles are small, to 2^-10.
class ArrivalPoints {
 public:
  /// One point per zone, or more where there are few zones and many `packets`. The mesh must outlive it.
  ArrivalPoints(const ZoneMesh& mesh, std::uint32_t packets);

  /// Groups of very many sides have none: packets leave them from anywhere.
  bool has_points(ZoneId zone) const {
    return all_have_points_ || !mesh_->is_group(zone) || mesh_->member_count(zone) <= kFractions;
  }

  /// Points added from here on belong to `sweep`; those of the sweep before can be read. Sweeps count from 0.
  void begin(std::uint32_t sweep);

  /// What 16 packets would write where that met the zones at points of their base triangles; `bits` are 32
  /// random ones of each packet. Nothing of use where a zone is ZoneMesh::kNone or has no points.
  void find16(const TrianglePoints16& points, const std::uint32_t* zones, const std::uint32_t* bits,
              ArrivalLanes& arrived) const;
  /// Asks for the memory that `add` will look at, before it is needed.
  void ask_for(const ArrivalLanes& arrived, int lane) const {
    __builtin_prefetch(&written_[arrived.place[lane]], 1);
  }
  /// Adds the packet of a lane. Any thread.
  void add(const ArrivalLanes& arrived, int lane) {
    const std::atomic_ref<std::uint64_t> slot(written_[arrived.place[lane]]);
    // The order of the keys decides, not that of the threads: a sweep's points hide older ones, and among
    // themselves the largest random number wins.
    const std::uint64_t key = arrived.key[lane];
    std::uint64_t seen = slot.load(std::memory_order_relaxed);
    while (seen < key && !slot.compare_exchange_weak(seen, key, std::memory_order_relaxed)) {
    }
  }

  /// The points of the sweep before in one zone, dealt out evenly to the packets that it sends.
  class Dealer {
   public:
    Dealer() = default;
    /// Where packet k leaves; none if nothing arrived in the zone.
    std::optional<BarycentricPoint> point(std::uint32_t k) const {
      const std::uint64_t key = this->key(k);
      if (key == 0) return std::nullopt;
      return BarycentricPoint{coordinate(key >> 20, kFractions), coordinate(key, kFractions)};
    }
    /// The same for a zone that is a group.
    std::optional<MemberPoint> point_in_group(std::uint32_t k) const {
      const std::uint64_t key = this->key(k);
      if (key == 0) return std::nullopt;
      return MemberPoint{static_cast<std::uint32_t>(key >> 20 & (kFractions - 1)),
                         coordinate(key >> 10, kMemberFractions), coordinate(key, kMemberFractions)};
    }

   private:
    /// 0 if nothing arrived in the zone.
    std::uint64_t key(std::uint32_t k) const {
      const auto first = static_cast<std::size_t>(k * step_ >> 32);
      for (std::size_t i = 0; i < count_; ++i) {
        const std::uint64_t key = own_[first + i < count_ ? first + i : first + i - count_];
        if (key >= oldest_) return key;
      }
      return 0;
    }
    friend class ArrivalPoints;
    Dealer(const std::uint64_t* own, std::size_t count, std::uint64_t oldest, std::uint32_t packets)
        : own_(own), count_(count), oldest_(oldest), step_((std::uint64_t{count} << 32) / packets) {}
    const std::uint64_t* own_ = nullptr;
    std::size_t count_ = 0;
    std::uint64_t oldest_ = 0;
    std::uint64_t step_ = 0;  // places from one packet to the next, in fixed point
  };
  /// `packets` > 0: how many the zone sends.
  Dealer deal(ZoneId zone, std::uint32_t packets) const {
    return {&read_[zone.index() * per_zone_], per_zone_, read_key_, packets};
  }

 private:
  static constexpr std::uint32_t kFractions = 1U << 20;
  static constexpr std::uint32_t kMemberFractions = 1U << 10;
  static float coordinate(std::uint64_t low_bits, std::uint32_t parts) {
    return 1.0F / static_cast<float>(parts) * static_cast<float>(low_bits & (parts - 1));
  }
  const ZoneMesh* mesh_;
  bool all_have_points_;
  std::size_t per_zone_;
  std::vector<std::uint64_t> written_;  // [zone * per_zone + place], of this sweep
  std::vector<std::uint64_t> read_;     // of the sweep before
  std::uint64_t sweep_key_ = 0;         // highest bits of every key of this sweep
  std::uint64_t read_key_ = 0;          // of the sweep before
};

}  // namespace reemit

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

/// Where the packets of a sweep met the zones: up to a few points of each, chosen by chance with equal odds
/// for every packet, whichever thread brings it. In the next sweep the zone's packets leave from them, so
/// that light stays in the part of the zone that it fell on. Points are rounded to 2^-20 of their base
/// triangle, in groups, whose triangles are small, to 2^-10.
class ArrivalPoints {
 public:
  /// One point per zone, or more where there are few zones and many `packets`.
  ArrivalPoints(std::size_t zones, std::uint32_t packets);

  /// Groups of very many sides have none: packets leave them from anywhere.
  static bool has_points(const ZoneMesh& mesh, ZoneId zone) {
    return !mesh.is_group(zone) || mesh.member_count(zone) <= kFractions;
  }

  /// Points added from here on belong to `sweep`; those of the sweep before can be read. Sweeps count from 0.
  void begin(std::uint32_t sweep);

  /// Which of a zone's places a packet competes for; `bits` are 32 random ones of this packet.
  std::uint64_t* place(ZoneId zone, std::uint32_t bits) {
    return &written_[zone.index() * per_zone_ + (std::uint64_t{bits} * per_zone_ >> 32)];
  }
  /// The packet met the zone at (u,v) of its base triangle. Any thread.
  void add(std::uint64_t* place, std::uint32_t bits, float u, float v) const {
    put(place, bits, std::uint64_t{fraction(u, kFractions)} << 20 | fraction(v, kFractions));
  }
  /// The packet met a member of a group there.
  void add_in_group(std::uint64_t* place, std::uint32_t bits, std::uint32_t member, float u, float v) const {
    put(place, bits,
        std::uint64_t{member} << 20 | std::uint64_t{fraction(u, kMemberFractions)} << 10 |
            fraction(v, kMemberFractions));
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
  static std::uint32_t fraction(float x, std::uint32_t parts) {
    return static_cast<std::uint32_t>(
        std::clamp(x * static_cast<float>(parts), 0.0F, static_cast<float>(parts - 1)));
  }
  static float coordinate(std::uint64_t low_bits, std::uint32_t parts) {
    return 1.0F / static_cast<float>(parts) * static_cast<float>(low_bits & (parts - 1));
  }
  void put(std::uint64_t* place, std::uint32_t bits, std::uint64_t point) const {
    const std::atomic_ref<std::uint64_t> slot(*place);
    // The order of the keys decides, not that of the threads: a sweep's points hide older ones, and among
    // themselves the largest random number wins.
    const std::uint64_t key = sweep_key_ | std::uint64_t{bits & 0xffffU} << 40 | point;
    std::uint64_t seen = slot.load(std::memory_order_relaxed);
    while (seen < key && !slot.compare_exchange_weak(seen, key, std::memory_order_relaxed)) {
    }
  }

  std::size_t per_zone_;
  std::vector<std::uint64_t> written_;  // [zone * per_zone + place], of this sweep
  std::vector<std::uint64_t> read_;     // of the sweep before
  std::uint64_t sweep_key_ = 0;         // highest bits of every key of this sweep
  std::uint64_t read_key_ = 0;          // of the sweep before
};

}  // namespace reemit

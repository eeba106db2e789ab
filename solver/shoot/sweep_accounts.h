#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

namespace reemit {

/// What zones have caught in a sweep and have yet to send on, in quanta, indexed zone * bands + band. Late
/// sweeps have few packets, so zones are grouped in blocks, and blocks without power are passed over.
struct SweepAccounts {
  static constexpr std::size_t kBlockZones = 64;

  SweepAccounts(std::size_t zone_count, std::size_t band_count)
      : zones(zone_count),
        bands(band_count),
        incident(zones * bands),
        unshot(zones * bands),
        live((zones + kBlockZones - 1) / kBlockZones) {}

  /// Notes that a zone's accounts are no longer 0. May be called from any thread.
  void touch(std::size_t zone) {
    std::atomic_ref<std::uint8_t>(live[zone / kBlockZones]).store(1, std::memory_order_relaxed);
  }
  std::size_t block_count() const { return live.size(); }
  std::size_t block_begin(std::size_t block) const { return block * kBlockZones; }
  std::size_t block_end(std::size_t block) const { return std::min(zones, (block + 1) * kBlockZones); }

  std::size_t zones;
  std::size_t bands;
  std::vector<std::int64_t> incident;
  std::vector<std::int64_t> unshot;
  std::vector<std::uint8_t> live;  ///< By block: 0 only if all its accounts are 0.
};

}  // namespace reemit

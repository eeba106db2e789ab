#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include <tbb/task_arena.h>

#include "solver/tally/batch_books.h"

namespace reemit {

/// What zones have caught in a sweep and have yet to send on, in quanta, indexed [zone * values +
/// channel]. Late sweeps have few packets, so zones are grouped in blocks, and blocks without power are
/// passed over.
struct SweepAccounts {
  static constexpr std::size_t kBlockZones = 64;

  /// `counts_packets`: what zones send on is to be carried by as many packets as brought it.
  SweepAccounts(std::size_t zone_count, Channels channels, bool counts_packets = false)
      : zones(zone_count),
        values(channels.count()),
        incident(account_copies(zones * values), Incident(zones * values, counts_packets ? zones : 0,
                                                          (zones + kBlockZones - 1) / kBlockZones)),
        unshot(zones * values),
        arrived(counts_packets ? zones : 0),
        live((zones + kBlockZones - 1) / kBlockZones) {}

  /// Incident power booked by one thread, or by all of them if there is one copy only.
  struct Incident {
    Incident(std::size_t accounts, std::size_t counted_zones, std::size_t blocks)
        : quanta(accounts), packets(counted_zones), live(blocks) {}
    std::vector<std::int64_t> quanta;
    std::vector<std::int64_t> packets;  // by zone, how many came; empty unless they are counted
    std::vector<std::uint8_t> live;     // by block: 0 only if all its quanta are 0

    /// Notes that a zone's account is no longer 0. Looks before it writes, so that threads do not fight for
    /// the line.
    void touch(std::size_t zone) {
      const std::atomic_ref<std::uint8_t> flag(live[zone / kBlockZones]);
      if (flag.load(std::memory_order_relaxed) == 0) flag.store(1, std::memory_order_relaxed);
    }
  };
  /// The copy that the calling thread books into.
  Incident& mine() { return incident.size() == 1 ? incident[0] : incident[current_copy()]; }

  std::size_t block_count() const { return live.size(); }
  std::size_t block_begin(std::size_t block) const { return block * kBlockZones; }
  std::size_t block_end(std::size_t block) const { return std::min(zones, (block + 1) * kBlockZones); }

  std::size_t zones;
  std::size_t values;  ///< Of each zone.
  std::vector<Incident> incident;
  std::vector<std::int64_t> unshot;
  /// What brought the unshot power of a zone.
  struct Arrived {
    std::int64_t packets = 0;
    std::int64_t power = 0;  ///< Of them, all channels together.
  };
  std::vector<Arrived> arrived;    ///< By zone; empty unless packets are counted.
  std::vector<std::uint8_t> live;  ///< By block: 0 only if all its unshot power is 0.
};

}  // namespace reemit

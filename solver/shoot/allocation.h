#pragma once
#include <cstdint>
#include <vector>

#include "solver/shoot/flight.h"
#include "solver/shoot/sweep_accounts.h"
#include "solver/tally/batch_books.h"

namespace reemit {

/// Chooses which zones re-emit and with how much: systematic sampling along the cumulative unshot power. A
/// zone with power for a packet or more shoots exactly what it has. Of the others the chosen ones take over
/// the power of those passed over, channel by channel in equal proportion, so the sum is kept to the quantum;
/// what changes hands is recorded as roulette gain and loss, which cancel. Results do not depend on the
/// number of threads.
class Allocation {
 public:
  /// `needs`: by zone, how many packets its power is to have over that of others (PacketRoom::needs), which
  /// the sums below count it by; empty: all alike.
  Allocation(std::size_t zones, Channels channels, const std::vector<std::uint8_t>& needs = {});

  /// Sum of the unshot power, to be called before each plan().
  std::int64_t measure(const SweepAccounts& accounts);

  /// Moves unshot power into `flight`: about measure()/quantum packets, at the random `offset` in [0,1).
  void plan(SweepAccounts& accounts, double quantum, double offset, Flight& flight, BatchBooks& books);

 private:
  struct Chosen {
    std::uint32_t zone;
    std::uint32_t packets;
    double growth;  // how much a small zone's power should grow; 0: it shoots exactly its own
  };
  /// Consecutive zones that one thread looks at.
  struct Chunk {
    std::int64_t power = 0;   // of all channels
    std::int64_t before = 0;  // power of all chunks before this one
    std::vector<Chosen> chosen;
    std::vector<std::int64_t> small_total;  // power of all small zones per channel
    std::vector<double> small_wanted;       // power of the chosen small zones after growth, per channel
  };
  static constexpr std::size_t kChunkBlocks = 64;

  template <class Visit>
  static void for_live_blocks(std::size_t chunk, const SweepAccounts& accounts, const Visit& visit);
  void choose(std::size_t chunk, const SweepAccounts& accounts, double quantum, double offset);
  bool hand_over(std::vector<std::int64_t>& unshot, std::size_t channel, Flight& flight,
                 BatchBooks& books) const;
  void drop_passed_over(SweepAccounts& accounts, const std::vector<bool>& exchanged, BatchBooks& books) const;

  std::int64_t need(std::size_t zone) const { return needs_.empty() ? 1 : needs_[zone]; }

  std::size_t values_;  // of each zone
  std::vector<std::uint8_t> needs_;
  std::vector<Chunk> chunks_;
};

}  // namespace reemit

#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "solver/shoot/flight.h"
#include "solver/shoot/sweep_accounts.h"
#include "solver/tally/batch_books.h"

namespace reemit {

/// Chooses which zones re-emit and with how much: systematic sampling along the cumulative unshot power. A
/// zone with power for a packet or more shoots exactly what it has. Of the others the chosen ones take over
/// the power of those passed over, channel by channel in equal proportion, so the sum is kept to the quantum;
/// what changes hands is recorded as roulette gain and loss, which cancel. Zones whose power needs packets of
/// another size are classes of their own, each with a packet at least: a zone that is chosen more often than
/// its power says must not take over what others have. Results do not depend on the number of threads.
class Allocation {
 public:
  /// `needs`: by zone, how many packets its power is to have over that of others (PacketRoom::needs), to a
  /// power of two; empty: all alike.
  Allocation(std::size_t zones, Channels channels, const std::vector<std::uint8_t>& needs = {});

  /// Of zones that need packets of another size; 1: all are alike.
  std::size_t used_classes(const SweepAccounts& accounts) const {
    return needs_.empty() && accounts.arrived.empty() ? 1 : kClasses;
  }

  /// Sum of the unshot power, each class as often as it needs packets; to be called before each plan().
  /// `packet_power` [quanta]: of a packet of the sweep that brought it, where all are alike.
  double measure(const SweepAccounts& accounts, double packet_power);

  /// Moves unshot power into `flight`: about measure()/quantum packets, at the random `offset` in [0,1).
  void plan(SweepAccounts& accounts, double quantum, double offset, Flight& flight, BatchBooks& books);

 private:
  /// Class k has 2^k times as many packets as its power would have in class 0.
  static constexpr std::size_t kClasses = 24;
  template <class T>
  using ByClass = std::array<T, kClasses>;

  struct Chosen {
    std::uint32_t zone;
    std::uint32_t packets;
    std::uint32_t of_class;
    double growth;  // how much a small zone's power should grow; 0: it shoots exactly its own
  };
  /// Consecutive zones that one thread looks at.
  struct Chunk {
    ByClass<std::int64_t> power{};   // of all channels
    ByClass<std::int64_t> before{};  // power of all chunks before this one
    std::vector<Chosen> chosen;
    std::vector<std::int64_t> small_total;  // [class * channels + channel] power of all small zones
    std::vector<double> small_wanted;       // likewise: power of the chosen small zones after growth
  };
  static constexpr std::size_t kChunkBlocks = 64;

  template <class Visit>
  static void for_live_blocks(std::size_t chunk, const SweepAccounts& accounts, const Visit& visit);
  void choose(std::size_t chunk, const SweepAccounts& accounts, double offset);
  /// Of one channel; false in `exchanged` for the classes in which nothing changes hands.
  void hand_over(std::vector<std::int64_t>& unshot, std::size_t channel, Flight& flight, BatchBooks& books,
                 ByClass<bool>& exchanged) const;
  void drop_passed_over(SweepAccounts& accounts, const std::vector<ByClass<bool>>& exchanged,
                        BatchBooks& books) const;

  /// As the place of a zone wants it, and so that no fewer packets carry its power than brought it.
  std::size_t class_of(const SweepAccounts& accounts, std::size_t zone) const;
  std::size_t values_;  // of each zone
  std::vector<std::uint8_t> needs_;
  std::vector<Chunk> chunks_;
  double packet_power_ = 0;  // as measure() was given it
  ByClass<std::int64_t> power_{};
  ByClass<double> quantum_{};  // of the plan
};

}  // namespace reemit

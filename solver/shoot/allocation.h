#pragma once
#include <cstdint>
#include <vector>

#include "solver/shoot/flight.h"
#include "solver/tally/batch_books.h"

namespace reemit {

/// Chooses which zones re-emit and with how much: systematic sampling along the cumulative unshot power. A
/// zone with power for a packet or more shoots exactly what it has. Of the others the chosen ones take over
/// the power of those passed over, band by band in equal proportion, so the sum is kept to the quantum; what
/// changes hands is recorded as roulette gain and loss, which cancel. Results do not depend on the number of
/// threads.
class Allocation {
 public:
  Allocation(std::size_t zones, std::size_t bands);

  /// Sum of unshot[zone * bands + band], to be called before each plan().
  std::int64_t measure(const std::vector<std::int64_t>& unshot);

  /// Moves power from `unshot` into `flight`: about measure()/quantum packets, at the random `offset` in
  /// [0,1).
  void plan(std::vector<std::int64_t>& unshot, double quantum, double offset, Flight& flight,
            BatchBooks& books);

 private:
  struct Chosen {
    std::uint32_t zone;
    std::uint32_t packets;
    double growth;  // how much a small zone's power should grow; 0: it shoots exactly its own
  };
  /// Consecutive zones that one thread looks at.
  struct Chunk {
    std::int64_t power = 0;   // of all bands
    std::int64_t before = 0;  // power of all chunks before this one
    std::vector<Chosen> chosen;
    std::vector<std::int64_t> small_total;  // power of all small zones per band
    std::vector<double> small_wanted;       // power of the chosen small zones after growth, per band
  };
  static constexpr std::size_t kChunkZones = 4096;

  void choose(Chunk& chunk, std::size_t first, const std::vector<std::int64_t>& unshot, double quantum,
              double offset) const;
  void hand_over(std::vector<std::int64_t>& unshot, std::size_t band, Flight& flight,
                 BatchBooks& books) const;
  void drop_passed_over(std::vector<std::int64_t>& unshot, std::size_t band, BatchBooks& books) const;

  std::size_t zones_;
  std::size_t bands_;
  std::vector<Chunk> chunks_;
};

}  // namespace reemit

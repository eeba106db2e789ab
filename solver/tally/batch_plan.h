#pragma once
#include <cstddef>
#include <cstdint>

#include "solver/solution/solver_settings.h"

namespace reemit {

/// How large the batches of a run are. All are whole multiples of one unit of packets; the multiple is the
/// batch's weight. Batches start small, so that a large room has several of them early, and grow once they
/// are little beside what is done: a round of ZoneSums::kGroups equal batches, one for each group, is as
/// large as all rounds before it together, up to the size at which looking at all zones in every sweep is the
/// smaller part of the work. In runs that take very many batches they grow on, each a small part of what is
/// done before. Sizes depend on the settings and the number of zones only.
class BatchPlan {
 public:
  /// `unit_packets`: of a run that goes on; 0 for a new one, which chooses.
  BatchPlan(const SolverSettings& settings, std::size_t zones, std::uint64_t unit_packets = 0);

  /// Packets of a batch of weight 1, >= 1.
  std::uint32_t unit_packets() const { return unit_packets_; }
  /// Weight of the batch that follows `batches` batches of total weight `done`; 0 when all packets that were
  /// asked for are spent, or when all numbers of batches are.
  std::int64_t next_weight(std::int64_t batches, std::int64_t done) const;
  /// Weights of all batches together; 0 if the run is not limited by packets.
  std::int64_t weight_of_packets() const { return weight_of_packets_; }
  /// Packets of a batch that has grown up, in a run that does not take very many.
  std::uint64_t largest_batch_packets() const {
    return static_cast<std::uint64_t>(largest_weight_) * unit_packets_;
  }

 private:
  std::uint32_t unit_packets_ = 1;
  std::int64_t largest_weight_ = 1;  // but for very many batches
  bool goes_on_growing_ = true;
  std::int64_t weight_of_packets_ = 0;
};

}  // namespace reemit

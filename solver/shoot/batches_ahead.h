#pragma once
#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <vector>

#include "scenes/model/stop_token.h"
#include "solver/shoot/packet_batch.h"

namespace reemit {

/// What finds the direct light of zones in the place of packets.
struct DirectInstead {
  std::uint32_t first_together = 1;      ///< BatchTask::first_together.
  std::function<void(BatchBooks&)> put;  ///< Replaces direct and adds to rays, in the batch's task arena.
};

/// Batches of a run that are on their way at the same time, taken back in the order of their numbers, so that
/// a run is the same bits however many there are. A batch has parts that only one thread can do, at the ends
/// of its sweeps; with several batches the other threads have something to do meanwhile.
class BatchesAhead {
 public:
  /// `threads` >= 1 are divided among the batches: each has about as many threads as there are batches that
  /// run at once, and one more waits its turn.
  BatchesAhead(const PacketRoom& transport, const PacketSources& emission, const SolverSettings& settings,
               int threads);
  ~BatchesAhead();  ///< Cuts off what is on its way.
  BatchesAhead(const BatchesAhead&) = delete;
  BatchesAhead& operator=(const BatchesAhead&) = delete;

  bool empty() const { return on_their_way_.empty(); }
  bool full() const { return on_their_way_.size() == most_; }
  std::int64_t batches() const { return static_cast<std::int64_t>(on_their_way_.size()); }
  std::int64_t weight() const;  ///< Of all batches on their way (BatchPlan).

  /// Starts a batch. `direct` may be empty; it is not asked for batches that are cut off. Pre: not full().
  void start(std::uint32_t number, std::uint32_t packets, std::int64_t weight, const StopToken& stop,
             DirectInstead direct = {});

  struct Batch {
    BatchBooks books;
    std::int64_t weight = 0;
    bool whole = false;  ///< False if it was cut off.
    double seconds = 0;  ///< Wall time that it took.
  };
  /// Waits for the one that was started first. Passes on what it threw. Pre: not empty().
  std::unique_ptr<Batch> take();
  /// Its memory is used for another batch.
  void give_back(std::unique_ptr<Batch> batch) { spare_.push_back(std::move(batch)); }

 private:
  struct OnItsWay {
    std::unique_ptr<Batch> batch;
    std::future<void> done;
  };

  const PacketRoom& transport_;
  const PacketSources& emission_;
  const SolverSettings& settings_;
  std::size_t most_ = 1;
  int threads_per_batch_ = 1;
  std::atomic<bool> needless_{false};
  std::deque<OnItsWay> on_their_way_;
  std::vector<std::unique_ptr<Batch>> spare_;
};

}  // namespace reemit

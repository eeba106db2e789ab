#pragma once
#include <atomic>
#include <cstdint>
#include <vector>

#include <tbb/task_arena.h>

#include "mesh/zones/zone_mesh.h"
#include "solver/solution/channels.h"
#include "solver/solution/energy_audit.h"

namespace reemit {

/// Quanta that each emitting channel sends out in one batch. 2^42 leaves a packet of a 10^8-packet batch
/// 4 x 10^4 quanta; sums over a run are RunQuanta.
inline constexpr std::int64_t kBatchQuanta = std::int64_t{1} << 42;

/// Adds to a number that other threads add to as well. Integer addition is associative, so the sum does not
/// depend on the order or on the number of threads.
inline void book(std::int64_t& account, std::int64_t quanta) {
  std::atomic_ref<std::int64_t>(account).fetch_add(quanta, std::memory_order_relaxed);
}

/// Adds to a number that only the calling thread uses, or that all threads use.
inline void book(std::int64_t& account, std::int64_t quanta, bool shared) {
  if (shared)
    book(account, quanta);
  else
    account += quanta;
}

/// How many copies of an array of accounts the threads of this arena should book into: one each while that is
/// cheap, because memory that two cores write to in turn costs more than the rays do; else one for all.
inline std::size_t account_copies(std::size_t values, std::size_t threads = static_cast<std::size_t>(
                                                          tbb::this_task_arena::max_concurrency())) {
  constexpr std::size_t kMostBytes = std::size_t{256} << 20;
  return threads * values * sizeof(std::int64_t) <= kMostBytes ? threads : 1;
}
inline bool accounts_are_shared(std::size_t copies) {
  return copies == 1 && tbb::this_task_arena::max_concurrency() > 1;
}
/// Copy of the calling thread, which is in a task arena.
inline std::size_t current_copy() {
  return static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
}

/// `share` >= 0 of `quanta` >= 0, rounded to the nearest; above 1 where roulette makes up for its odds.
inline std::int64_t share_of(std::int64_t quanta, double share) {
  return static_cast<std::int64_t>(static_cast<double>(quanta) * share + 0.5);
}

/// Where the power of one batch went, in quanta. Arrays are indexed [item * channels.count() + channel],
/// where items are zones, surfaces, or axes as in BandAudit::escaped.
struct BatchBooks {
  /// `has_caustics`: luminaires of the room light zones over surfaces that bend light (Scene::bends_light).
  BatchBooks(std::size_t zones, std::size_t surfaces, Channels of_packets, bool has_caustics = false)
      : channels(of_packets),
        direct(zones * channels.count()),
        caustic(has_caustics ? zones * channels.count() : 0),
        indirect(zones * channels.count()),
        absorbed(surfaces * channels.count()),
        absorbed_on_backs(surfaces * channels.count()),
        escaped(6 * channels.count()),
        emitted(channels.count()),
        unshot(channels.count()),
        roulette_gain(channels.count()),
        roulette_loss(channels.count()) {}

  void clear() {
    for (auto* account : {&direct, &caustic, &indirect, &absorbed, &absorbed_on_backs, &escaped, &emitted,
                          &unshot, &roulette_gain, &roulette_loss})
      account->assign(account->size(), 0);
    packets = 0;
    rays = 0;
    events = {};
  }

  Channels channels;
  std::vector<std::int64_t> direct;    ///< Incident straight from luminaires, also across panes.
  std::vector<std::int64_t> caustic;   ///< From luminaires over mirrors, glass and gloss; size 0 = none.
  std::vector<std::int64_t> indirect;  ///< Incident after light was scattered.
  std::vector<std::int64_t> absorbed;
  std::vector<std::int64_t> absorbed_on_backs;
  std::vector<std::int64_t> escaped;
  std::vector<std::int64_t> emitted;
  std::vector<std::int64_t> unshot;
  std::vector<std::int64_t> roulette_gain;
  std::vector<std::int64_t> roulette_loss;
  std::uint64_t packets = 0;  ///< Emitted by luminaires.
  std::uint64_t rays = 0;
  RareEvents events;
};

}  // namespace reemit

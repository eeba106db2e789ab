#include "solver/shoot/batches_ahead.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <tbb/task_arena.h>

namespace reemit {
namespace {

/// Memory that the accounts of all batches on their way may take [bytes].
constexpr std::size_t kMostBytes = std::size_t{1} << 30;

/// Of one batch: its books; what zones have caught, by thread, and have yet to send on in a sweep, with how
/// many packets brought it; and two points of each zone that packets leave from.
std::size_t bytes_of_batch(const PacketRoom& transport, int threads) {
  const std::size_t values = transport.zones() * transport.channels().count();
  const std::size_t parts = transport.scene().bends_light() ? 3 : 2;  // direct, indirect, caustic
  const std::size_t copies = account_copies(values, static_cast<std::size_t>(threads));
  constexpr std::size_t kCountedBeside = 2;
  constexpr std::size_t kPoints = 2;
  return sizeof(std::int64_t) *
         ((parts + copies + 1) * values + (copies + kCountedBeside + kPoints) * transport.zones());
}

}  // namespace

BatchesAhead::BatchesAhead(const PacketRoom& transport, const PacketSources& emission,
                           const SolverSettings& settings, int threads)
    : transport_(transport), emission_(emission), settings_(settings) {
  // Threads inside a batch wait for each other at every sweep; batches are run in vain when the run ends, and
  // take memory. Between the two lies the root.
  const int together = std::max(1, static_cast<int>(std::sqrt(threads)));
  const auto affordable = static_cast<int>(std::clamp<std::size_t>(
      kMostBytes / std::max<std::size_t>(1, bytes_of_batch(transport, together)), 1, 1024));
  const int running = std::clamp(threads / together, 1, affordable);
  threads_per_batch_ = threads / running;
  // Batches of one size end at about the same time. One more waits for its threads, so that these have work
  // while what has ended is added up.
  most_ = static_cast<std::size_t>(std::min(running + (threads > 1 ? 1 : 0), affordable));
}

BatchesAhead::~BatchesAhead() {
  needless_ = true;
  for (OnItsWay& next : on_their_way_) next.done.wait();
}

std::int64_t BatchesAhead::weight() const {
  std::int64_t sum = 0;
  for (const OnItsWay& next : on_their_way_) sum += next.batch->weight;
  return sum;
}

void BatchesAhead::start(std::uint32_t number, std::uint32_t packets, std::int64_t weight,
                         const StopToken& stop, DirectInstead direct) {
  OnItsWay next;
  if (spare_.empty()) {
    next.batch = std::make_unique<Batch>(Batch{transport_.new_books()});
  } else {
    next.batch = std::move(spare_.back());
    spare_.pop_back();
  }
  next.batch->weight = weight;
  next.done = std::async(std::launch::async, [this, number, packets, batch = next.batch.get(),
                                              token = stop.or_when(needless_), direct = std::move(direct)] {
    using BatchClock = StopToken::Clock;
    const BatchClock::time_point begin = BatchClock::now();
    batch->books.clear();
    const BatchTask task{.transport = transport_,
                         .emission = emission_,
                         .settings = settings_,
                         .batch = number,
                         .packets = packets,
                         .stop = &token,
                         .first_together = direct.first_together};
    tbb::task_arena arena(threads_per_batch_);
    arena.execute([&] {
      batch->whole = settings_.method == SolveMethod::kShooting ? shoot_batch(task, batch->books)
                                                                : walk_batch(task, batch->books);
      if (batch->whole && direct.put) direct.put(batch->books);
    });
    batch->seconds = std::chrono::duration<double>(BatchClock::now() - begin).count();
  });
  on_their_way_.push_back(std::move(next));
}

std::unique_ptr<BatchesAhead::Batch> BatchesAhead::take() {
  OnItsWay next = std::move(on_their_way_.front());
  on_their_way_.pop_front();
  next.done.get();
  return std::move(next.batch);
}

}  // namespace reemit

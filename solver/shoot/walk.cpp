#include <algorithm>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "solver/shoot/flight.h"
#include "solver/shoot/packet_batch.h"
#include "solver/shoot/packet_books.h"

namespace reemit {
namespace {

constexpr std::uint32_t kPacketsPerTask = 1024;
/// A walk ends here even when nothing has absorbed it (a sealed part whose walls reflect everything); its
/// power is unshot.
constexpr std::uint32_t kMostBounces = 200'000;

/// Packets under way, 16 rays at a time; those that end make room so that blocks stay full.
class WalkTask {
 public:
  WalkTask(const BatchTask& task, BatchBooks& books, std::vector<std::int64_t>& absorbed)
      : transport_(task.transport),
        bands_(task.transport.bands()),
        rng_(task.settings.seed, RngPurpose::kReflection),
        batch_(task.batch),
        observer_(task.ray_observer),
        books_(books),
        local_(books),
        absorbed_(absorbed) {}

  void run(const Flight& flight, const FlightNumbers& numbers, std::uint32_t begin, std::uint32_t end) {
    start(flight, numbers, begin, end);
    for (std::uint32_t bounce = 1; !ids_.empty(); ++bounce) {
      if (bounce == kMostBounces) return leave_unshot();
      trace_on(bounce);
    }
  }

  std::uint64_t rays() const { return rays_; }

 private:
  void start(const Flight& flight, const FlightNumbers& numbers, std::uint32_t begin, std::uint32_t end) {
    zones_.clear();
    ids_.clear();
    quanta_.clear();
    FlightCursor cursor(transport_, flight, begin);
    Ray16 rays;
    std::vector<std::int64_t> power(16 * bands_);
    for (std::uint32_t first = begin; first < end; first += 16) {
      const int count = static_cast<int>(std::min<std::uint32_t>(16, end - first));
      cursor.start16(first, count, numbers, rays, power.data());
      arrive(
          rays, count, books_.direct, [&](int lane) { return first + static_cast<std::uint32_t>(lane); },
          power.data(), 0);
    }
  }

  void trace_on(std::uint32_t bounce) {
    zones_.swap(from_zones_);
    ids_.swap(from_ids_);
    quanta_.swap(from_quanta_);
    zones_.clear();
    ids_.clear();
    quanta_.clear();
    Ray16 rays;
    for (std::size_t first = 0; first < from_ids_.size(); first += 16) {
      const int count = static_cast<int>(std::min<std::size_t>(16, from_ids_.size() - first));
      alignas(64) float u[4][16] = {};
      for (int lane = 0; lane < count; ++lane) {
        const std::size_t i = first + static_cast<std::size_t>(lane);
        const auto x = rng_.uniform4(from_ids_[i], batch_, 2 * bounce);
        for (std::size_t d = 0; d < 4; ++d) u[d][lane] = x[d];
        transport_.put_zone(from_zones_[i], lanes_, lane);
      }
      start_rays(lanes_, u, rays);
      arrive(
          rays, count, books_.indirect,
          [&](int lane) { return from_ids_[first + static_cast<std::size_t>(lane)]; },
          &from_quanta_[first * bands_], bounce);
    }
  }

  /// Traces a block, books where each packet comes to, and keeps those that survive.
  template <class IdOf>
  void arrive(const Ray16& rays, int count, std::vector<std::int64_t>& incident, const IdOf& id_of,
              const std::int64_t* power, std::uint32_t bounce) {
    Hit16 hits;
    if (observer_ != nullptr) (*observer_)(rays, count);
    transport_.rays().closest16(rays, count, hits);
    rays_ += static_cast<std::uint64_t>(count);
    for (int lane = 0; lane < count; ++lane) {
      const std::int64_t* quanta = &power[static_cast<std::size_t>(lane) * bands_];
      if (hits.triangle[lane] == RayScene::kMiss) {
        for (std::size_t b = 0; b < bands_; ++b)
          local_.escape(rays.dx[lane], rays.dy[lane], rays.dz[lane], b, quanta[b]);
        continue;
      }
      const SurfaceId surface = transport_.mesh().triangle(TriangleId(hits.triangle[lane])).surface;
      const ZoneId zone =
          transport_.zone_of(hits.triangle[lane], hits.u[lane], hits.v[lane], hits.front[lane]);
      if (!zone.valid()) {
        for (std::size_t b = 0; b < bands_; ++b)
          book(books_.absorbed_on_backs[surface.index() * bands_ + b], quanta[b]);
        continue;
      }
      for (std::size_t b = 0; b < bands_; ++b) book(incident[zone.index() * bands_ + b], quanta[b]);
      reflect(zone, surface, id_of(lane), quanta, bounce);
    }
  }

  void reflect(ZoneId zone, SurfaceId surface, std::uint32_t id, const std::int64_t* quanta,
               std::uint32_t bounce) {
    const double survival = transport_.largest_reflectance(surface);
    const double* rho = transport_.reflectance(surface);
    const bool survives = CounterRng::to_unit(rng_.bits4(id, batch_, 2 * bounce + 1)[0]) < survival;
    if (survives) {
      zones_.push_back(zone);
      ids_.push_back(id);
    }
    for (std::size_t b = 0; b < bands_; ++b) {
      std::int64_t kept = 0;
      if (survives) {
        kept = std::min<std::int64_t>(quanta[b],
                                      std::llround(static_cast<double>(quanta[b]) * (rho[b] / survival)));
        quanta_.push_back(kept);
      }
      absorbed_[surface.index() * bands_ + b] += quanta[b] - kept;
    }
  }

  void leave_unshot() {
    for (std::size_t i = 0; i < quanta_.size(); ++i) book(books_.unshot[i % bands_], quanta_[i]);
  }

  const TransportScene& transport_;
  std::size_t bands_;
  CounterRng rng_;
  std::uint32_t batch_;
  const RayObserver* observer_;
  BatchBooks& books_;
  LocalBooks local_;
  std::vector<std::int64_t>& absorbed_;  // [surface * bands + band], of this thread
  ZoneLanes lanes_{};
  std::uint64_t rays_ = 0;
  std::vector<ZoneId> zones_, from_zones_;          // where each packet is
  std::vector<std::uint32_t> ids_, from_ids_;       // its number: selects its random numbers
  std::vector<std::int64_t> quanta_, from_quanta_;  // its power per band
};

}  // namespace

bool walk_batch(const BatchTask& task, BatchBooks& books) {
  const std::size_t bands = task.transport.bands();
  const CounterRng offsets(task.settings.seed, RngPurpose::kAllocation);
  const Flight flight =
      plan_emission_flight(task.emission, bands, task.packets, offsets.uniform4(0, task.batch, 0)[0]);
  const FlightNumbers numbers(task.settings.sampling, task.settings.seed, task.batch, 0);
  for (std::size_t i = 0; i < flight.quanta.size(); ++i) books.emitted[i % bands] += flight.quanta[i];
  books.packets += flight.packets();

  struct Thread {
    std::vector<std::int64_t> absorbed;
    std::uint64_t rays = 0;
  };
  tbb::enumerable_thread_specific<Thread> threads([&] {
    return Thread{std::vector<std::int64_t>(books.absorbed.size()), 0};
  });
  std::atomic<bool> abandoned = false;
  const std::uint32_t tasks = (flight.packets() + kPacketsPerTask - 1) / kPacketsPerTask;
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, tasks, 1), [&](const auto& range) {
    Thread& mine = threads.local();
    WalkTask walk(task, books, mine.absorbed);
    for (std::uint32_t t = range.begin(); t != range.end(); ++t) {
      if (task.abandon != nullptr && task.abandon->load(std::memory_order_relaxed)) {
        abandoned = true;
        return;
      }
      walk.run(flight, numbers, t * kPacketsPerTask, std::min(flight.packets(), (t + 1) * kPacketsPerTask));
    }
    mine.rays += walk.rays();
  });
  for (const Thread& t : threads) {
    for (std::size_t i = 0; i < t.absorbed.size(); ++i) books.absorbed[i] += t.absorbed[i];
    books.rays += t.rays;
  }
  return !abandoned;
}

}  // namespace reemit

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "solver/shoot/allocation.h"
#include "solver/shoot/flight.h"
#include "solver/shoot/packet_batch.h"
#include "solver/shoot/packet_books.h"

namespace reemit {
namespace {

constexpr std::uint32_t kPacketsPerTask = 4096;
/// A batch ends here even when power is left (a sealed part whose walls reflect everything); the rest is
/// unshot.
constexpr std::uint32_t kMostSweeps = 200'000;

/// Account that each of 16 packets is booked to, null if it left the room. Their memory is asked for at once,
/// before the first is needed: with many zones the books are larger than the caches.
void find_accounts(const TransportScene& transport, const Hit16& hits, int count, SweepAccounts& sweep,
                   BatchBooks& books, std::int64_t** accounts) {
  const std::size_t bands = transport.bands();
  for (int lane = 0; lane < count; ++lane) {
    const std::uint32_t t = hits.triangle[lane];
    accounts[lane] = nullptr;
    if (t == RayScene::kMiss) continue;
    const ZoneId zone = transport.zone_of(t, hits.u[lane], hits.v[lane], hits.front[lane]);
    if (zone.valid()) {
      accounts[lane] = &sweep.incident[zone.index() * bands];
      sweep.touch(zone.index());
    } else {
      accounts[lane] =
          &books.absorbed_on_backs[transport.mesh().triangle(TriangleId(t)).surface.index() * bands];
    }
    __builtin_prefetch(accounts[lane], 1);
  }
}

/// Traces a flight and books every packet where it ends; sweep.incident receives what zones catch.
void trace_flight(const BatchTask& batch, const Flight& flight, const FlightNumbers& numbers,
                  SweepAccounts& sweep, BatchBooks& books) {
  const TransportScene& transport = batch.transport;
  const std::size_t bands = transport.bands();
  const std::uint32_t tasks = (flight.packets() + kPacketsPerTask - 1) / kPacketsPerTask;
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, tasks, 1), [&](const auto& range) {
    LocalBooks local(books);
    std::vector<std::int64_t> power(16 * bands);
    for (std::uint32_t task = range.begin(); task != range.end(); ++task) {
      const std::uint32_t begin = task * kPacketsPerTask;
      const std::uint32_t end = std::min(flight.packets(), begin + kPacketsPerTask);
      FlightCursor cursor(transport, flight, begin);
      Ray16 rays;
      Hit16 hits;
      std::int64_t* accounts[16];
      for (std::uint32_t first = begin; first < end; first += 16) {
        const int count = static_cast<int>(std::min<std::uint32_t>(16, end - first));
        cursor.start16(first, count, numbers, rays, power.data());
        if (batch.ray_observer != nullptr) (*batch.ray_observer)(rays, count);
        transport.rays().closest16(rays, count, hits);
        find_accounts(transport, hits, count, sweep, books, accounts);
        for (int lane = 0; lane < count; ++lane) {
          const std::int64_t* quanta = &power[static_cast<std::size_t>(lane) * bands];
          std::int64_t* account = accounts[lane];
          for (std::size_t b = 0; b < bands; ++b)
            if (account != nullptr)
              book(account[b], quanta[b]);
            else
              local.escape(rays.dx[lane], rays.dy[lane], rays.dz[lane], b, quanta[b]);
        }
      }
    }
  });
  books.rays += flight.packets();
}

/// Moves what a sweep brought in into `part` of the books; the reflected share becomes unshot power.
void reflect(const TransportScene& transport, SweepAccounts& sweep, std::vector<std::int64_t>& part,
             BatchBooks& books) {
  const std::size_t bands = transport.bands();
  const ZoneMesh& mesh = transport.mesh();
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sweep.block_count(), 16), [&](const auto& range) {
    std::vector<std::int64_t> absorbed(bands, 0);
    SurfaceId surface;
    const auto settle = [&] {
      for (std::size_t b = 0; b < bands; ++b) {
        if (absorbed[b] != 0) book(books.absorbed[surface.index() * bands + b], absorbed[b]);
        absorbed[b] = 0;
      }
    };
    for (std::size_t block = range.begin(); block != range.end(); ++block) {
      if (sweep.live[block] == 0) continue;
      for (std::size_t z = sweep.block_begin(block); z < sweep.block_end(block); ++z) {
        std::int64_t* in = &sweep.incident[z * bands];
        if (std::all_of(in, in + bands, [](std::int64_t q) { return q == 0; })) continue;
        if (const SurfaceId s = mesh.zone_surface(ZoneId(z)); s != surface) {
          settle();
          surface = s;
        }
        const double* rho = transport.reflectance(surface);
        for (std::size_t b = 0; b < bands; ++b) {
          const std::int64_t reflected = share_of(in[b], rho[b]);
          part[z * bands + b] += in[b];
          sweep.unshot[z * bands + b] += reflected;
          absorbed[b] += in[b] - reflected;
          in[b] = 0;
        }
      }
    }
    settle();
  });
}

}  // namespace

bool shoot_batch(const BatchTask& task, BatchBooks& books) {
  const TransportScene& transport = task.transport;
  const std::size_t bands = transport.bands();
  const CounterRng offsets(task.settings.seed, RngPurpose::kAllocation);
  SweepAccounts accounts(transport.zones(), bands);

  Flight flight =
      plan_emission_flight(task.emission, bands, task.packets, offsets.uniform4(0, task.batch, 0)[0]);
  for (std::size_t i = 0; i < flight.quanta.size(); ++i) books.emitted[i % bands] += flight.quanta[i];
  const auto emitted =
      static_cast<double>(std::accumulate(books.emitted.begin(), books.emitted.end(), std::int64_t{0}));
  books.packets += flight.packets();
  const double quantum = emitted / flight.packets();

  Allocation allocation(transport.zones(), bands);
  for (std::uint32_t sweep = 0; sweep < kMostSweeps; ++sweep) {
    if (task.abandon != nullptr && task.abandon->load(std::memory_order_relaxed)) return false;
    trace_flight(task, flight, FlightNumbers(task.settings.sampling, task.settings.seed, task.batch, sweep),
                 accounts, books);
    reflect(transport, accounts, sweep == 0 ? books.direct : books.indirect, books);
    const auto left = static_cast<double>(allocation.measure(accounts));
    if (left <= task.settings.stop_share * emitted) break;
    const double packets = std::max(1.0, std::round(left / quantum));
    allocation.plan(accounts, left / packets, offsets.uniform4(0, task.batch, sweep + 1)[0], flight, books);
  }
  for (std::size_t i = 0; i < accounts.unshot.size(); ++i) books.unshot[i % bands] += accounts.unshot[i];
  return true;
}

}  // namespace reemit

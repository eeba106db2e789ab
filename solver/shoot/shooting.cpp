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
void find_accounts(const TransportScene& transport, const Hit16& hits, int count,
                   std::vector<std::int64_t>& incident, BatchBooks& books, std::int64_t** accounts) {
  const std::size_t bands = transport.bands();
  for (int lane = 0; lane < count; ++lane) {
    const std::uint32_t t = hits.triangle[lane];
    accounts[lane] = nullptr;
    if (t == RayScene::kMiss) continue;
    const ZoneId zone = transport.zone_of(t, hits.u[lane], hits.v[lane], hits.front[lane]);
    accounts[lane] =
        zone.valid()
            ? &incident[zone.index() * bands]
            : &books.absorbed_on_backs[transport.mesh().triangle(TriangleId(t)).surface.index() * bands];
    __builtin_prefetch(accounts[lane], 1);
  }
}

/// Traces a flight and books every packet where it ends; `incident` receives what zones catch.
void trace_flight(const BatchTask& batch, const Flight& flight, const FlightNumbers& numbers,
                  std::vector<std::int64_t>& incident, BatchBooks& books) {
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
        find_accounts(transport, hits, count, incident, books, accounts);
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

/// Moves what a sweep brought in from `incident` into the books; the reflected part joins `unshot`.
void reflect(const TransportScene& transport, std::vector<std::int64_t>& incident,
             std::vector<std::int64_t>& part, std::vector<std::int64_t>& unshot, BatchBooks& books) {
  const std::size_t bands = transport.bands();
  const ZoneMesh& mesh = transport.mesh();
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.triangle_count(), 64), [&](const auto& range) {
    for (std::size_t t = range.begin(); t != range.end(); ++t) {
      const TriangleId id(t);
      const BaseTriangle& triangle = mesh.triangle(id);
      const double* rho = transport.reflectance(triangle.surface);
      const std::size_t first = mesh.first_zone(id, true).index();
      const std::size_t zones =
          std::size_t{triangle.divisions} * triangle.divisions * (triangle.two_sided ? 2 : 1);
      for (std::size_t b = 0; b < bands; ++b) {
        std::int64_t absorbed = 0;
        for (std::size_t z = first; z < first + zones; ++z) {
          std::int64_t& in = incident[z * bands + b];
          if (in == 0) continue;
          const std::int64_t reflected = share_of(in, rho[b]);
          part[z * bands + b] += in;
          unshot[z * bands + b] += reflected;
          absorbed += in - reflected;
          in = 0;
        }
        if (absorbed != 0) book(books.absorbed[triangle.surface.index() * bands + b], absorbed);
      }
    }
  });
}

}  // namespace

bool shoot_batch(const BatchTask& task, BatchBooks& books) {
  const TransportScene& transport = task.transport;
  const std::size_t bands = transport.bands();
  const CounterRng offsets(task.settings.seed, RngPurpose::kAllocation);
  std::vector<std::int64_t> incident(transport.zones() * bands);
  std::vector<std::int64_t> unshot(transport.zones() * bands);

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
                 incident, books);
    reflect(transport, incident, sweep == 0 ? books.direct : books.indirect, unshot, books);
    const auto left = static_cast<double>(allocation.measure(unshot));
    if (left <= task.settings.stop_share * emitted) break;
    const double packets = std::max(1.0, std::round(left / quantum));
    allocation.plan(unshot, left / packets, offsets.uniform4(0, task.batch, sweep + 1)[0], flight, books);
  }
  for (std::size_t i = 0; i < unshot.size(); ++i) books.unshot[i % bands] += unshot[i];
  return true;
}

}  // namespace reemit

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "solver/shoot/allocation.h"
#include "solver/shoot/arrival_points.h"
#include "solver/shoot/flight.h"
#include "solver/shoot/packet_batch.h"
#include "solver/shoot/packet_books.h"

namespace reemit {
namespace {

constexpr std::uint32_t kPacketsPerTask = 4096;
/// A batch ends here even when power is left (a sealed part whose walls reflect everything); the rest is
/// unshot.
constexpr std::uint32_t kMostSweeps = 200'000;

/// Account that a packet is booked to, and whether other threads may book to it at the same time.
struct Account {
  std::int64_t* quanta = nullptr;  ///< By band; null if the packet left the room or needs a second look.
  bool shared = false;
  std::uint64_t* place = nullptr;    ///< Among the arrival points of its zone, if they are kept.
  std::uint32_t member = kNoMember;  ///< Of the zone, if that is a group.

  static constexpr std::uint32_t kNoMember = 0xffffffff;
};

/// Accounts of 16 packets. Their memory is asked for at once, before the first is needed: with many zones the
/// books are larger than the caches.
void find_accounts(const PacketRoom& transport, const Hit16& hits, int count,
                   SweepAccounts::Incident& incident, bool shared, bool second_look, ArrivalPoints* arrivals,
                   const std::uint32_t* bits, BatchBooks& books, Account* accounts) {
  const std::size_t bands = transport.bands();
  for (int lane = 0; lane < count; ++lane) {
    const std::uint32_t t = hits.triangle[lane];
    accounts[lane] = {};
    if (t == RayTracer::kMiss) continue;
    const ZoneId zone = transport.zone_of(t, hits.u[lane], hits.v[lane], hits.front[lane]);
    if (!second_look && (!zone.valid() || transport.rays().is_at_edge(t, hits.u[lane], hits.v[lane])))
      continue;
    if (zone.valid()) {
      accounts[lane] = {&incident.quanta[zone.index() * bands], shared};
      incident.touch(zone.index());
      if (arrivals != nullptr && ArrivalPoints::has_points(transport.mesh(), zone)) {
        if (transport.mesh().is_group(zone))
          accounts[lane].member = transport.mesh().member(TriangleId(t), hits.front[lane]);
        accounts[lane].place = arrivals->place(zone, bits[lane]);
        __builtin_prefetch(accounts[lane].place, 1);
      }
    } else {
      const SurfaceId surface = transport.mesh().triangle(TriangleId(t)).surface;
      accounts[lane] = {&books.absorbed_on_backs[surface.index() * bands], true};
      count_event(books.events.back_hits);
    }
    __builtin_prefetch(accounts[lane].quanta, 1);
  }
}

/// Traces the flight of sweep `number` and books every packet where it ends; sweep.incident receives what
/// zones catch, and `arrivals`, if given, where. False if it was cut off: packets that have not set out are
/// unshot.
bool trace_flight(const BatchTask& batch, const Flight& flight, std::uint32_t number, ArrivalPoints* arrivals,
                  SweepAccounts& sweep, BatchBooks& books) {
  const PacketRoom& transport = batch.transport;
  const std::size_t bands = transport.bands();
  const bool shared = accounts_are_shared(sweep.incident.size());
  const FlightNumbers numbers(batch.settings.sampling, batch.settings.seed, batch.batch, number);
  const CounterRng choice(batch.settings.seed, RngPurpose::kArrival);
  const ArrivalPoints* points = number == 0 ? nullptr : arrivals;  // luminaires have none
  const std::uint32_t tasks = (flight.packets() + kPacketsPerTask - 1) / kPacketsPerTask;
  std::atomic<std::uint64_t> started{0};
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, tasks, 1), [&](const auto& range) {
    LocalBooks local(books);
    SweepAccounts::Incident& incident = sweep.mine();
    DoubtfulPackets doubtful(bands);
    PacketBlock second(bands);
    std::vector<std::int64_t> power(16 * bands);
    Hit16 hits;
    Account accounts[16];
    BitLanes bits;
    const auto trace_and_book = [&](const Ray16& rays, int count, const std::uint32_t* id,
                                    const std::int64_t* quanta, bool second_look) {
      transport.rays().closest16(rays, count, hits);
      if (arrivals != nullptr) choice.bits4x16(id, batch.batch, number, bits);
      find_accounts(transport, hits, count, incident, shared, second_look, arrivals, bits.word[0], books,
                    accounts);
      for (int lane = 0; lane < count; ++lane, quanta += bands) {
        const Account& account = accounts[lane];
        if (account.quanta == nullptr && !second_look) {
          doubtful.add(transport.rays(), rays, hits, lane, id[lane], quanta);
          count_event(books.events.second_looks);
          continue;
        }
        if (account.place != nullptr) {
          if (account.member == Account::kNoMember)
            arrivals->add(account.place, bits.word[0][lane], hits.u[lane], hits.v[lane]);
          else
            arrivals->add_in_group(account.place, bits.word[0][lane], account.member, hits.u[lane],
                                   hits.v[lane]);
        }
        for (std::size_t b = 0; b < bands; ++b)
          if (account.quanta != nullptr)
            book(account.quanta[b], quanta[b], account.shared);
          else
            local.escape(rays.dx[lane], rays.dy[lane], rays.dz[lane], b, quanta[b]);
      }
    };
    const auto look_again = [&] {
      doubtful.take(second);
      trace_and_book(second.rays, second.count, second.id, second.power.data(), true);
    };
    for (std::uint32_t task = range.begin(); task != range.end(); ++task) {
      const std::uint32_t begin = task * kPacketsPerTask;
      const std::uint32_t end = std::min(flight.packets(), begin + kPacketsPerTask);
      if (batch.stop != nullptr && batch.stop->requested()) {
        leave_unshot(flight, begin, end, books);
        continue;
      }
      started += end - begin;
      FlightCursor cursor(transport, flight, begin, points);
      Ray16 rays;
      std::uint32_t id[16];
      for (std::uint32_t first = begin; first < end; first += 16) {
        const int count = static_cast<int>(std::min<std::uint32_t>(16, end - first));
        cursor.start16(first, count, numbers, rays, power.data());
        std::iota(id, id + 16, first);
        if (batch.ray_observer != nullptr) (*batch.ray_observer)({rays, count, id, number});
        trace_and_book(rays, count, id, power.data(), false);
        if (doubtful.count() >= 16) look_again();
      }
    }
    look_again();
  });
  books.rays += started;
  return started == flight.packets();
}

/// Moves what a sweep brought in into `part` of the books; the reflected share becomes unshot power.
void reflect(const PacketRoom& transport, SweepAccounts& sweep, std::vector<std::int64_t>& part,
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
      std::vector<std::int64_t*> copies;
      for (SweepAccounts::Incident& copy : sweep.incident) {
        if (copy.live[block] != 0) copies.push_back(copy.quanta.data());
        copy.live[block] = 0;
      }
      if (copies.empty()) continue;
      sweep.live[block] = 1;
      for (std::size_t z = sweep.block_begin(block); z < sweep.block_end(block); ++z) {
        if (const SurfaceId s = mesh.zone_surface(ZoneId(z)); s != surface) {
          settle();
          surface = s;
        }
        const double* rho = transport.surface_model().reflectance(surface);
        for (std::size_t b = 0; b < bands; ++b) {
          const std::size_t i = z * bands + b;
          std::int64_t in = 0;
          for (std::int64_t* copy : copies) in += std::exchange(copy[i], 0);
          if (in == 0) continue;
          const std::int64_t reflected = share_of(in, rho[b]);
          part[i] += in;
          sweep.unshot[i] += reflected;
          absorbed[b] += in - reflected;
        }
      }
    }
    settle();
  });
}

}  // namespace

bool shoot_batch(const BatchTask& task, BatchBooks& books) {
  const PacketRoom& transport = task.transport;
  const std::size_t bands = transport.bands();
  const CounterRng offsets(task.settings.seed, RngPurpose::kAllocation);
  SweepAccounts accounts(transport.zones(), bands);

  Flight flight =
      plan_first_flight(task.emission, bands, task.packets, offsets.uniform4(0, task.batch, 0)[0]);
  for (std::size_t i = 0; i < flight.quanta.size(); ++i) books.emitted[i % bands] += flight.quanta[i];
  const auto emitted =
      static_cast<double>(std::accumulate(books.emitted.begin(), books.emitted.end(), std::int64_t{0}));
  books.packets += flight.packets();
  const double quantum = emitted / flight.packets();

  Allocation allocation(transport.zones(), bands);
  std::optional<ArrivalPoints> arrivals;
  if (task.settings.reemission == Reemission::kFromHits)
    arrivals.emplace(transport.zones(), flight.packets());
  bool whole = true;
  for (std::uint32_t sweep = 0;; ++sweep) {
    if (arrivals) arrivals->begin(sweep);
    whole = trace_flight(task, flight, sweep, arrivals ? &*arrivals : nullptr, accounts, books);
    reflect(transport, accounts, sweep == 0 ? books.direct : books.indirect, books);
    const auto left = static_cast<double>(allocation.measure(accounts));
    if (!whole || left <= task.settings.stop_share * emitted || sweep + 1 == kMostSweeps) break;
    whole = task.stop == nullptr || !task.stop->requested();
    if (!whole) break;
    // From here on the power is in the flight, which must be traced before the batch may end.
    const double packets = std::max(1.0, std::round(left / quantum));
    allocation.plan(accounts, left / packets, offsets.uniform4(0, task.batch, sweep + 1)[0], flight, books);
  }
  for (std::size_t i = 0; i < accounts.unshot.size(); ++i) books.unshot[i % bands] += accounts.unshot[i];
  return whole;
}

}  // namespace reemit

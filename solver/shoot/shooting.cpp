#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include "solver/shoot/flight.h"
#include "solver/shoot/packet_batch.h"
#include "solver/shoot/packet_books.h"

namespace reemit {
namespace {

constexpr std::uint32_t kPacketsPerTask = 4096;
/// A batch ends here even when power is left (a sealed part whose walls reflect everything); the rest is
/// unshot.
constexpr std::uint32_t kMostSweeps = 200'000;

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
      for (std::uint32_t first = begin; first < end; first += 16) {
        const int count = static_cast<int>(std::min<std::uint32_t>(16, end - first));
        cursor.start16(first, count, numbers, rays, power.data());
        if (batch.ray_observer != nullptr) (*batch.ray_observer)(rays, count);
        transport.rays().closest16(rays, count, hits);
        for (int lane = 0; lane < count; ++lane) {
          const std::int64_t* quanta = &power[static_cast<std::size_t>(lane) * bands];
          if (hits.triangle[lane] == RayScene::kMiss) {
            for (std::size_t b = 0; b < bands; ++b)
              local.escape(rays.dx[lane], rays.dy[lane], rays.dz[lane], b, quanta[b]);
            continue;
          }
          const ZoneId zone =
              transport.zone_of(hits.triangle[lane], hits.u[lane], hits.v[lane], hits.front[lane]);
          std::int64_t* account = nullptr;
          if (zone.valid())
            account = &incident[zone.index() * bands];
          else
            account =
                &books.absorbed_on_backs
                     [transport.mesh().triangle(TriangleId(hits.triangle[lane])).surface.index() * bands];
          for (std::size_t b = 0; b < bands; ++b) book(account[b], quanta[b]);
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
          const std::int64_t reflected =
              std::min<std::int64_t>(in, std::llround(static_cast<double>(in) * rho[b]));
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

std::int64_t sum(const std::vector<std::int64_t>& values) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, values.size(), 65536), std::int64_t{0},
      [&](const auto& range, std::int64_t part) {
        return std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(range.begin()),
                               values.begin() + static_cast<std::ptrdiff_t>(range.end()), part);
      },
      std::plus<>());
}

/// Chooses which zones re-emit and with how much. About total/quantum packets set out, by systematic sampling
/// along the cumulative unshot power. A zone with power for a packet or more shoots exactly what it has. Of
/// the others the chosen ones take over the power of those passed over, band by band in equal proportion, so
/// the sum is kept to the quantum; what changes hands is recorded as roulette gain and loss, which cancel.
class Allocation {
 public:
  Allocation(std::size_t zones, std::size_t bands) : zones_(zones), bands_(bands) {}

  /// Moves power from `unshot` into `flight`.
  void plan(std::vector<std::int64_t>& unshot, double quantum, double offset, Flight& flight,
            BatchBooks& books) {
    choose(unshot, quantum, offset);
    flight.clear();
    for (const Chosen& c : chosen_) flight.add({ZoneId(c.zone), 0}, c.packets);
    flight.quanta.assign(chosen_.size() * bands_, 0);
    for (std::size_t b = 0; b < bands_; ++b) {
      // Where no chosen small zone has power in this band there is nobody to hand over to, and all keep what
      // they have.
      const bool exchange = small_wanted_[b] > 0;
      double running = 0;
      std::int64_t given = 0;
      for (std::size_t i = 0; i < chosen_.size(); ++i) {
        const Chosen& c = chosen_[i];
        std::int64_t& own = unshot[c.zone * bands_ + b];
        std::int64_t& sent = flight.quanta[i * bands_ + b];
        sent = own;
        if (c.growth > 0 && exchange) {
          running += static_cast<double>(own) * c.growth;
          const double share = std::min(1.0, running / small_wanted_[b]);
          const std::int64_t until =
              i == last_small_ ? small_total_[b] : std::llround(share * static_cast<double>(small_total_[b]));
          sent = until - given;
          given = until;
          (sent > own ? books.roulette_gain[b] : books.roulette_loss[b]) += std::abs(sent - own);
        }
        own = 0;
      }
      if (exchange) drop_passed_over(unshot, b, books);
    }
  }

 private:
  struct Chosen {
    std::size_t zone;
    std::uint32_t packets;
    double growth;  ///< How much a small zone's power should grow; 0: it shoots exactly its own.
  };

  void choose(const std::vector<std::int64_t>& unshot, double quantum, double offset) {
    chosen_.clear();
    small_total_.assign(bands_, 0);
    small_wanted_.assign(bands_, 0);
    double running = 0;
    double before = 0;
    for (std::size_t z = 0; z < zones_; ++z) {
      const std::int64_t* own = &unshot[z * bands_];
      const auto power = static_cast<double>(std::accumulate(own, own + bands_, std::int64_t{0}));
      if (power == 0) continue;
      running += power;
      const double upto = std::floor(running / quantum + offset);
      const auto packets = static_cast<std::uint32_t>(upto - before);
      before = upto;
      const bool small = power < quantum || packets == 0;
      if (small)
        for (std::size_t b = 0; b < bands_; ++b) small_total_[b] += own[b];
      if (packets == 0) continue;
      const double growth = small ? quantum * packets / power : 0.0;
      if (small) last_small_ = chosen_.size();
      for (std::size_t b = 0; b < bands_; ++b) small_wanted_[b] += static_cast<double>(own[b]) * growth;
      chosen_.push_back({z, packets, growth});
    }
  }

  /// What is left in the band belongs to small zones that were passed over, and the chosen ones have taken it
  /// over.
  void drop_passed_over(std::vector<std::int64_t>& unshot, std::size_t band, BatchBooks& books) const {
    for (std::size_t i = band; i < unshot.size(); i += bands_) {
      books.roulette_loss[band] += unshot[i];
      unshot[i] = 0;
    }
  }

  std::size_t zones_;
  std::size_t bands_;
  std::vector<Chosen> chosen_;
  std::size_t last_small_ = 0;             // index into chosen_
  std::vector<std::int64_t> small_total_;  // power of all small zones per band
  std::vector<double> small_wanted_;       // power of the chosen small zones after growth, per band
};

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
  const auto emitted = static_cast<double>(sum(books.emitted));
  books.packets += flight.packets();
  const double quantum = emitted / flight.packets();

  Allocation allocation(transport.zones(), bands);
  for (std::uint32_t sweep = 0; sweep < kMostSweeps; ++sweep) {
    if (task.abandon != nullptr && task.abandon->load(std::memory_order_relaxed)) return false;
    trace_flight(task, flight, FlightNumbers(task.settings.sampling, task.settings.seed, task.batch, sweep),
                 incident, books);
    reflect(transport, incident, sweep == 0 ? books.direct : books.indirect, unshot, books);
    const auto left = static_cast<double>(sum(unshot));
    if (left <= task.settings.stop_share * emitted) break;
    const double packets = std::max(1.0, std::round(left / quantum));
    allocation.plan(unshot, left / packets, offsets.uniform4(0, task.batch, sweep + 1)[0], flight, books);
  }
  for (std::size_t i = 0; i < unshot.size(); ++i) books.unshot[i % bands] += unshot[i];
  return true;
}

}  // namespace reemit

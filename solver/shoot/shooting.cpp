#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "solver/shoot/allocation.h"
#include "solver/shoot/arrival_points.h"
#include "solver/shoot/flight.h"
#include "solver/shoot/packet_batch.h"
#include "solver/shoot/packet_tracer.h"
#include "solver/shoot/walk_flight.h"

namespace reemit {
namespace {

constexpr std::uint32_t kPacketsPerTask = 4096;
/// A batch ends here even when power is left (a sealed part whose walls reflect everything); the rest is
/// unshot.
constexpr std::uint32_t kMostSweeps = 200'000;
/// Of the packets of a batch, those that walk with what sweeps have left.
constexpr double kWalkingShare = 1.0 / 64;
/// Where zones differ in what packets they need so many are left to walks in any case: every class sends one
/// packet at least, so power dwindles and packets do not.
constexpr double kFewPackets = 64;
/// Of each of them at least, so that no share of it is rounded by much.
constexpr double kLeastQuantaOfWalk = 1e4;

/// Traces packets of one sweep and books each where it ends. One per task.
class SweepTracer {
 public:
  /// `sweep.incident` receives what zones catch, and `arrivals`, if given, where.
  SweepTracer(const BatchTask& batch, std::uint32_t number, ArrivalPoints* arrivals, SweepAccounts& sweep,
              BatchBooks& books)
      : number_(number),
        values_(batch.transport.channels().count()),
        shared_(accounts_are_shared(sweep.incident.size())),
        choice_(batch.settings.seed, RngPurpose::kArrival),
        arrivals_(arrivals),
        incident_(sweep.mine()),
        packets_(batch, books),
        held_(batch.transport.channels()) {}

  /// Packets whose way goes beyond this part of the light are held instead of traced on.
  void hold_beyond(LightPart part) { holds_beyond_ = part; }
  const WaitingPackets& held() const { return held_; }
  std::uint64_t rays() const { return packets_.rays(); }

  void trace(PacketBlock& block) {
    packets_.trace(block, number_, [&](const PacketArrivals& arrived) { arrive(arrived); });
  }
  /// Traces what waits. Call it last.
  void finish() {
    packets_.finish(number_, [&](const PacketArrivals& arrived) { arrive(arrived); });
  }

 private:
  void arrive(const PacketArrivals& arrived) {
    if (arrivals_ != nullptr) {
      BitLanes bits;
      packets_.specular().draw_bits(choice_, arrived.block, number_, bits);
      alignas(64) float power[16];
      power_of(arrived.block, power);
      arrivals_->find16(arrived.hits.points(), arrived.zones, power, bits.word, points_);
    }
    ask_for_accounts(arrived);
    // The compiler cannot know that booking leaves the members of this object alone.
    const std::size_t values = values_;
    const bool shared = shared_;
    std::int64_t* const accounts = incident_.quanta.data();
    const std::int64_t* const power = arrived.block.power.data();
    for_lanes(arrived.in_zones, [&](int lane) {
      const std::size_t account = arrived.zones[lane] * values;
      const std::size_t from = static_cast<std::size_t>(lane) * values;
      for (std::size_t c = 0; c < values; ++c) book(accounts[account + c], power[from + c], shared);
    });
    if (!incident_.packets.empty())
      for_lanes(arrived.in_zones, [&](int lane) { book(incident_.packets[arrived.zones[lane]], 1, shared); });
    if (arrivals_ != nullptr) for_lanes(arrived.in_zones, [&](int lane) { arrivals_->add(points_, lane); });
    WaitingPackets& carried = packets_.carried();
    const std::size_t carried_before = carried.count();
    for_lanes(arrived.specular, [&](int lane) {
      packets_.specular().carry_on(arrived.block, arrived.hits, lane, number_, carried);
    });
    if (holds_beyond_) carried.move_beyond(*holds_beyond_, held_, carried_before);
  }

  /// Of each packet, all channels together [quanta].
  void power_of(const PacketBlock& block, float* power) const {
    const std::int64_t* of_channel = block.power.data();
    for (int lane = 0; lane < 16; ++lane) {
      std::int64_t sum = 0;
      for (std::size_t c = 0; c < values_; ++c) sum += *of_channel++;
      power[lane] = static_cast<float>(sum);
    }
  }

  /// Asks for the memory of all accounts at once, before the first is needed: with many zones the books are
  /// larger than the caches.
  void ask_for_accounts(const PacketArrivals& arrived) {
    for_lanes(arrived.in_zones, [&](int lane) {
      __builtin_prefetch(&incident_.quanta[arrived.zones[lane] * values_], 1);
      incident_.touch(arrived.zones[lane]);
    });
    if (arrivals_ != nullptr)
      for_lanes(arrived.in_zones, [&](int lane) { arrivals_->ask_for(points_, lane); });
  }

  std::uint32_t number_;
  std::size_t values_;  // of each packet
  bool shared_;
  CounterRng choice_;
  ArrivalPoints* arrivals_;
  SweepAccounts::Incident& incident_;
  PacketTracer packets_;
  WaitingPackets held_;
  std::optional<LightPart> holds_beyond_;
  ArrivalLanes points_;
};

/// Traces the flight of sweep `number` and books every packet where it ends. In the first sweep, packets that
/// mirrors, glass and opal sheets sent another way are left in `held`: their light is not direct. False if it
/// was cut off: packets that have not set out are unshot.
bool trace_flight(const BatchTask& batch, const Flight& flight, std::uint32_t number, ArrivalPoints* arrivals,
                  SweepAccounts& sweep, WaitingPackets& held, BatchBooks& books) {
  const PacketRoom& transport = batch.transport;
  const FlightNumbers numbers(batch.settings.sampling, batch.settings.seed, batch.batch, number);
  const ArrivalPoints* points = number == 0 ? nullptr : arrivals;  // luminaires have none
  const std::uint32_t tasks = (flight.packets() + kPacketsPerTask - 1) / kPacketsPerTask;
  std::atomic<bool> whole = true;
  std::atomic<std::uint64_t> rays{0};
  std::mutex held_mutex;
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, tasks, 1), [&](const auto& range) {
    SweepTracer tracer(batch, number, arrivals, sweep, books);
    if (number == 0) tracer.hold_beyond(LightPart::kDirect);
    PacketBlock block(transport.channels());
    for (std::uint32_t task = range.begin(); task != range.end(); ++task) {
      const std::uint32_t begin = task * kPacketsPerTask;
      const std::uint32_t end = std::min(flight.packets(), begin + kPacketsPerTask);
      if (batch.stop != nullptr && batch.stop->requested()) {
        leave_unshot(flight, begin, end, books);
        whole = false;
        continue;
      }
      FlightCursor cursor(transport, flight, begin, points);
      for (std::uint32_t first = begin; first < end; first += 16) {
        block.number(first, static_cast<int>(std::min<std::uint32_t>(16, end - first)));
        const int behind = cursor.start16(first, block.count, numbers, block.rays, block.power.data());
        if (behind > 0) count_event(books.events.starts_behind, static_cast<std::uint64_t>(behind));
        tracer.trace(block);
      }
    }
    tracer.finish();
    rays += tracer.rays();
    if (tracer.held().count() > 0) {
      const std::lock_guard lock(held_mutex);
      held.append(tracer.held());
    }
  });
  books.rays += rays;
  return whole;
}

/// Traces those of the packets that trace_flight left whose light is of this part, into sweep.incident. Those
/// beyond it stay in `held`.
void trace_held(const BatchTask& batch, LightPart part, WaitingPackets& held, ArrivalPoints* arrivals,
                SweepAccounts& sweep, BatchBooks& books) {
  WaitingPackets packets(batch.transport.channels());
  std::swap(packets, held);
  packets.move_beyond(part, held);
  std::atomic<std::uint64_t> rays{0};
  std::mutex held_mutex;
  const std::size_t blocks = (packets.count() + 15) / 16;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks, kPacketsPerTask / 16), [&](const auto& range) {
    SweepTracer tracer(batch, 0, arrivals, sweep, books);
    tracer.hold_beyond(part);
    PacketBlock block(batch.transport.channels());
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      packets.copy(16 * i, block);
      tracer.trace(block);
    }
    tracer.finish();
    rays += tracer.rays();
    if (tracer.held().count() > 0) {
      const std::lock_guard lock(held_mutex);
      held.append(tracer.held());
    }
  });
  books.rays += rays;
}

/// Notes what has reached a zone, before it is moved.
void note_arrivals(SweepAccounts& sweep, std::size_t zone) {
  const auto sum_of = [&](const std::vector<std::int64_t>& accounts) {
    const auto first = accounts.begin() + static_cast<std::ptrdiff_t>(zone * sweep.values);
    return std::accumulate(first, first + static_cast<std::ptrdiff_t>(sweep.values), std::int64_t{0});
  };
  SweepAccounts::Arrived& arrived = sweep.arrived[zone];
  if (sum_of(sweep.unshot) == 0) arrived = {};
  for (SweepAccounts::Incident& copy : sweep.incident) {
    arrived.packets += std::exchange(copy.packets[zone], 0);
    arrived.power += sum_of(copy.quanta);
  }
}

/// Moves what a sweep brought in into `part` of the books; the reflected share becomes unshot power.
void reflect(const PacketRoom& transport, SweepAccounts& sweep, std::vector<std::int64_t>& part,
             BatchBooks& books) {
  const Channels channels = transport.channels();
  const std::size_t values = channels.count();
  const ZoneMesh& mesh = transport.mesh();
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sweep.block_count(), 16), [&](const auto& range) {
    std::vector<std::int64_t> absorbed(values, 0);
    SurfaceId surface;
    const auto settle = [&] {
      for (std::size_t c = 0; c < values; ++c) {
        if (absorbed[c] != 0) book(books.absorbed[surface.index() * values + c], absorbed[c]);
        absorbed[c] = 0;
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
        const double* rho = transport.surface_model().reflectance(ZoneId(z), mesh.zone_triangle(ZoneId(z)),
                                                                  mesh.zone_is_front(ZoneId(z)));
        if (!sweep.arrived.empty()) note_arrivals(sweep, z);
        channels.for_each([&](std::size_t c, std::size_t band) {
          const std::size_t i = z * values + c;
          std::int64_t in = 0;
          for (std::int64_t* copy : copies) in += std::exchange(copy[i], 0);
          if (in == 0) return;
          const std::int64_t reflected = share_of(in, rho[band]);
          part[i] += in;
          sweep.unshot[i] += reflected;
          absorbed[c] += in - reflected;
        });
      }
    }
    settle();
  });
}

/// How long a batch goes on.
enum class BatchEnd { kWholeLight, kFirstFlight };

bool shoot(const BatchTask& task, BatchEnd end, BatchBooks& books) {
  const PacketRoom& transport = task.transport;
  const Channels channels = transport.channels();
  const CounterRng offsets(task.settings.seed, RngPurpose::kAllocation);
  // Sources that share packets otherwise than by power have packets of their own size. What they light is to
  // be carried on by as many, as walks do it: a lamp in a dark room would else be lost beside the sun.
  SweepAccounts accounts(transport.zones(), channels, !task.emission.packet_share.empty());

  Flight flight = plan_first_flight(task.emission, std::max(1U, task.packets / task.first_together),
                                    offsets.uniform4(0, task.batch, 0)[0]);
  for (std::size_t i = 0; i < flight.quanta.size(); ++i)
    books.emitted[i % channels.count()] += flight.quanta[i];
  const auto emitted =
      static_cast<double>(std::accumulate(books.emitted.begin(), books.emitted.end(), std::int64_t{0}));
  const std::uint32_t packets = std::max(flight.packets(), task.first_together > 1 ? task.packets : 0);
  books.packets += packets;
  const double quantum = emitted / packets;

  Allocation allocation(transport.zones(), channels, transport.needs());
  const double few = allocation.used_classes(accounts) > 1 ? kFewPackets * quantum : 0;
  std::optional<ArrivalPoints> arrivals;
  if (task.settings.reemission == Reemission::kFromHits) arrivals.emplace(transport.mesh(), flight.packets());
  bool whole = true;
  for (std::uint32_t sweep = 0;; ++sweep) {
    if (arrivals) {
      const auto power =
          static_cast<double>(std::accumulate(flight.quanta.begin(), flight.quanta.end(), std::int64_t{0}));
      const auto bits = offsets.bits4(1, task.batch, sweep);
      arrivals->begin(sweep, power / flight.packets(), std::uint64_t{bits[0]} << 32 | bits[1]);
    }
    ArrivalPoints* points = arrivals ? &*arrivals : nullptr;
    WaitingPackets held(channels);
    whole = trace_flight(task, flight, sweep, points, accounts, held, books);
    reflect(transport, accounts, sweep == 0 ? books.direct : books.indirect, books);
    if (held.count() > 0 && !books.caustic.empty()) {
      trace_held(task, LightPart::kCaustic, held, points, accounts, books);
      reflect(transport, accounts, books.caustic, books);
    }
    if (held.count() > 0) {
      trace_held(task, LightPart::kIndirect, held, points, accounts, books);
      reflect(transport, accounts, books.indirect, books);
    }
    const double left = allocation.measure(accounts, sweep == 0 ? quantum * task.first_together : quantum);
    if (!whole || left == 0 || end == BatchEnd::kFirstFlight || sweep + 1 == kMostSweeps) break;
    whole = task.stop == nullptr || !task.stop->requested();
    if (!whole) break;
    // From here on the power is in the flight, which must be traced before the batch may end.
    const bool walks = left <= std::max(task.settings.stop_share * emitted, few);
    const double wanted = walks ? std::min(kWalkingShare * packets, left / kLeastQuantaOfWalk)
                                : std::min(left / quantum, static_cast<double>(packets));
    const double sent = std::max(1.0, std::round(wanted));
    allocation.plan(accounts, left / sent, offsets.uniform4(0, task.batch, sweep + 1)[0], flight, books);
    if (!walks) continue;
    if (arrivals) arrivals->begin(sweep + 1, left / sent, 0);
    whole = walk_flight(task, flight, sweep + 1, points, books);
    break;
  }
  for (std::size_t i = 0; i < accounts.unshot.size(); ++i)
    books.unshot[i % channels.count()] += accounts.unshot[i];
  return whole;
}

}  // namespace

bool shoot_batch(const BatchTask& task, BatchBooks& books) {
  return shoot(task, BatchEnd::kWholeLight, books);
}

bool shoot_first_flight(const BatchTask& task, BatchBooks& books) {
  return shoot(task, BatchEnd::kFirstFlight, books);
}

}  // namespace reemit

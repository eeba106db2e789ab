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
#include "solver/shoot/packet_books.h"
#include "solver/shoot/specular_packets.h"

namespace reemit {
namespace {

constexpr std::uint32_t kPacketsPerTask = 4096;
/// A batch ends here even when power is left (a sealed part whose walls reflect everything); the rest is
/// unshot.
constexpr std::uint32_t kMostSweeps = 200'000;

/// Account that a packet is booked to, and whether other threads may book to it at the same time.
struct Account {
  std::int64_t* quanta = nullptr;  ///< By channel; null if the packet left the room or needs a second look.
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
  const std::size_t channels = transport.channels().count();
  std::uint32_t zones[16];
  transport.zones_of(hits, zones);
  for (int lane = 0; lane < count; ++lane) {
    const std::uint32_t t = hits.triangle[lane];
    accounts[lane] = {};
    const ZoneId zone(zones[lane]);
    if (!second_look ? !zone.valid() || transport.rays().is_at_edge(hits, lane) : t == RayTracer::kMiss)
      continue;
    if (zone.valid()) {
      accounts[lane] = {&incident.quanta[zone.index() * channels], shared};
      incident.touch(zone.index());
      if (arrivals != nullptr && ArrivalPoints::has_points(transport.mesh(), zone)) {
        if (transport.mesh().is_group(zone))
          accounts[lane].member = transport.mesh().member(TriangleId(t), hits.front[lane]);
        accounts[lane].place = arrivals->place(zone, bits[lane]);
        __builtin_prefetch(accounts[lane].place, 1);
      }
    } else {
      const SurfaceId surface = transport.mesh().triangle(TriangleId(t)).surface;
      accounts[lane] = {&books.absorbed_on_backs[surface.index() * channels], true};
      count_event(books.events.back_hits);
    }
    __builtin_prefetch(accounts[lane].quanta, 1);
  }
}

/// Traces packets of one sweep and books each where it ends. One per task.
class SweepTracer {
 public:
  /// `sweep.incident` receives what zones catch, and `arrivals`, if given, where.
  SweepTracer(const BatchTask& batch, std::uint32_t number, ArrivalPoints* arrivals, SweepAccounts& sweep,
              BatchBooks& books)
      : transport_(batch.transport),
        channels_(batch.transport.channels()),
        number_(number),
        observer_(batch.ray_observer),
        shared_(accounts_are_shared(sweep.incident.size())),
        choice_(batch.settings.seed, RngPurpose::kArrival),
        arrivals_(arrivals),
        books_(books),
        incident_(sweep.mine()),
        local_(books),
        specular_(batch, books),
        doubtful_(channels_),
        carried_(channels_),
        held_(channels_),
        waiting_(channels_) {}

  /// Packets whose way goes beyond this part of the light are held instead of traced on.
  void hold_beyond(LightPart part) { holds_beyond_ = part; }
  const WaitingPackets& held() const { return held_; }
  std::uint64_t carried_rays() const { return carried_rays_; }

  void trace(PacketBlock& block) {
    trace_and_book(block, false);
    if (doubtful_.count() >= 16) look_again();
    if (carried_.count() >= 16) trace_carried();
  }
  /// Traces what waits. Call it last.
  void finish() {
    while (doubtful_.count() + carried_.count() > 0) {
      if (doubtful_.count() > 0) look_again();
      if (carried_.count() > 0) trace_carried();
    }
  }
  /// Traces packets that were carried on from a surface.
  void trace_on(PacketBlock& block) {
    carried_rays_ += static_cast<std::uint64_t>(block.count);
    if (observer_ != nullptr) (*observer_)({block.rays, block.count, block.id, number_});
    trace_and_book(block, false);
    if (doubtful_.count() >= 16) look_again();
  }

 private:
  void look_again() {
    doubtful_.take(waiting_);
    trace_and_book(waiting_, true);
  }
  void trace_carried() {
    carried_.take(waiting_);
    trace_on(waiting_);
  }

  void trace_and_book(PacketBlock& block, bool second_look) {
    transport_.rays().closest16(block.rays, block.count, hits_);
    if (arrivals_ != nullptr) specular_.draw_bits(choice_, block, number_, bits_);
    find_accounts(transport_, hits_, block.count, incident_, shared_, second_look, arrivals_, bits_.word[0],
                  books_, accounts_);
    // The compiler cannot know that booking leaves the members of this object alone.
    const std::size_t channels = channels_.count();
    const std::uint32_t specular = specular_.any() ? specular_.lanes(block, hits_) : 0;
    const std::size_t carried_before = carried_.count();
    std::int64_t* quanta = block.power.data();
    for (int lane = 0; lane < block.count; ++lane, quanta += channels) {
      const Account& account = accounts_[lane];
      if (account.quanta == nullptr && !second_look && !transport_.rays().has_left(hits_.triangle[lane])) {
        doubtful_.add_doubtful(transport_.rays(), block, hits_, lane);
        local_.count_second_look();
        continue;
      }
      if ((specular >> lane & 1U) != 0) specular_.attenuate(block.way[lane], hits_, lane, quanta);
      if (account.place != nullptr) {
        if (account.member == Account::kNoMember)
          arrivals_->add(account.place, bits_.word[0][lane], hits_.u[lane], hits_.v[lane]);
        else
          arrivals_->add_in_group(account.place, bits_.word[0][lane], account.member, hits_.u[lane],
                                  hits_.v[lane]);
      }
      if (account.quanta == nullptr) {
        for (std::size_t c = 0; c < channels; ++c)
          local_.escape(block.rays.dx[lane], block.rays.dy[lane], block.rays.dz[lane], c, quanta[c]);
        continue;
      }
      if (account.shared)
        for (std::size_t c = 0; c < channels; ++c) book(account.quanta[c], quanta[c]);
      else
        for (std::size_t c = 0; c < channels; ++c) account.quanta[c] += quanta[c];
      if ((specular >> lane & 1U) != 0) specular_.carry_on(block, hits_, lane, number_, carried_);
    }
    if (holds_beyond_) carried_.move_beyond(*holds_beyond_, held_, carried_before);
  }

  const PacketRoom& transport_;
  Channels channels_;
  std::uint32_t number_;
  const RayObserver* observer_;
  bool shared_;
  CounterRng choice_;
  ArrivalPoints* arrivals_;
  BatchBooks& books_;
  SweepAccounts::Incident& incident_;
  LocalBooks local_;
  SpecularPackets specular_;
  WaitingPackets doubtful_;
  WaitingPackets carried_;
  WaitingPackets held_;
  PacketBlock waiting_;
  std::optional<LightPart> holds_beyond_;
  std::uint64_t carried_rays_ = 0;
  Hit16 hits_;
  Account accounts_[16];
  BitLanes bits_;
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
  std::atomic<std::uint64_t> started{0};
  std::atomic<std::uint64_t> carried{0};
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
        continue;
      }
      started += end - begin;
      FlightCursor cursor(transport, flight, begin, points);
      for (std::uint32_t first = begin; first < end; first += 16) {
        block.count = static_cast<int>(std::min<std::uint32_t>(16, end - first));
        const int behind = cursor.start16(first, block.count, numbers, block.rays, block.power.data());
        if (behind > 0) count_event(books.events.starts_behind, static_cast<std::uint64_t>(behind));
        std::iota(block.id, block.id + 16, first);
        if (batch.ray_observer != nullptr) (*batch.ray_observer)({block.rays, block.count, block.id, number});
        tracer.trace(block);
      }
    }
    tracer.finish();
    carried += tracer.carried_rays();
    if (tracer.held().count() > 0) {
      const std::lock_guard lock(held_mutex);
      held.append(tracer.held());
    }
  });
  books.rays += started + carried;
  return started == flight.packets();
}

/// Traces those of the packets that trace_flight left whose light is of this part, into sweep.incident. Those
/// beyond it stay in `held`.
void trace_held(const BatchTask& batch, LightPart part, WaitingPackets& held, ArrivalPoints* arrivals,
                SweepAccounts& sweep, BatchBooks& books) {
  WaitingPackets packets(batch.transport.channels());
  std::swap(packets, held);
  packets.move_beyond(part, held);
  std::atomic<std::uint64_t> carried{0};
  std::mutex held_mutex;
  const std::size_t blocks = (packets.count() + 15) / 16;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks, kPacketsPerTask / 16), [&](const auto& range) {
    SweepTracer tracer(batch, 0, arrivals, sweep, books);
    tracer.hold_beyond(part);
    PacketBlock block(batch.transport.channels());
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      packets.copy(16 * i, block);
      tracer.trace_on(block);
    }
    tracer.finish();
    carried += tracer.carried_rays();
    if (tracer.held().count() > 0) {
      const std::lock_guard lock(held_mutex);
      held.append(tracer.held());
    }
  });
  books.rays += carried;
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

}  // namespace

bool shoot_batch(const BatchTask& task, BatchBooks& books) {
  const PacketRoom& transport = task.transport;
  const Channels channels = transport.channels();
  const CounterRng offsets(task.settings.seed, RngPurpose::kAllocation);
  SweepAccounts accounts(transport.zones(), channels);

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
  std::optional<ArrivalPoints> arrivals;
  if (task.settings.reemission == Reemission::kFromHits)
    arrivals.emplace(transport.zones(), flight.packets());
  bool whole = true;
  for (std::uint32_t sweep = 0;; ++sweep) {
    if (arrivals) arrivals->begin(sweep);
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
    const auto left = static_cast<double>(allocation.measure(accounts));
    if (!whole || left <= task.settings.stop_share * emitted || sweep + 1 == kMostSweeps) break;
    whole = task.stop == nullptr || !task.stop->requested();
    if (!whole) break;
    // From here on the power is in the flight, which must be traced before the batch may end.
    const double sent = std::max(1.0, std::round(left / quantum));
    allocation.plan(accounts, left / sent, offsets.uniform4(0, task.batch, sweep + 1)[0], flight, books);
  }
  for (std::size_t i = 0; i < accounts.unshot.size(); ++i)
    books.unshot[i % channels.count()] += accounts.unshot[i];
  return whole;
}

bool shoot_first_flight(const BatchTask& task, BatchBooks& books) {
  SolverSettings settings = task.settings;
  settings.stop_share = 1;
  return shoot_batch({.transport = task.transport,
                      .emission = task.emission,
                      .settings = settings,
                      .batch = task.batch,
                      .packets = task.packets,
                      .stop = task.stop,
                      .ray_observer = task.ray_observer,
                      .first_together = task.first_together},
                     books);
}

}  // namespace reemit

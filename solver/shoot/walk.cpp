#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "solver/shoot/packet_tracer.h"
#include "solver/shoot/walk_flight.h"

namespace reemit {
namespace {

constexpr std::uint32_t kWalksPerTask = 1024;
/// A walk ends here even when nothing has absorbed it (a sealed part whose walls reflect everything); its
/// power is unshot.
constexpr std::uint32_t kMostBounces = 200'000;

/// Packets that wait to leave what they met and were scattered by.
struct ScatteredPackets {
  struct Packet {
    std::uint32_t triangle;  ///< That it met,
    float at_u, at_v;        ///< where
    bool front;              ///< and on which side.
    std::uint32_t id;        ///< Number within the flight: selects the random numbers.
    std::array<float, 4> u;  ///< Uniform, for the point and direction it leaves with.
  };
  std::vector<Packet> packets;
  std::vector<std::int64_t> quanta;  ///< [packet * channels + channel]

  void clear() {
    packets.clear();
    quanta.clear();
  }
};

/// Uniform number in [0,1) from the low bytes of four random words, whose high 24 bits make four others.
float low_bytes_to_unit(const BitLanes& bits, std::size_t lane) {
  std::uint32_t low = 0;
  for (const auto& word : bits.word) low = (low << 8) | (word[lane] & 0xffU);
  return CounterRng::to_unit(low);
}

/// Accounts of one thread, indexed as those of BatchBooks; of all threads if there is one copy only.
struct WalkAccounts {
  std::vector<std::int64_t> direct;
  std::vector<std::int64_t> caustic;
  std::vector<std::int64_t> indirect;
  std::vector<std::int64_t> absorbed;
  std::uint64_t rays = 0;
};

/// Follows packets, 16 rays at a time; those that end make room so that blocks stay full.
class WalkTask {
 public:
  /// `first`: number of the flight, as of walk_flight.
  WalkTask(const BatchTask& task, std::uint32_t first, BatchBooks& books, WalkAccounts& zones,
           std::vector<std::int64_t>& absorbed, bool shared)
      : first_(first),
        transport_(task.transport),
        channels_(task.transport.channels()),
        values_(channels_.count()),
        rng_(task.settings.seed, RngPurpose::kReflection),
        from_hits_(task.settings.reemission == Reemission::kFromHits),
        stop_(task.stop),
        books_(books),
        packets_(task, books),
        zones_(zones),
        absorbed_(absorbed),
        shared_(shared),
        block_(channels_) {}

  /// False if it was cut off: packets that have not ended, or not set out, are unshot.
  bool run(const Flight& flight, const FlightNumbers& numbers, const ArrivalPoints* points,
           std::uint32_t begin, std::uint32_t end) {
    if (stop_requested()) {
      leave_unshot(flight, begin, end, books_);
      return false;
    }
    start(flight, numbers, points, begin, end);
    for (std::uint32_t bounce = first_ + 1; !waiting_.packets.empty(); ++bounce) {
      const bool whole = !stop_requested();
      if (!whole || bounce == first_ + kMostBounces) {
        leave_waiting_unshot();
        return whole;
      }
      trace_on(bounce);
    }
    return true;
  }

  std::uint64_t rays() const { return packets_.rays(); }

 private:
  bool stop_requested() const { return stop_ != nullptr && stop_->requested(); }

  void start(const Flight& flight, const FlightNumbers& numbers, const ArrivalPoints* points,
             std::uint32_t begin, std::uint32_t end) {
    waiting_.clear();
    FlightCursor cursor(transport_, flight, begin, points);
    for (std::uint32_t first = begin; first < end; first += 16) {
      block_.number(first, static_cast<int>(std::min<std::uint32_t>(16, end - first)));
      const int behind = cursor.start16(first, block_.count, numbers, block_.rays, block_.power.data());
      if (behind > 0) count_event(books_.events.starts_behind, static_cast<std::uint64_t>(behind));
      trace(first_);
    }
    finish(first_);
  }

  void trace_on(std::uint32_t bounce) {
    std::swap(waiting_, leaving_);
    waiting_.clear();
    UniformLanes numbers{};
    for (std::size_t first = 0; first < leaving_.packets.size(); first += 16) {
      block_.count = static_cast<int>(std::min<std::size_t>(16, leaving_.packets.size() - first));
      for (int lane = 0; lane < block_.count; ++lane) {
        const ScatteredPackets::Packet& p = leaving_.packets[first + static_cast<std::size_t>(lane)];
        for (std::size_t d = 0; d < 4; ++d) numbers.u[d][lane] = p.u[d];
        block_.id[lane] = p.id;
        if (from_hits_)
          transport_.put_hit(p.triangle, p.at_u, p.at_v, p.front, lanes_, lane);
        else
          transport_.put_zone(transport_.zone_of(p.triangle, p.at_u, p.at_v, p.front), lanes_, lane,
                              lane + 1);
      }
      const std::uint32_t behind =
          transport_.start(lanes_, numbers, block_.rays) & ((1U << block_.count) - 1);
      if (behind != 0)
        count_event(books_.events.starts_behind, static_cast<std::uint64_t>(std::popcount(behind)));
      std::copy_n(&leaving_.quanta[first * values_], static_cast<std::size_t>(block_.count) * values_,
                  block_.power.begin());
      trace(bounce);
    }
    finish(bounce);
  }

  /// Traces block_, on its way after so many bounces.
  void trace(std::uint32_t bounce) {
    packets_.trace(block_, bounce, [&](const PacketArrivals& arrived) { arrive(arrived, bounce); });
  }
  void finish(std::uint32_t bounce) {
    packets_.finish(bounce, [&](const PacketArrivals& arrived) { arrive(arrived, bounce); });
  }

  /// Where the light of a packet is booked that came on a way of this part after so many bounces.
  std::vector<std::int64_t>& account_of(LightPart part, std::uint32_t bounce) {
    if (bounce > 0 || part == LightPart::kIndirect) return zones_.indirect;
    return part == LightPart::kCaustic ? zones_.caustic : zones_.direct;
  }

  /// Books where each packet comes to, and keeps those that survive.
  void arrive(const PacketArrivals& arrived, std::uint32_t bounce) {
    const PacketBlock& block = arrived.block;
    // The compiler cannot know that booking leaves the members of this object alone.
    const std::size_t values = values_;
    // With many zones the books are larger than the caches.
    const std::vector<std::int64_t>& incident = account_of(LightPart::kDirect, bounce);
    for_lanes(arrived.in_zones,
              [&](int lane) { __builtin_prefetch(&incident[arrived.zones[lane] * values], 1); });
    BitLanes bits;
    packets_.specular().draw_bits(rng_, block, bounce, bits);
    for_lanes(arrived.in_zones, [&](int lane) {
      std::int64_t* account = &account_of(block.way[lane].part, bounce)[arrived.zones[lane] * values];
      const std::int64_t* quanta = &block.power[static_cast<std::size_t>(lane) * values];
      for (std::size_t c = 0; c < values; ++c) book(account[c], quanta[c], shared_);
    });
    for_lanes(arrived.in_zones, [&](int lane) { reflect(arrived, lane, bounce, bits); });
  }

  /// Absorbs a packet, scatters it, or sends it on as a ray.
  void reflect(const PacketArrivals& arrived, int lane, std::uint32_t bounce, const BitLanes& bits) {
    const PacketBlock& block = arrived.block;
    const Hit16& hits = arrived.hits;
    const ZoneId zone(arrived.zones[lane]);
    const auto k = static_cast<std::size_t>(lane);
    const std::int64_t* quanta = &block.power[k * values_];
    const SurfaceModel& surfaces = transport_.surface_model();
    const TriangleId met(hits.triangle[lane]);
    const double* rho = surfaces.reflectance(zone, met, hits.front[lane]);
    double survival = surfaces.largest_reflectance(zone, met, hits.front[lane]);
    std::int64_t* absorbed = &absorbed_[surfaces.surface(met, hits.front[lane]).index() * values_];
    const float u = low_bytes_to_unit(bits, k);
    const bool is_specular = (arrived.specular >> lane & 1U) != 0;
    const double on = is_specular ? static_cast<double>(packets_.specular().chances(hits, lane)) : 0;
    if (survival + on > 1) {
      // Powers that survive grow by as much as the odds of all ways are too large.
      if (survival + on > kUsualRoulette) count_event(books_.events.roulette_jumps);
      survival /= survival + on;
    }
    if (!(u < survival)) {
      for (std::size_t c = 0; c < values_; ++c) absorbed[c] += quanta[c];
      if (on > 0)
        packets_.specular().carry_on(block, hits, lane, bounce, u - static_cast<float>(survival),
                                     1 - static_cast<float>(survival), packets_.carried());
      return;
    }
    waiting_.packets.push_back(
        {hits.triangle[lane],
         hits.u[lane],
         hits.v[lane],
         hits.front[lane],
         block.id[lane],
         {CounterRng::to_unit(bits.word[0][k]), CounterRng::to_unit(bits.word[1][k]),
          CounterRng::to_unit(bits.word[2][k]), CounterRng::to_unit(bits.word[3][k])}});
    channels_.for_each([&](std::size_t c, std::size_t band) {
      const std::int64_t kept = share_of(quanta[c], rho[band] / survival);
      waiting_.quanta.push_back(kept);
      absorbed[c] += quanta[c] - kept;
    });
  }

  void leave_waiting_unshot() {
    for (std::size_t i = 0; i < waiting_.quanta.size(); ++i)
      book(books_.unshot[i % values_], waiting_.quanta[i]);
  }

  std::uint32_t first_;
  const PacketRoom& transport_;
  Channels channels_;
  std::size_t values_;  // of each packet
  CounterRng rng_;
  bool from_hits_;
  const StopToken* stop_;
  BatchBooks& books_;
  PacketTracer packets_;
  WalkAccounts& zones_;
  std::vector<std::int64_t>& absorbed_;  // of this thread alone
  bool shared_;
  ZoneLanes lanes_{};
  PacketBlock block_;
  ScatteredPackets waiting_;
  ScatteredPackets leaving_;
};

/// Adds the accounts of a thread, which may have none.
void add(const std::vector<std::int64_t>& from, std::vector<std::int64_t>& to) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, from.size(), 16384), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) to[i] += from[i];
  });
}

}  // namespace

bool walk_batch(const BatchTask& task, BatchBooks& books) {
  const CounterRng offsets(task.settings.seed, RngPurpose::kAllocation);
  const Flight flight = plan_first_flight(task.emission, task.packets, offsets.uniform4(0, task.batch, 0)[0]);
  for (std::size_t i = 0; i < flight.quanta.size(); ++i)
    books.emitted[i % books.channels.count()] += flight.quanta[i];
  books.packets += flight.packets();
  return walk_flight(task, flight, 0, nullptr, books);
}

bool walk_flight(const BatchTask& task, const Flight& flight, std::uint32_t number,
                 const ArrivalPoints* points, BatchBooks& books) {
  const FlightNumbers numbers(task.settings.sampling, task.settings.seed, task.batch, number);
  // Absorbed power is few numbers that every packet adds to, so each thread has its own in any case.
  const std::size_t copies = account_copies(2 * books.direct.size() + books.caustic.size());
  const bool shared = accounts_are_shared(copies);
  std::vector<WalkAccounts> accounts(static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
  for (std::size_t i = 0; i < accounts.size(); ++i) {
    accounts[i].absorbed.resize(books.absorbed.size());
    if (i >= copies) continue;
    accounts[i].direct.resize(books.direct.size());
    accounts[i].caustic.resize(books.caustic.size());
    accounts[i].indirect.resize(books.indirect.size());
  }
  std::atomic<bool> whole = true;
  const std::uint32_t tasks = (flight.packets() + kWalksPerTask - 1) / kWalksPerTask;
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, tasks, 1), [&](const auto& range) {
    const std::size_t thread = current_copy();
    WalkTask walk(task, number, books, accounts[shared ? 0 : thread], accounts[thread].absorbed, shared);
    for (std::uint32_t t = range.begin(); t != range.end(); ++t) {
      const std::uint32_t end = std::min(flight.packets(), (t + 1) * kWalksPerTask);
      if (!walk.run(flight, numbers, points, t * kWalksPerTask, end)) whole = false;
    }
    accounts[thread].rays += walk.rays();
  });
  for (const WalkAccounts& a : accounts) {
    add(a.direct, books.direct);
    add(a.caustic, books.caustic);
    add(a.indirect, books.indirect);
    add(a.absorbed, books.absorbed);
    books.rays += a.rays;
  }
  return whole;
}

}  // namespace reemit

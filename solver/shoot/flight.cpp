#include "solver/shoot/flight.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>

#include "solver/emit/punctual_emitter.h"

namespace reemit {
namespace {

std::uint64_t scramble_seed(std::uint64_t seed, std::uint32_t batch, std::uint32_t flight) {
  const auto bits = CounterRng(seed, RngPurpose::kScramble).bits4(0, batch, flight);
  return (std::uint64_t{bits[0]} << 32) | bits[1];
}

void add_by_share(const PacketSources& emission, std::uint32_t packets, double offset, Flight& flight) {
  double running = 0;
  double before = 0;
  for (std::size_t s = 0; s < emission.sources.size(); ++s) {
    running += emission.packet_share[s];
    const double upto = std::floor(running * packets + offset);
    flight.add(emission.sources[s], static_cast<std::uint32_t>(std::max(1.0, upto - before)));
    before = upto;
  }
}

}  // namespace

Flight plan_first_flight(const PacketSources& emission, std::uint32_t packets, double offset) {
  Flight flight;
  flight.quanta = emission.quanta;
  if (!emission.packet_share.empty()) {
    add_by_share(emission, packets, offset, flight);
    return flight;
  }
  double total = 0;
  for (const std::int64_t q : emission.quanta) total += static_cast<double>(q);
  double running = 0;
  double before = 0;
  for (std::size_t s = 0; s < emission.sources.size(); ++s) {
    for (const std::int64_t q : emission.quanta_of(s)) running += static_cast<double>(q);
    const double upto = std::floor(running / total * packets + offset);
    flight.add(emission.sources[s], static_cast<std::uint32_t>(std::max(1.0, upto - before)));
    before = upto;
  }
  return flight;
}

void leave_unshot(const Flight& flight, std::uint32_t begin, std::uint32_t end, BatchBooks& books) {
  const auto& first = flight.first_packet;
  auto source =
      static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), begin) - first.begin()) - 1;
  for (; source < flight.sources.size() && first[source] < end; ++source) {
    // As FlightCursor deals it out: equal shares, and the first packets carry what does not divide.
    const std::int64_t packets = first[source + 1] - first[source];
    const std::int64_t from = std::max(begin, first[source]) - first[source];
    const std::int64_t until = std::min(end, first[source + 1]) - first[source];
    for (std::size_t c = 0; c < books.channels.count(); ++c) {
      const std::int64_t quanta = flight.quanta[source * books.channels.count() + c];
      const std::int64_t remainder = quanta % packets;
      book(books.unshot[c],
           (until - from) * (quanta / packets) + std::min(until, remainder) - std::min(from, remainder));
    }
  }
}

FlightNumbers::FlightNumbers(SamplingKind kind, std::uint64_t seed, std::uint32_t batch, std::uint32_t flight)
    : kind_(kind),
      rng_(seed, RngPurpose::kEmission),
      sobol_(scramble_seed(seed, batch, flight)),
      batch_(batch),
      flight_(flight) {}

void FlightNumbers::get16(std::uint32_t first, UniformLanes& numbers) const {
  if (kind_ == SamplingKind::kSobol) {
    for (int d = 0; d < 4; ++d) sobol_.sample16(first, d, numbers.u[d]);
    return;
  }
  for (std::uint32_t i = 0; i < 16; ++i) {
    const auto x = rng_.uniform4(first + i, batch_, flight_);
    for (std::size_t d = 0; d < 4; ++d) numbers.u[d][i] = x[d];
  }
}

void FlightNumbers::get_directions16(std::uint32_t first, UniformLanes& numbers) const {
  if (kind_ == SamplingKind::kSobol) {
    for (int d = 0; d < 2; ++d) {
      std::fill(std::begin(numbers.u[d]), std::end(numbers.u[d]), 0.0F);
      sobol_.sample16(first, d, numbers.u[2 + d]);
    }
    return;
  }
  get16(first, numbers);
}

FlightCursor::FlightCursor(const PacketRoom& transport, const Flight& flight, std::uint32_t first_packet,
                           const ArrivalPoints* arrivals)
    : transport_(transport),
      flight_(flight),
      arrivals_(arrivals),
      values_(transport.channels().count()),
      share_(values_),
      remainder_(values_) {
  const auto after = std::upper_bound(flight.first_packet.begin(), flight.first_packet.end(), first_packet);
  enter_source(static_cast<std::size_t>(after - flight.first_packet.begin()) - 1);
}

void FlightCursor::enter_source(std::size_t source) {
  current_ = source;
  begin_ = flight_.first_packet[source];
  end_ = flight_.first_packet[source + 1];
  const std::int64_t packets = end_ - begin_;
  if (arrivals_ != nullptr) dealer_ = arrivals_->deal(flight_.sources[source].zone, end_ - begin_);
  for (std::size_t c = 0; c < values_; ++c) {
    const std::int64_t quanta = flight_.quanta[source * values_ + c];
    share_[c] = packets == 1 ? quanta : quanta / packets;
    remainder_[c] = quanta - share_[c] * packets;
  }
}

bool FlightCursor::put_arrivals(ZoneId zone, std::uint32_t packet, int first, int last) {
  if (!arrivals_->has_points(zone)) return false;
  if (transport_.mesh().is_group(zone)) return put_arrivals_in_group(zone, packet, first, last);
  const auto triangle = static_cast<std::uint32_t>(transport_.mesh().zone_triangle(zone).index());
  transport_.put_side(triangle, transport_.mesh().zone_is_front(zone), lanes_, first, last);
  for (int lane = first; lane < last; ++lane, ++packet) {
    const auto at = dealer_.point(packet - begin_);
    if (!at) return false;
    transport_.put_point(triangle, at->u, at->v, lanes_, lane);
  }
  return true;
}

bool FlightCursor::put_arrivals_in_group(ZoneId group, std::uint32_t packet, int first, int last) {
  const bool front = transport_.mesh().zone_is_front(group);
  for (int lane = first; lane < last; ++lane, ++packet) {
    const auto at = dealer_.point_in_group(packet - begin_);
    if (!at) return false;
    const TriangleId t = transport_.mesh().member_triangle(group, at->member);
    transport_.put_hit(static_cast<std::uint32_t>(t.index()), at->u, at->v, front, lanes_, lane);
  }
  return true;
}

int FlightCursor::start16(std::uint32_t first, int count, const FlightNumbers& numbers, Ray16& rays,
                          std::int64_t* quanta) {
  std::array<const PacketSource*, 16> special{};  // those that do not send packets as zones reflect them
  bool any_special = false;
  bool any_uniform = false;  // points are to be drawn
  for (int lane = 0; lane < count;) {
    const std::uint32_t packet = first + static_cast<std::uint32_t>(lane);
    while (packet >= end_) enter_source(current_ + 1);
    const int until = static_cast<int>(std::min(end_ - first, static_cast<std::uint32_t>(count)));
    const PacketSource& s = flight_.sources[current_];
    if (arrivals_ == nullptr || !put_arrivals(s.zone, packet, lane, until)) {
      if (s.zone.valid()) transport_.put_zone(s.zone, lanes_, lane, until);
      any_uniform = true;
    }
    if (!s.zone.valid() || s.exponent != 0) {
      std::fill(&special[static_cast<std::size_t>(lane)], special.data() + until, &s);
      any_special = true;
    }
    std::int64_t k = packet - begin_;
    for (; lane < until; ++lane, ++k)
      for (std::size_t c = 0; c < values_; ++c) *quanta++ = share_[c] + (k < remainder_[c] ? 1 : 0);
  }
  UniformLanes x;
  if (any_uniform)
    numbers.get16(first, x);
  else
    numbers.get_directions16(first, x);
  std::uint32_t behind = transport_.start(lanes_, x, rays) & ((1U << count) - 1);
  for (int lane = 0; any_special && lane < count;) {
    const PacketSource* s = special[static_cast<std::size_t>(lane)];
    int until = lane + 1;
    while (until < count && special[static_cast<std::size_t>(until)] == s) ++until;
    if (s != nullptr) behind = start_special(*s, x, lane, until, rays) | (behind & ~lane_bits(lane, until));
    lane = until;
  }
  return std::popcount(behind);
}

std::uint32_t FlightCursor::start_special(const PacketSource& source, const UniformLanes& x, int first,
                                          int last, Ray16& rays) const {
  std::uint32_t behind = 0;
  if (source.zone.valid()) {
    for (int lane = first; lane < last; ++lane) {
      const Vec3f local = sample_cosine_power(x.u[2][lane], x.u[3][lane], source.exponent + 1);
      if (transport_.start_from(source.zone, x.u[0][lane], x.u[1][lane], local, rays, lane))
        behind |= 1U << lane;
    }
    return behind;
  }
  std::array<LightRay, 16> starts;
  const std::span some = std::span(starts).first(static_cast<std::size_t>(last - first));
  transport_.start_light(source.light, {x.u[0] + first, x.u[1] + first, x.u[2] + first, x.u[3] + first},
                         some);
  for (const LightRay& start : some) rays.set(first++, start.origin, start.direction);
  return behind;
}

}  // namespace reemit

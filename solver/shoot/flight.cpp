#include "solver/shoot/flight.h"

#include <algorithm>
#include <cmath>

namespace reemit {
namespace {

std::uint64_t scramble_seed(std::uint64_t seed, std::uint32_t batch, std::uint32_t flight) {
  const auto bits = CounterRng(seed, RngPurpose::kScramble).bits4(0, batch, flight);
  return (std::uint64_t{bits[0]} << 32) | bits[1];
}

TransportScene::ZonePatch empty_patch() {
  return {Vec3f::Zero(), Vec3f::Zero(), Vec3f::Zero(), Vec3f::Zero(), Frame(Vec3f::UnitZ())};
}

}  // namespace

Flight plan_emission_flight(const Emission& emission, std::size_t bands, std::uint32_t packets,
                            double offset) {
  Flight flight;
  flight.quanta = emission.quanta;
  double total = 0;
  for (const std::int64_t q : emission.quanta) total += static_cast<double>(q);
  double running = 0;
  double before = 0;
  for (std::size_t s = 0; s < emission.sources.size(); ++s) {
    for (std::size_t b = 0; b < bands; ++b) running += static_cast<double>(emission.quanta[s * bands + b]);
    const double upto = std::floor(running / total * packets + offset);
    flight.add(emission.sources[s], static_cast<std::uint32_t>(std::max(1.0, upto - before)));
    before = upto;
  }
  return flight;
}

FlightNumbers::FlightNumbers(SamplingKind kind, std::uint64_t seed, std::uint32_t batch, std::uint32_t flight)
    : kind_(kind),
      rng_(seed, RngPurpose::kEmission),
      sobol_(scramble_seed(seed, batch, flight)),
      batch_(batch),
      flight_(flight) {}

void FlightNumbers::get16(std::uint32_t first, float u[4][16]) const {
  if (kind_ == SamplingKind::kSobol) {
    for (int d = 0; d < 4; ++d) sobol_.sample16(first, d, u[d]);
    return;
  }
  for (std::uint32_t i = 0; i < 16; ++i) {
    const auto x = rng_.uniform4(first + i, batch_, flight_);
    for (std::size_t d = 0; d < 4; ++d) u[d][i] = x[d];
  }
}

FlightCursor::FlightCursor(const TransportScene& transport, const Flight& flight, std::uint32_t first_packet)
    : transport_(transport),
      flight_(flight),
      current_(static_cast<std::size_t>(
                   std::upper_bound(flight.first_packet.begin(), flight.first_packet.end(), first_packet) -
                   flight.first_packet.begin()) -
               1),
      patch_(empty_patch()) {
  enter_source();
}

void FlightCursor::enter_source() {
  if (current_ < flight_.sources.size() && flight_.sources[current_].zone.valid())
    patch_ = transport_.zone_patch(flight_.sources[current_].zone);
}

void FlightCursor::start16(std::uint32_t first, int count, const FlightNumbers& numbers, Ray16& rays,
                           std::uint32_t* source) {
  float u[4][16];
  numbers.get16(first, u);
  for (int lane = 0; lane < count; ++lane) {
    const std::uint32_t packet = first + static_cast<std::uint32_t>(lane);
    if (packet >= flight_.first_packet[current_ + 1]) {
      while (packet >= flight_.first_packet[current_ + 1]) ++current_;
      enter_source();
    }
    source[lane] = static_cast<std::uint32_t>(current_);
    const EmissionSource& s = flight_.sources[current_];
    if (s.zone.valid())
      TransportScene::start_ray(patch_, u[0][lane], u[1][lane], u[2][lane], u[3][lane], rays, lane);
    else
      start_light_ray(transport_.scene().lights[s.light], transport_.rays(), u[0][lane], u[1][lane],
                      u[2][lane], u[3][lane], rays, lane);
  }
}

}  // namespace reemit

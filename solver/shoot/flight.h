#pragma once
#include <cstdint>
#include <vector>

#include "solver/sampling/counter_rng.h"
#include "solver/sampling/sobol.h"
#include "solver/shoot/emission.h"
#include "solver/shoot/transport_scene.h"
#include "solver/solver_settings.h"

namespace reemit {

/// Packets that set out together: source s sends packets first_packet[s] .. first_packet[s+1]-1, which share
/// its quanta.
struct Flight {
  std::vector<EmissionSource> sources;
  std::vector<std::uint32_t> first_packet{0};  ///< One more entry than sources.
  std::vector<std::int64_t> quanta;            ///< [source * bands + band]

  std::uint32_t packets() const { return first_packet.back(); }
  void clear() {
    sources.clear();
    first_packet.assign(1, 0);
    quanta.clear();
  }
  void add(EmissionSource source, std::uint32_t packet_count) {
    sources.push_back(source);
    first_packet.push_back(first_packet.back() + packet_count);
  }
};

/// Quanta of packet `k` of `n` that share `quanta`: equal to within one, and they add up exactly.
inline std::int64_t packet_share(std::int64_t quanta, std::uint32_t k, std::uint32_t n) {
  const std::int64_t each = quanta / n;
  return each + (static_cast<std::int64_t>(k) < quanta - each * n ? 1 : 0);
}

/// The first flight of a batch: `packets` packets over the luminaires in proportion to power, at least one
/// each. Sources keep exactly their own power; only how many packets carry it depends on `offset` in [0,1).
Flight plan_emission_flight(const Emission& emission, std::size_t bands, std::uint32_t packets,
                            double offset);

/// Uniform numbers of the packets of one flight: point on the source (2) and direction (2).
class FlightNumbers {
 public:
  FlightNumbers(SamplingKind kind, std::uint64_t seed, std::uint32_t batch, std::uint32_t flight);
  /// Numbers of packets first .. first+15, dimension-major u[4][16]. Pre: first is a multiple of 16.
  void get16(std::uint32_t first, float u[4][16]) const;

 private:
  SamplingKind kind_;
  CounterRng rng_;
  SobolSequence sobol_;
  std::uint32_t batch_;
  std::uint32_t flight_;
};

/// Source of a packet and its rays: walks along a flight in packet order.
class FlightCursor {
 public:
  FlightCursor(const TransportScene& transport, const Flight& flight, std::uint32_t first_packet);

  /// Starts packets first .. first+count-1 (first is a multiple of 16, count <= 16). source[lane] is the
  /// index of each packet's source within the flight.
  void start16(std::uint32_t first, int count, const FlightNumbers& numbers, Ray16& rays,
               std::uint32_t* source);

 private:
  void enter_source();
  const TransportScene& transport_;
  const Flight& flight_;
  std::size_t current_;
  TransportScene::ZonePatch patch_;
};

}  // namespace reemit

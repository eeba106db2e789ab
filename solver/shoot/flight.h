#pragma once
#include <cstdint>
#include <vector>

#include "solver/sampling/counter_rng.h"
#include "solver/sampling/sobol.h"
#include "solver/shoot/arrival_points.h"
#include "solver/shoot/packet_room.h"
#include "solver/shoot/packet_sources.h"
#include "solver/solution/solver_settings.h"
#include "solver/tally/batch_books.h"

namespace reemit {

/// Packets that set out together: source s sends packets first_packet[s] .. first_packet[s+1]-1, which share
/// its quanta.
struct Flight {
  std::vector<PacketSource> sources;
  std::vector<std::uint32_t> first_packet{0};  ///< One more entry than sources.
  std::vector<std::int64_t> quanta;            ///< [source * channels + channel]

  std::uint32_t packets() const { return first_packet.back(); }
  void clear() {
    sources.clear();
    first_packet.assign(1, 0);
    quanta.clear();
  }
  void add(PacketSource source, std::uint32_t packet_count) {
    sources.push_back(source);
    first_packet.push_back(first_packet.back() + packet_count);
  }
};

/// The first flight of a batch: `packets` packets over the luminaires in proportion to power, or by
/// PacketSources::packet_share, at least one each. Sources keep exactly their own power; only how many
/// packets carry it depends on `offset` in [0,1).
Flight plan_first_flight(const PacketSources& emission, std::uint32_t packets, double offset);

/// Books the power of packets begin .. end-1, which stay where they are, as unshot. Any thread may call it.
void leave_unshot(const Flight& flight, std::uint32_t begin, std::uint32_t end, BatchBooks& books);

/// Uniform numbers of the packets of one flight: point on the source (2) and direction (2).
class FlightNumbers {
 public:
  FlightNumbers(SamplingKind kind, std::uint64_t seed, std::uint32_t batch, std::uint32_t flight);
  /// Numbers of packets first .. first+15. Pre: first is a multiple of 16.
  void get16(std::uint32_t first, UniformLanes& numbers) const;
  /// Numbers of directions from the first two dimensions, the most even ones; those of points may be anything
  /// in [0,1).
  void get_directions16(std::uint32_t first, UniformLanes& numbers) const;

 private:
  SamplingKind kind_;
  CounterRng rng_;
  SobolSequence sobol_;
  std::uint32_t batch_;
  std::uint32_t flight_;
};

/// Rays and power of packets: walks along a flight in packet order.
class FlightCursor {
 public:
  /// Starts at packet `first_packet`, which the flight has. Zones send their packets from the points where
  /// others arrived, if given; else, and where nothing did, from uniform points.
  FlightCursor(const PacketRoom& transport, const Flight& flight, std::uint32_t first_packet,
               const ArrivalPoints* arrivals = nullptr);

  /// Starts packets first .. first+count-1 (first is a multiple of 16, count <= 16).
  /// quanta[lane * channels + channel] becomes the power of each. Returns how many of the rays start behind
  /// the face that they leave (RayTracer::starts_behind).
  int start16(std::uint32_t first, int count, const FlightNumbers& numbers, Ray16& rays,
              std::int64_t* quanta);

 private:
  void enter_source(std::size_t source);
  /// Puts the points from which packets `packet`, ... of a zone leave into lanes first .. last-1. False if
  /// nothing arrived in the zone.
  bool put_arrivals(ZoneId zone, std::uint32_t packet, int first, int last);
  bool put_arrivals_in_group(ZoneId group, std::uint32_t packet, int first, int last);
  /// Starts the packets of lanes first .. last-1 from a source that does not send them as zones reflect them.
  /// Returns which start behind the face that they leave, as bits.
  std::uint32_t start_special(const PacketSource& source, const UniformLanes& x, int first, int last,
                              Ray16& rays) const;

  const PacketRoom& transport_;
  const Flight& flight_;
  const ArrivalPoints* arrivals_;
  std::size_t values_;  // of each packet
  std::size_t current_ = 0;
  ArrivalPoints::Dealer dealer_;
  std::uint32_t begin_ = 0;  // packets of the current source
  std::uint32_t end_ = 0;
  std::vector<std::int64_t> share_;      // of one packet of the current source, per channel
  std::vector<std::int64_t> remainder_;  // the first so many packets carry one quantum more
  ZoneLanes lanes_{};
};

}  // namespace reemit

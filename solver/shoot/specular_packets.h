#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "solver/reflect/specular.h"
#include "solver/sampling/counter_rng.h"
#include "solver/shoot/packet_batch.h"
#include "solver/shoot/packet_books.h"

namespace reemit {

/// Sends packets on from mirrors and panes until they meet a surface that scatters them, or end. A packet
/// goes on with what such a surface sends its way over the chance of that choice; the surface absorbs what of
/// the arriving power goes nowhere, which is less than nothing where a packet gains by being chosen: the
/// books balance for every packet, and absorbed power is right in the mean. One per task; not for several
/// threads.
class SpecularPackets {
 public:
  SpecularPackets(const BatchTask& task, BatchBooks& books);

  /// Whether any surface of the room sends packets on.
  bool any() const { return any_; }
  /// Random bits of the packets of a block; those of packets that were sent on differ from surface to
  /// surface.
  void draw_bits(const CounterRng& rng, const PacketBlock& block, std::uint32_t step, BitLanes& bits) const;
  /// Lanes, as bits, of packets that attenuate or carry_on may do something to: all others they may pass by.
  std::uint32_t lanes(const PacketBlock& block, const Hit16& hits) const;
  /// Takes from a packet's power, per channel, what a body of glass absorbed on the way to what it met.
  void attenuate(const SpecularWay& way, const Hit16& hits, int lane, std::int64_t* power) const;
  /// Sends the packet of a lane on from what it met, into `next`, if it met such a surface and is chosen.
  /// `step` tells the flights of a batch apart. It ends after kMostSteps as unshot, inside of glass after
  /// kMostStepsInGlass.
  void carry_on(const PacketBlock& block, const Hit16& hits, int lane, std::uint32_t step,
                WaitingPackets& next);
  /// The same by a given number, uniform in [0,most): the ways on have the chance `most` in all at most.
  void carry_on(const PacketBlock& block, const Hit16& hits, int lane, std::uint32_t step, float u,
                float most, WaitingPackets& next);
  /// Chances of the ways on from what a lane met, in all; 0 where there are none.
  float chances(const Hit16& hits, int lane);

 private:
  void carry_on(const PacketBlock& block, const Hit16& hits, int lane, float u,
                const std::array<float, 2>& spread, float most, WaitingPackets& next);
  /// Names the random numbers of a packet at what it met.
  static std::uint64_t number_of(const PacketBlock& block, int lane) {
    return std::uint64_t{block.way[lane].steps} << 32 | block.id[lane];
  }

  /// Mirrors that face each other may send a packet to and fro for ever.
  static constexpr std::uint32_t kMostSteps = 1U << 17;
  /// Where a luminaire stands in a ball of clear glass, much of its light is reflected totally for ever,
  /// always at the same angle. What gets out at all does so sooner.
  static constexpr std::uint32_t kMostStepsInGlass = 1U << 10;

  const RayTracer& rays_;
  const SurfaceModel& surfaces_;
  const ZoneMesh& mesh_;
  BatchBooks& books_;
  CounterRng rng_;
  std::uint32_t batch_;
  bool any_;
  Channels channels_;
  SpecularStep way_;
  std::vector<std::int64_t> power_;
};

}  // namespace reemit

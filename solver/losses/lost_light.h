#pragma once
#include <string>
#include <vector>

#include "scenes/model/stop_check.h"
#include "solver/shoot/packet_sources.h"
#include "solver/solution/solution.h"

namespace reemit {

/// Power that a solved room loses in one place.
struct LightLoss {
  enum class Way : std::uint8_t {
    kGap,      ///< Leaves through a gap that is narrow against the room.
    kOutside,  ///< Leaves from a place that has nothing before it: the light was outside already.
    kOpening,  ///< Leaves through an opening.
  };
  Way way = Way::kGap;
  double share = 0;                 ///< Of the emitted power, by probes.
  double width = 0;                 ///< Of a gap [m].
  Vec3 place{0, 0, 0};              ///< [m]
  std::vector<SurfaceId> surfaces;  ///< That make the rim of a gap, or that the light left from; two at most.
};

/// Light that leaves the room.
struct EscapedLight {
  std::vector<LightLoss> places;  ///< Where it does so; largest first.
  double through_gaps = 0;        ///< Share of the emitted power [0,1], by probes.
  double through_openings = 0;    ///< Share of the emitted power [0,1], by probes.
  double share = 0;               ///< Of the emitted power [0,1], all together, by probes.
};
/// By probes that leave luminaires and zones as their light does. What goes out through panes, sheets that
/// transmit and the holes of cut-outs is meant to, and not counted. Deterministic. Throws Interrupted when
/// `stop` (may be null) is requested.
EscapedLight find_escapes(const PacketRoom& transport, const PacketSources& emission,
                          const Solution& solution, const StopToken* stop = nullptr);

/// Warnings about light that a room loses although its faces close, with share, place and surfaces: light
/// that escapes, but for what goes out through windows (find_escapes), and light that ends on backs of
/// one-sided faces, of luminaires only if it is more than 1 %; before them that most of the space that
/// faces enclose is dark (dark_space.h), and then nothing of what escapes outside of it; where light comes
/// from outside, only if a camera looks at the dark or there is none. Faces count as closed when at most 1 %
/// of the light leaves through openings, or 5 % if most of what leaves does so through gaps. A room with an
/// opening (the Cornell box) loses light by intent and gets no warning, nor does one that is mostly outdoors.
/// Where directional lights or a sky shine in from outside, only gaps count. Reads Solution::audit and sums.
/// Throws Interrupted when `stop` (may be null) is requested.
std::vector<std::string> lost_light_warnings(const PacketRoom& transport, const PacketSources& emission,
                                             const Solution& solution, const StopToken* stop = nullptr);

}  // namespace reemit

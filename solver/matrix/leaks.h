#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/emit/punctual_emitter.h"
#include "solver/trace/ray_tracer.h"

namespace reemit {

/// A place where power ends that is not a zone.
struct LeakAccount {
  static constexpr std::uint32_t kAxes = 6;
  /// Below kAxes: left the room, by the nearest axis as in BandAudit::escaped. Else kAxes + surface: met the
  /// back of a one-sided face of that surface.
  std::uint32_t account = 0;
  std::uint32_t rays = 0;
};

/// For each zone, where those of its cosine-distributed rays ended that met no zone. They say how the part of
/// its power that no form factor accounts for is shared out, and whether the room around it is closed.
class ZoneLeaks {
 public:
  static constexpr std::uint32_t kRaysPerZone = 256;

  ZoneLeaks() = default;
  explicit ZoneLeaks(std::vector<std::vector<LeakAccount>> of_zone) : of_zone_(std::move(of_zone)) {}

  /// No two of the same account; empty if all rays met zones.
  std::span<const LeakAccount> of(std::size_t zone) const { return of_zone_[zone]; }
  /// All rays met zones.
  bool closed(std::size_t zone) const { return of_zone_[zone].empty(); }

 private:
  std::vector<std::vector<LeakAccount>> of_zone_;
};

/// By kRaysPerZone rays from uniform points of every zone, in the task arena of the caller. The same for the
/// same seed on any number of threads.
ZoneLeaks trace_leaks(const RayTracer& rays, std::uint64_t seed);

inline constexpr std::uint32_t kRaysPerLight = 16384;
/// The same for kRaysPerLight rays of a luminaire without area, distributed as its power.
std::vector<LeakAccount> trace_light_leaks(const PunctualEmitter& light, const RayTracer& rays,
                                           std::uint64_t seed);

}  // namespace reemit

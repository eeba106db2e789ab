#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "scenes/model/stop_token.h"
#include "solver/gather/hemisphere_gather.h"
#include "solver/gather/path_tracer.h"
#include "solver/solution/zone_bias.h"
#include "solver/trace/surface_point.h"

namespace reemit {

/// How an estimate of the bias is made: from points in a few groups of neighbours, so that a bias that is
/// bright on one side of the room and dark on the other does not cancel, and yet every group has many rays.
struct ZoneBiasEffort {
  static constexpr std::size_t kGroups = 4;
  static constexpr std::size_t kPointsPerGroup = 64;
  static constexpr std::size_t kPoints = kGroups * kPointsPerGroup;

  std::uint32_t rays = 16;  ///< Per point [1, 2^16], a multiple of 16; each is gathered and path-traced.

  /// So many that the estimate takes some one to two per cent of the time that `rays` took.
  static ZoneBiasEffort of(double rays);
};

/// What the zones do to light gathered at kPoints points, those of a group one after the other: the
/// difference of gathered [GI98] and path-traced reflected radiance [W/(m2 sr)] along the same first rays,
/// times scale[i * bands + b], averaged over each group, and of that the rms over the groups, of the worst
/// band. With scale = 1/L that is a relative error. Replicates that read parts of the zone solution of their
/// own give the noise of the estimate, whose square is taken out: noise of rays and zones has no share in it
/// on the mean. Nothing where paths do not find all light (RadianceField::has_light_that_rays_miss). Runs in
/// parallel; the same for any number of threads. When `stop` (may be null) is requested it returns early, and
/// what it returns means nothing.
std::optional<ZoneBias> estimate_zone_bias(const HemisphereGather& gather, const PathTracer& path,
                                           std::span<const SurfacePoint> points,
                                           std::span<const double> scale, const ZoneBiasEffort& effort,
                                           std::uint64_t seed, const StopToken* stop = nullptr);

/// The same for light gathered all over the surfaces of the room, over its mean reflected radiance there.
/// `field`: of the solution, in as many parts as there are. Nothing without light, or when `stop` is
/// requested before it is done.
std::optional<ZoneBias> estimate_zone_bias(const RadianceField& field, const Solution& solution,
                                           const ZoneBiasEffort& effort, const StopToken& stop);

}  // namespace reemit

#pragma once
#include <cstdint>
#include <vector>

#include "solver/gather/direct_light.h"
#include "solver/gather/path_key.h"
#include "solver/gather/specular_path.h"
#include "solver/room/room.h"
#include "solver/sampling/counter_rng.h"
#include "solver/trace/surface_point.h"

namespace reemit {

/// Unbiased path tracer, the reference of every still: it uses the room and its materials only, no zone
/// value. Next-event estimation at every bounce, cosine-distributed bounces, Russian roulette by the largest
/// reflectance after kSafeBounces [KRI08]; from mirrors and glass it goes on as HemisphereGather does. Const
/// members may be called from any thread.
class PathTracer {
 public:
  static constexpr int kSafeBounces = 3;
  /// Survival at most: ends paths in rooms of reflectance 1. The weight grows to match.
  static constexpr float kLongestSurvival = 0.98F;

  PathTracer(const Room& room, const DirectLight& direct, std::uint64_t seed);

  /// Adds weight[b] times the reflected radiance seen along a cosine-distributed ray (u0,u1) from x to
  /// sum[b]: pi times its mean is the indirect irradiance at x. `weight` is used up. What comes from
  /// luminaires over mirrors, glass and gloss goes to caustic[b], unless that is null.
  void add_indirect(const SurfacePoint& x, float u0, float u1, const PathKey& key, float* weight, float* sum,
                    float* caustic = nullptr) const;

 private:
  const Room* room_;
  const DirectLight* direct_;
  CounterRng rng_;
  SpecularNumbers specular_;
};

}  // namespace reemit

#pragma once
#include <atomic>
#include <cstdint>
#include <functional>

#include "scenes/model/scene.h"
#include "solver/solution/solution.h"
#include "solver/trace/ray_scene.h"
#include "viewer_export/vertex/vertex_data.h"

namespace reemit {

/// How light at vertices is found.
struct VertexSettings {
  /// Take the area-weighted mean of the zones around a vertex instead of gathering there: quick, but as
  /// coarse as the zones.
  bool average_zones = false;
  /// Keep the backs of surfaces that no light reached and that do not emit.
  bool all_zones = false;
  int gather_rays = 512;    ///< Per vertex, rounded up [1, 1048576].
  int light_samples = 128;  ///< Shadow rays per vertex, rounded up [1, 65536].
  /// Reach of the sample points into the zones around a vertex, as a share of each zone (0, 1]. A vertex lies
  /// on the edges of other faces, so light is gathered inside the zones beside it. The mean place of the
  /// samples is the vertex itself in the middle of a surface, and reach/3 of a zone inside at its rim.
  double reach = 0.1;
  double close_hit = 1.0;  ///< GatherSettings::close_hit.
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0 = all cores. The values do not depend on it.
};

/// Gets the finished share of the work [0,1], from one thread at a time.
using VertexProgressCallback = std::function<void(double)>;

/// Light at the vertices of the zones, split at creases and between surfaces, materials and sides: direct
/// light by shadow rays and the rest by gather rays from points inside the zones around each vertex
/// ("Final gather at a point" of the documentation), plus self-emission. info.error is the relative rms
/// standard error of radiance weighted by vertex area, worst band. When `interrupt` becomes true, vertices
/// not yet done keep the mean of their zones. `progress` may be empty. Throws InputError for settings out of
/// range and a room that is not the one solved.
VertexData gather_vertices(const Scene& scene, const Solution& solution, const RayScene& rays,
                           const VertexSettings& settings, const VertexProgressCallback& progress,
                           const std::atomic<bool>& interrupt);

}  // namespace reemit

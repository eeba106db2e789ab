#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "solver/room/room.h"
#include "solver/solution/solution.h"
#include "viewer_export/vertex/vertex_data.h"

namespace reemit {

/// How light at vertices is found.
struct VertexSettings {
  /// Take the area-weighted mean of the zones around a vertex instead of gathering there: quick, but as
  /// coarse as the zones.
  bool average_zones = false;
  /// Take the noise out of what was gathered (smooth_vertices). With an error target that is reached before.
  bool smooth = false;
  /// Keep the backs of surfaces that no light reached and that do not emit.
  bool all_zones = false;
  std::vector<SurfaceId> only;  ///< Vertices of these surfaces alone; empty: of all.
  int gather_rays = 512;        ///< Per vertex, rounded up [1, 1048576].
  int light_samples = 128;      ///< Shadow rays per vertex, rounded up [1, 65536].
  /// Relative error to reach as a fraction [0, 1): sqrt(sum A s^2 / sum A L^2) over vertices, worst band,
  /// with s the standard error of reflected radiance L. 0 = take the samples above; else only their ratio
  /// counts.
  double error_target = 0;
  /// Reach of the sample points into the zones around a vertex, as a share of each zone (0, 1]. A vertex lies
  /// on the edges of other faces, so light is gathered inside the zones beside it. The mean place of the
  /// samples is the vertex itself in the middle of a surface, and reach/3 of a zone inside at its rim.
  double reach = 0.1;
  double close_hit = 1.0;  ///< GatherSettings::close_hit.
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0 = all cores. The values do not depend on it.

  int points_per_replicate() const;  ///< Places with one shadow ray each; a power of two.
  int gathers_per_point() const;     ///< Gather rays from each place.
};

/// Gets the finished share of the work [0,1], from one thread at a time.
using VertexProgressCallback = std::function<void(double)>;

/// Light at the vertices of the zones, split at creases and between surfaces, materials and sides: direct
/// light by shadow rays and the rest by gather rays from points inside the zones around each vertex
/// ("Final gather at a point" of the documentation), plus self-emission. Sixteen replicates, each with its
/// own part of the zone solution, give the standard errors, the noise of the zones included: 15 degrees of
/// freedom, so a 95 % interval is 2.13 standard errors to each side. info.error is the relative rms standard
/// error of radiance weighted by vertex area, worst band. With an error target, samples are doubled where the
/// error is too large, until it is reached or what is left is the noise of the zone solution
/// (VertexData::limited_by_zones). When `interrupt` becomes true, vertices not yet begun keep the mean of
/// their zones; on the way to an error target all have it (VertexData::gathered) while it has less noise than
/// what is gathered. `progress` may be empty. Throws InputError for settings out of range and a room that is
/// not the one solved.
VertexData gather_vertices(const Room& room, const Solution& solution, const VertexSettings& settings,
                           const VertexProgressCallback& progress, const std::atomic<bool>& interrupt);

}  // namespace reemit

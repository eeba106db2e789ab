#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "solver/gather/path_tracer.h"
#include "solver/gather/replicate_gather.h"
#include "solver/solution/zone_bias.h"
#include "viewer_export/vertex/vertex_data.h"
#include "viewer_export/vertex/vertex_layers.h"
#include "viewer_export/vertex/vertex_radiance.h"
#include "viewer_export/vertex/vertex_ring.h"

namespace reemit {

/// Points per replicate of a vertex that are gathered in one go: first .. first+count-1.
struct PointBlock {
  int first = 0;
  int count = 1;
};

/// Gathers light at vertices. Const members may be called from any thread for different vertices.
class VertexGatherer {
 public:
  /// Independent estimates of each vertex, each from its own part of the zone solution; their spread is the
  /// standard error.
  static constexpr std::size_t kReplicates = ZoneSums::kGroups;

  /// `most_points`: per replicate, a power of two that no block exceeds. Preparing ends early when `stop` is
  /// requested, and what is gathered then means little.
  VertexGatherer(const Room& room, const Solution& solution, const VertexRings& rings,
                 const VertexSettings& settings, int most_points, const StopToken& stop);
  VertexGatherer(const VertexGatherer&) = delete;
  VertexGatherer& operator=(const VertexGatherer&) = delete;

  const RadianceField& field() const { return field_; }
  /// Self-emitted radiance of the surface a vertex belongs to, one number per band [W/(m2 sr)].
  const float* emitted(std::size_t v, SurfaceModel::PointValues& here) const;
  /// Share of the light on the other side that comes through at a vertex; null where none does.
  const Spectrum* diffuse_transmittance(std::size_t v) const;
  /// Replicates of one vertex take this many numbers in `means` below.
  std::size_t values_per_vertex() const { return kReplicates * values_per_replicate(); }

  /// Adds a block of points to the means of vertices first .. last-1. means: per vertex and replicate, direct
  /// irradiance [W/m2] and mean reflected radiance over the hemisphere [W/(m2 sr)] per band, in rooms that
  /// bend light also that of luminaires over such surfaces, which is then no part of the second; in rooms
  /// with diffuse transmission also those of the other side; the first vertex at means[0]. Then overwrites
  /// the values of these vertices in `data`. False, and nothing changed, if `stop` was requested meanwhile.
  bool gather(std::size_t first, std::size_t last, const PointBlock& block, float* means,
              VertexData& data) const;
  /// Empty layers of all vertices, for the next.
  VertexLayers new_layers() const;
  /// Takes the light that reaches the side of vertices first .. last-1 apart; `means` as gather left them.
  void take_apart(std::size_t first, std::size_t last, const float* means, VertexLayers& layers) const;

  /// What the zones do to the gathered values of `data`, relative as VertexSettings::error_target: at places
  /// beside vertices all over the room, with about two per cent of the `rays` that the values took.
  std::optional<ZoneBias> zone_bias(const VertexData& data, double rays) const;

 private:
  PointSampler sampler_of(std::size_t v, int replicate) const;
  SurfacePoint point_beside(std::size_t v, const std::array<float, 2>& u) const;
  std::size_t values_per_side() const { return (has_caustics_ ? 3 : 2) * bands_; }
  std::size_t values_per_replicate() const { return (is_translucent_ ? 2 : 1) * values_per_side(); }
  void store(std::size_t v, const float* means, VertexData& data) const;

  const Room& room_;
  const VertexRings& rings_;
  const VertexSettings& settings_;
  StopToken stop_;
  RadianceField field_;
  DirectLight direct_;
  HemisphereGather gather_;
  PathTracer path_;
  std::size_t bands_;
  bool has_caustics_;
  bool is_translucent_;  // some surface of the room transmits diffusely
  int gathers_per_point_;
  int log2_points_;
};

}  // namespace reemit

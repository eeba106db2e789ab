#pragma once
#include <atomic>
#include <cstddef>
#include <mutex>
#include <vector>

#include "viewer_export/output/refinement.h"
#include "viewer_export/vertex/vertex_data.h"
#include "viewer_export/vertex/vertex_gatherer.h"
#include "viewer_export/vertex/vertex_radiance.h"
#include "viewer_export/vertex/vertex_ring.h"

namespace reemit {

/// sqrt(sum A s^2 / sum A L^2) over vertices, worst band, L without self-emission: a bright lamp known
/// without error would otherwise hide the noise of the room that it lights.
double relative_error(const VertexGatherer& gatherer, const VertexRings& rings, const VertexData& data);
WorstSurface worst_surface(const VertexGatherer& gatherer, const VertexRings& rings, const VertexData& data);

/// Decides how many samples vertices get, chunk of vertices by chunk, in parallel.
class VertexRefinement {
 public:
  VertexRefinement(const VertexGatherer& gatherer, const VertexRings& rings, const VertexSettings& settings,
                   const VertexProgressCallback& progress, const std::atomic<bool>& interrupt,
                   VertexData& data);

  /// Points per replicate that these settings may come to, a power of two.
  static int most_points(const VertexSettings& settings);

  /// Gathers all vertices, with the samples asked for or until the error target is reached.
  void run();
  /// What was gathered, taken apart, if vertices are to be smoothed; else empty.
  const VertexLayers& layers() const { return layers_; }

 private:
  void run_once();
  void run_to_target();
  bool choose_active(std::vector<RefinedPart>& parts);
  template <class Function>
  void for_chunks(Function&& function);

  std::size_t first(std::size_t chunk) const;
  std::size_t last(std::size_t chunk) const;

  const VertexGatherer& gatherer_;
  const VertexRings& rings_;
  const VertexSettings& settings_;
  const VertexProgressCallback& progress_;
  const std::atomic<bool>& interrupt_;
  VertexData& data_;
  VertexLayers layers_;  // empty unless vertices are to be smoothed
  std::size_t chunks_;
  double share_done_ = 0;
  std::mutex progress_mutex_;
};

}  // namespace reemit

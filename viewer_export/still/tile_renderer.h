#pragma once
#include "solver/gather/direct_light.h"
#include "solver/gather/hemisphere_gather.h"
#include "solver/gather/path_tracer.h"
#include "solver/gather/radiance_field.h"
#include "viewer_export/still/camera.h"
#include "viewer_export/still/film.h"
#include "viewer_export/still/render_still.h"

namespace reemit {

/// A rectangle of pixels [x0,x1) x [y0,y1).
struct Tile {
  static constexpr int kSize = 16;
  int x0, y0, x1, y1;
};

/// Renders one pass over one tile. Const members may be called from any thread for different tiles.
class TileRenderer {
 public:
  TileRenderer(const Scene& scene, const Solution& solution, const RayScene& rays,
               const PinholeCamera& camera, const StillSettings& settings);

  TileRenderer(const TileRenderer&) = delete;
  TileRenderer& operator=(const TileRenderer&) = delete;

  /// Adds an independent estimate made of `samples` (a power of two) camera rays to each pixel of the tile.
  void render(const Tile& tile, int pass, int samples, Film& film) const;

 private:
  struct PixelSums;

  void add_sample(double x, double y, int sample, PixelSums& sums, GatherBatch& batch) const;
  void add_light(const SurfacePoint& x, int sample, PixelSums& sums, GatherBatch& batch) const;
  SurfacePoint seen_point(const Hit& hit) const;

  const RayScene* rays_;
  const PinholeCamera* camera_;
  const StillSettings* settings_;
  RadianceField field_;
  DirectLight direct_;
  HemisphereGather gather_;
  PathTracer path_;
};

}  // namespace reemit

#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "solver/gather/gather_batch.h"
#include "solver/gather/point_sampler.h"
#include "solver/solution/zone_bias.h"
#include "viewer_export/still/camera.h"
#include "viewer_export/still/film.h"
#include "viewer_export/still/still_light.h"

namespace reemit {

/// A rectangle of pixels [x0,x1) x [y0,y1).
struct Tile {
  static constexpr int kSize = 16;
  int x0, y0, x1, y1;

  /// Numbers of its pixels in a picture of this width [px].
  std::vector<std::uint32_t> pixels(int width) const;
};

/// The tiles of a picture of this size [px].
std::vector<Tile> tiles_of(int width, int height);

/// Samples of some replicates of a pixel that are taken in one go.
struct SampleBlock {
  int first = 0;
  int samples = 1;
  int log2_samples = 0;  ///< No sample number of this picture reaches 2^log2_samples.
  /// Blocks that end by this sample number, a power of two, are of sequences that a pixel shares with those
  /// around it; 0: none.
  int shared = 0;
  int first_replicate = 0;
  int replicates = 1;
};

/// Renders tiles. Const members may be called from any thread for different tiles.
class TileRenderer {
 public:
  /// All must outlive the renderer. Once `stop` is requested, tiles hold zone values or what they had before.
  TileRenderer(const StillLight& light, const PinholeCamera& camera, const StopToken& stop);

  TileRenderer(const TileRenderer&) = delete;
  TileRenderer& operator=(const TileRenderer&) = delete;

  /// Whether films get a layer of caustics.
  bool has_caustics() const { return has_caustics_; }

  /// Adds samples first .. first+samples-1 of the replicates of the block to each of these pixels (by number
  /// in the picture), which have had as many as `first`; none if it was told to stop.
  void render(std::span<const std::uint32_t> pixels, const SampleBlock& block, Film& film) const;

  /// For a picture that ends before its first pass does: gives each square of `width` pixels of a tile the
  /// zone values that a ray through its middle sees, as one sample of the first replicate of each pixel.
  void fill_with_zones(const Tile& tile, int width, Film& film) const;

  /// What the zones do to the picture on the film, relative as StillSettings::error_target: from points seen
  /// through pixels all over it, with about two per cent of the rays of the picture. Exactly 0 for a
  /// path-traced one. Nothing if it is not known.
  std::optional<ZoneBias> zone_bias(const Film& film) const;

 private:
  struct PixelSums;
  struct Look;

  /// Of the film, that a pixel's samples add to: direct, indirect, albedo and, where they are, caustics.
  std::size_t layers() const { return has_caustics_ ? 4 : 3; }
  /// The random numbers of a replicate of a pixel.
  PointSampler sampler_of(std::uint32_t pixel, std::uint32_t width, int replicate,
                          const SampleBlock& block) const;
  /// Sums of a pixel over so many samples into layers() times bands values; `weight`: scratch, by band.
  PixelSums sums_into(float* values, std::uint64_t pixel, const PointSampler& sampler, int samples,
                      std::vector<float>& weight) const;
  void add_sample(double x, double y, int sample, PixelSums& sums, GatherBatch& batch) const;
  /// What scatters or emits at x, of which the film gets `through` per band; of what emits the share `found`.
  void add_seen(const SurfacePoint& x, const float* through, float found, int sample, PixelSums& sums,
                GatherBatch& batch) const;
  /// What the lobes of a rough surface at x send of luminaires that shadow rays find.
  void add_highlights(const SurfacePoint& x, const float* through, int sample, PixelSums& sums) const;
  void add_light(const SurfacePoint& x, const float* through, int sample, PixelSums& sums,
                 GatherBatch& batch) const;
  /// What comes of the light at x that a share of it, by band, is scattered into all directions. `index`
  /// chooses the random numbers.
  void add_scattered(const SurfacePoint& x, const float* share, std::uint64_t index, const float* through,
                     int sample, PixelSums& sums, GatherBatch& batch) const;
  /// Across what a camera ray stands for after such a way [normalised].
  float spot_at(double way) const;
  /// What is seen over x, a mirror, gloss or glass that a ray of length `way` met.
  void add_over_mirrors(SurfacePoint x, float way, int sample, PixelSums& sums, GatherBatch& batch) const;
  /// Adds what is seen over `from` along a step from there; the next look, if that meets a mirror, gloss or
  /// glass again.
  std::optional<Look> follow(const Look& from, const SpecularStep& step, int sample, PixelSums& sums,
                             GatherBatch& batch) const;
  /// What a camera sees of the sky where nothing stands before it.
  void add_sky(const Vec3f& along, PixelSums& sums) const;
  /// What is seen of it over mirrors, gloss or glass, of which the film gets `through` per band.
  /// `pdf_per_sr`: of a ray from a lobe, else 0.
  void add_sky_over_mirrors(const Vec3f& along, float pdf_per_sr, const float* through,
                            PixelSums& sums) const;
  SurfacePoint seen_point(const Hit& hit, const Vec3f& direction) const;

  const StillLight& light_;
  const Room* room_;
  const PinholeCamera* camera_;
  const StillSettings* settings_;
  const StopToken* stop_;
  const RadianceField& field_;
  const DirectLight& direct_;
  SpecularNumbers specular_;
  bool has_caustics_;
  std::vector<float> all_;  // by band: nothing is lost on the way to the eye
};

}  // namespace reemit

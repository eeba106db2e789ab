#include "viewer_export/still/render_still.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "scenes/model/stop_token.h"
#include "scenes/model/stopwatch.h"
#include "solver/solution/thread_count.h"
#include "viewer_export/output/refinement.h"
#include "viewer_export/still/smoothed_refinement.h"
#include "viewer_export/still/tile_renderer.h"

namespace reemit {
namespace {

/// Camera rays that a pixel's replicate gets in one block: few at first, so that an easy target is not
/// overshot, then more, up to this many.
constexpr int kSmallestBlock = 2;
constexpr int kLargestBlock = 8;
/// Camera rays per pixel before an error is believed.
constexpr int kFewestToStop = 16;
/// Of a picture that is refined after smoothing: share of the work before it, as far as progress is told.
constexpr double kShareOfFirst = 0.5;

struct TileState {
  Tile tile;
  RefinedPart part;
};

/// Sum of use(mean and error of a pixel in one band) over the pixels of a tile.
template <class Use>
double sum_over_pixels(const Film& film, const Tile& tile, std::size_t band, const Use& use) {
  double sum = 0;
  for (int y = tile.y0; y < tile.y1; ++y)
    for (int x = tile.x0; x < tile.x1; ++x)
      sum +=
          use(film.replicate_mean(static_cast<std::size_t>(y) * static_cast<std::size_t>(film.image().width) +
                                      static_cast<std::size_t>(x),
                                  band));
  return sum;
}

double tile_radiance(const Film& film, const Tile& tile, std::size_t band) {
  return sum_over_pixels(film, tile, band, [](const ReplicateMean& pixel) { return pixel.mean; });
}

/// Sum over the pixels of a tile of (s/(L + floor))^2 for one band.
double tile_error(const Film& film, const Tile& tile, std::size_t band, double floor) {
  return sum_over_pixels(film, tile, band, [&](const ReplicateMean& pixel) {
    const double scale = pixel.mean + floor;
    return pixel.squared_error == 0 ? 0.0 : pixel.squared_error / (scale * scale);
  });
}

/// The blocks of one picture: renders them, measures the error and decides which tiles go on.
class Rendering {
 public:
  Rendering(const TileRenderer& renderer, const StillSettings& settings, Film& film,
            const StillProgressCallback& progress, const std::atomic<bool>& interrupt)
      : renderer_(renderer),
        settings_(settings),
        film_(film),
        progress_(progress),
        interrupt_(interrupt),
        smooths_(settings.smooth && settings.integrator != Integrator::kZones),
        refines_smoothed_(smooths_ && settings.error_target > 0),
        refines_tiles_(!smooths_ && settings.error_target > 0) {
    for (const Tile& tile : tiles_of(film.image().width, film.image().height)) tiles_.push_back({tile, {}});
    const int replicates = static_cast<int>(film.replicates());
    most_samples_ =
        ((settings.error_target > 0 ? settings.most_spp : settings.spp) + replicates - 1) / replicates;
    log2_samples_ = std::bit_width(static_cast<unsigned>(most_samples_ - 1));
  }

  void run() {
    int samples = 0;
    const int replicates = static_cast<int>(film_.replicates());
    const int all_alike =
        refines_smoothed_ ? std::min(most_samples_, kFewestToStop / replicates) : most_samples_;
    // Smoothing averages neighbours; without it each pixel is for itself.
    const int shared = smooths_ ? static_cast<int>(std::bit_ceil(static_cast<unsigned>(all_alike))) : 0;
    while (samples < all_alike && !interrupt_) {
      const int wished = std::clamp(static_cast<int>(std::bit_floor(static_cast<unsigned>(samples) / 2)),
                                    kSmallestBlock, kLargestBlock);
      const int block = std::min(wished, all_alike - samples);
      // The first block goes over the picture several times, by one replicate, one more, two more, and so on,
      // so that there is a whole picture early.
      for (int first = 0; first < replicates && !interrupt_;) {
        const int count = samples > 0 ? replicates : std::max(1, first);
        render_block({samples, block, log2_samples_, shared, first, count}, all_alike);
        first += count;
      }
      if (interrupt_) break;
      samples += block;
      progress_now_.samples = samples * replicates;
      measure();
      if (std::none_of(tiles_.begin(), tiles_.end(), [](const TileState& t) { return t.part.is_active(); }))
        break;
    }
    if (film_.has_gaps()) fill_what_is_missing();
  }

  /// After run(): the smoothed picture, refined where there is a target for it. Nothing if there is none.
  std::optional<StillImage> smooth(const StopToken& stop) {
    if (!smooths_ || interrupt_) return std::nullopt;
    const double pixels = static_cast<double>(film_.image().pixel_count());
    SmoothedRefinement refinement(
        film_,
        {.target = refines_smoothed_ ? settings_.error_target : std::numeric_limits<double>::infinity(),
         .error_floor = settings_.error_floor,
         .most_samples = most_samples_,
         .most_rays = refines_smoothed_ && settings_.most_mean_spp > 0
                          ? settings_.most_mean_spp * pixels
                          : std::numeric_limits<double>::infinity()},
        stop);
    std::optional<StillImage> image =
        refinement.run([&](const std::vector<PixelSamples>& blocks, double from, double to) {
          progress_now_.error = refinement.error();
          render_blocks(blocks, from, to);
        });
    is_stalled_ = refinement.is_stalled();
    return image;
  }

  /// Whether the run ended before every pixel had a sample of its own.
  bool has_zone_values() const { return has_zone_values_; }

  double error() const { return progress_now_.error; }
  bool limited_by_zones() const {
    return is_stalled_ || (refines_tiles_ && progress_now_.error > settings_.error_target &&
                           std::any_of(tiles_.begin(), tiles_.end(),
                                       [](const TileState& t) { return t.part.is_stalled(); }));
  }

 private:
  void render_block(const SampleBlock& block, int all_samples) {
    std::vector<PixelSamples> blocks;
    for (const TileState& t : tiles_)
      if (t.part.is_active()) blocks.push_back({t.tile.pixels(film_.image().width), block});
    const auto share_at = [&](int replicates) {
      const double of_block = static_cast<double>(replicates) / static_cast<double>(film_.replicates());
      const double share = (block.first + block.samples * of_block) / all_samples;
      return refines_smoothed_ ? kShareOfFirst * share : share;
    };
    render_blocks(blocks, share_at(block.first_replicate),
                  share_at(block.first_replicate + block.replicates));
  }

  /// `from`, `to`: where the blocks begin and end of all there is to do [0,1].
  void render_blocks(const std::vector<PixelSamples>& blocks, double from, double to) {
    std::size_t done = 0;
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
      if (interrupt_) return;
      renderer_.render(blocks[i].pixels, blocks[i].block, film_);
      const std::lock_guard lock(progress_mutex_);
      ++done;
      report(from + (to - from) * static_cast<double>(done) / static_cast<double>(blocks.size()));
    });
  }

  /// Somebody waits for it, so of a large picture not every pixel has a ray of its own.
  void fill_what_is_missing() {
    constexpr std::size_t kMostRays = 500'000;
    has_zone_values_ = true;
    std::vector<const Tile*> missing;
    for (const TileState& state : tiles_) {
      const std::size_t corner =
          static_cast<std::size_t>(state.tile.y0) * static_cast<std::size_t>(film_.image().width) +
          static_cast<std::size_t>(state.tile.x0);
      if (film_.image().samples[corner] == 0) missing.push_back(&state.tile);
    }
    std::size_t width = 1;
    while (width < Tile::kSize && missing.size() * Tile::kSize * Tile::kSize / (width * width) > kMostRays)
      width *= 2;
    tbb::parallel_for(std::size_t{0}, missing.size(), [&](std::size_t i) {
      renderer_.fill_with_zones(*missing[i], static_cast<int>(width), film_);
    });
  }

  /// Pre: the mutex is held, or no tile is being rendered.
  void report(double of_samples) {
    if (!progress_) return;
    const double by_error =
        refines_tiles_ ? std::min(1.0, std::pow(settings_.error_target / progress_now_.error, 2)) : 0.0;
    progress_now_.fraction = std::max({progress_now_.fraction, of_samples, by_error});
    progress_now_.seconds = seconds_since(start_);
    progress_(progress_now_);
  }

  /// Error of the picture; tiles below the target are done.
  void measure() {
    if (film_.replicates() < 2) return;
    const std::size_t pixels = film_.image().pixel_count();
    const std::size_t bands = film_.image().bands.count();
    const double target2 = std::pow(RefinedPart::aim(settings_.error_target), 2);
    const bool may_stop = refines_tiles_ && progress_now_.samples >= kFewestToStop;
    std::vector<double> worst(tiles_.size(), 0.0);
    std::vector<double> of_tile(tiles_.size());  // added up in their order, whatever the threads do
    const auto sum_over_tiles = [&](const auto& value) {
      tbb::parallel_for(std::size_t{0}, tiles_.size(),
                        [&](std::size_t i) { of_tile[i] = value(tiles_[i].tile); });
      return std::accumulate(of_tile.begin(), of_tile.end(), 0.0);
    };
    double error2 = 0;
    for (std::size_t b = 0; b < bands; ++b) {
      const double mean = sum_over_tiles([&](const Tile& t) { return tile_radiance(film_, t, b); }) /
                          static_cast<double>(pixels);
      const double floor = settings_.error_floor * mean;
      const double sum = sum_over_tiles([&](const Tile& t) { return tile_error(film_, t, b, floor); });
      for (std::size_t i = 0; i < tiles_.size(); ++i) {
        const Tile& t = tiles_[i].tile;
        worst[i] = std::max(worst[i], of_tile[i] / ((t.x1 - t.x0) * (t.y1 - t.y0)));
      }
      error2 = std::max(error2, sum / static_cast<double>(pixels));
    }
    progress_now_.error = std::sqrt(error2);
    const bool has_doubled = std::has_single_bit(static_cast<unsigned>(progress_now_.samples));
    if (may_stop)
      for (std::size_t i = 0; i < tiles_.size(); ++i)
        tiles_[i].part.look(worst[i] / target2, error2 / target2, has_doubled);
    report(0);
  }

  const TileRenderer& renderer_;
  const StillSettings& settings_;
  Film& film_;
  const StillProgressCallback& progress_;
  const std::atomic<bool>& interrupt_;
  std::vector<TileState> tiles_;
  bool smooths_;
  bool refines_smoothed_;  // all pixels alike first, then what SmoothedRefinement asks for
  bool refines_tiles_;
  bool is_stalled_ = false;
  bool has_zone_values_ = false;
  int most_samples_ = 1;  // per replicate
  int log2_samples_ = 0;
  std::mutex progress_mutex_;
  StillProgress progress_now_{.error = std::numeric_limits<double>::infinity()};
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

ExportInfo describe_still(const Scene& scene, const Solution& solution, const StillSettings& settings,
                          const Camera& camera, const StillImage& image, double error) {
  ExportInfo info;
  state_origin(scene, solution, info);
  if (settings.integrator == Integrator::kPath) {
    info.stopped.clear();
    info.error_is_known = true;
  }
  info.error = std::isfinite(error) ? error : 0;
  const auto point = [](const Vec3& p) { return fmt::format("{:.9g} {:.9g} {:.9g}", p.x(), p.y(), p.z()); };
  info.settings = {{"camera", camera.name},
                   {"eye [m]", point(camera.eye)},
                   {"look at [m]", point(camera.look_at)},
                   {"up", point(camera.up)},
                   {"vertical field of view [deg]", camera.vertical_fov_deg},
                   {"integrator", to_string(settings.integrator)},
                   {"pixel filter", to_string(settings.filter)},
                   {"still seed", settings.seed}};
  if (settings.integrator != Integrator::kZones)
    info.settings.emplace_back("shadow rays per sample", static_cast<std::uint64_t>(settings.light_samples));
  if (settings.integrator == Integrator::kGather)
    info.settings.emplace_back("gather rays per sample", static_cast<std::uint64_t>(settings.gathers));
  if (image.smoothed)
    info.settings.emplace_back("smoothed", "over pixels that are the same within their noise");
  return info;
}

}  // namespace

StillImage render_still(const StillLight& light, const Camera& camera, const StillProgressCallback& progress,
                        const std::atomic<bool>& interrupt) {
  const StillSettings& settings = light.settings();
  const Room& room = light.room();
  const std::pair<int, int> size = picture_size(settings, camera);
  const int width = size.first;
  const int height = size.second;
  const PinholeCamera pinhole(camera, width, height, room.rays());
  tbb::task_arena arena(thread_count(settings.threads));
  StillImage image;
  arena.execute([&] {
    const StopToken stop(interrupt);
    const TileRenderer renderer(light, pinhole, stop);
    Film film(room.scene().bands, width, height, light.replicates(), light.field().parts(),
              renderer.has_caustics());
    Rendering rendering(renderer, settings, film, progress, interrupt);
    rendering.run();
    std::optional<StillImage> smoothed = rendering.smooth(stop);
    std::optional<ZoneBias> zones;
    if (!interrupt) zones = renderer.zone_bias(film);
    image = smoothed ? *std::move(smoothed) : film.finish();
    image.info = describe_still(room.scene(), light.solution(), settings, camera, image,
                                image.smoothed ? image.info.error : rendering.error());
    image.info.zones = zones;
    if (rendering.has_zone_values())
      image.info.settings.emplace_back("interrupted", "tiles that were not reached hold zone values");
    image.limited_by_zones = rendering.limited_by_zones();
    image.interrupted = interrupt;
  });
  return image;
}

StillImage render_still(const Room& room, const Solution& solution, const Camera& camera,
                        const StillSettings& settings, const StillProgressCallback& progress,
                        const std::atomic<bool>& interrupt) {
  return render_still(*StillLight::prepare(room, solution, settings, interrupt), camera, progress, interrupt);
}

}  // namespace reemit

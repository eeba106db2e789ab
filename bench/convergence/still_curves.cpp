// Error over time of stills by the three integrators and smoothed, solve included where a zone solution is
// read.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "bench/convergence/jobs.h"
#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "solver/zoning/build_zones.h"
#include "viewer_export/still/render_still.h"
#include "viewer_export/still/tile_renderer.h"

namespace reemit::bench {
namespace {

/// One command line of a user: solve, then render.
struct StillEffort {
  std::uint64_t packets;
  int samples = 0;          ///< Camera rays per pixel.
  double error_target = 0;  ///< In their place.
};

/// Name of a method, and of what it costs in a room that has been solved.
constexpr const char* kSmoothed = "smoothed";
constexpr const char* kNextView = "next view";

/// A way to a picture, and how much work goes into it from level to level.
struct StillMethod {
  std::string name;
  Integrator integrator;
  bool smooth;
  std::vector<StillEffort> efforts;
};

std::vector<StillEffort> smoothed_efforts(const StudiedRoom& room) {
  std::vector<StillEffort> efforts{
      {1U << 18, 2}, {1U << 19, 4}, {1U << 20, 8}, {1U << 21, 16}, {1U << 22, 32}};
  if (room.longer_stills) efforts.push_back({1U << 23, 96});
  return efforts;
}

/// Path tracing is shared out by room: its paths cost ten times as much in one as in another.
std::vector<StillMethod> still_methods(const StudiedRoom& room) {
  std::vector<StillMethod> methods{
      {"zones", Integrator::kZones, false, {{1U << 15, 8}, {1U << 17, 8}, {1U << 19, 16}, {1U << 21, 16}}},
      {"gather",
       Integrator::kGather,
       false,
       {{1U << 18, 4}, {1U << 20, 16}, {1U << 21, 64}, {1U << 22, 128}}},
      {kSmoothed, Integrator::kGather, true, smoothed_efforts(room)},
      {"refined", Integrator::kGather, true, {{1U << 20, 0, 0.06}, {1U << 21, 0, 0.03}, {1U << 22, 0, 0.02}}},
      {"path", Integrator::kPath, false, {}}};
  for (const int samples : room.path_samples) methods.back().efforts.push_back({0, samples});
  return methods;
}

/// Camera rays of a replicate in one block of the reference.
constexpr int kReferenceBlock = 16;

/// Every so manyeth tile, shifted from row to row so that all parts of the picture have their share.
std::vector<Tile> chosen_tiles(const StudiedRoom& room) {
  std::vector<Tile> tiles;
  const int size = room.picture_size;
  for (int y = 0; y < size; y += Tile::kSize)
    for (int x = 0; x < size; x += Tile::kSize)
      if ((x / Tile::kSize + 3 * (y / Tile::kSize)) % room.tile_stride == 0)
        tiles.push_back({x, y, std::min(x + Tile::kSize, size), std::min(y + Tile::kSize, size)});
  return tiles;
}

/// Values of the pixels of these tiles.
std::vector<float> chosen_values(const StillImage& image, const std::vector<float>& layer,
                                 const std::vector<Tile>& tiles) {
  const std::size_t bands = image.bands.count();
  std::vector<float> values;
  for (const Tile& t : tiles)
    for (int y = t.y0; y < t.y1; ++y)
      for (int x = t.x0; x < t.x1; ++x)
        for (std::size_t b = 0; b < bands; ++b)
          values.push_back(layer[(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                  static_cast<std::size_t>(x)) *
                                     bands +
                                 b]);
  return values;
}

double mean_of(const std::vector<float>& layer) {
  return std::accumulate(layer.begin(), layer.end(), 0.0) / static_cast<double>(layer.size());
}

int reference_samples(const StudiedRoom& room, const Options& options) {
  return room.reference_samples / (options.quick ? 4 : 1);
}

/// Path tracing of the chosen tiles alone.
Reference path_reference(const StudiedRoom& room, const MeshResult& mesh, const std::vector<Tile>& tiles,
                         const Options& options) {
  const std::atomic<bool> never{false};
  // Path tracing reads no zone value: any solution will do.
  SolverSettings solver;
  solver.threads = options.threads;
  solver.packets = 1U << 14;
  const Solution solution = solve(room.scene, mesh, solver, {}, never);
  const Room walls(room.scene, solution.mesh);
  StillSettings settings;
  settings.integrator = Integrator::kPath;
  settings.seed = kReferenceSeed;
  const PinholeCamera camera(room.camera, room.picture_size, room.picture_size, walls.rays());
  constexpr std::size_t kReplicates = Film::kReplicates;
  const StopToken stop(never);
  const std::unique_ptr<StillLight> light = StillLight::prepare(walls, solution, settings, never);
  const TileRenderer renderer(*light, camera, stop);
  Film film(room.scene.bands, room.picture_size, room.picture_size, kReplicates, light->field().parts(),
            renderer.has_caustics());
  const int samples = reference_samples(room, options) / static_cast<int>(kReplicates);
  const int log2_samples = std::bit_width(static_cast<unsigned>(samples - 1));
  tbb::task_arena arena(options.threads);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t i) {
      for (int first = 0; first < samples; first += kReferenceBlock)
        renderer.render(tiles[i].pixels(room.picture_size),
                        {.first = first,
                         .samples = std::min(kReferenceBlock, samples - first),
                         .log2_samples = log2_samples,
                         .replicates = static_cast<int>(kReplicates)},
                        film);
    });
  });
  const StillImage image = film.finish();
  return {room.scene.bands.count(), chosen_values(image, image.radiance, tiles),
          chosen_values(image, image.radiance_stderr, tiles)};
}

class StillCurves {
 public:
  StillCurves(const StudiedRoom& room, const Options& options, const ReferenceCache& cache, Table& table)
      : room_(room),
        options_(options),
        table_(table),
        mesh_(build_zones(room.scene)),
        tiles_(chosen_tiles(room)),
        methods_(still_methods(room)) {
    norm_.floor_share = StillSettings{}.error_floor;
    const int samples = reference_samples(room, options);
    reference_ = cache.get(
        fmt::format("still-{}-{}-{}-{}", content_hash(room.scene), room.picture_size, tiles_.size(), samples),
        [&] { return path_reference(room, mesh_, tiles_, options); });
    reference_error_ = own_error(reference_, norm_);
    table.notes.push_back(
        fmt::format("{}, stills: camera {}, {}x{} px, {} of them compared, {} zones; reference: {} "
                    "path-traced samples per "
                    "pixel, {:.2g} % median, {:.2g} % rms",
                    room.name, room.camera.name, room.picture_size, room.picture_size,
                    reference_.value.size() / reference_.bands, mesh_.mesh.zone_count(), samples,
                    100 * reference_error_.median, 100 * reference_error_.rms));
  }

  /// All methods that have this level.
  void run(int seed, std::size_t level) {
    for (const StillMethod& method : methods_)
      if (level < levels_of(method)) measure(method, seed, level);
  }

  std::size_t levels() const {
    std::size_t most = 0;
    for (const StillMethod& method : methods_) most = std::max(most, levels_of(method));
    return most;
  }

 private:
  std::size_t levels_of(const StillMethod& method) const {
    return method.efforts.size() - (options_.quick ? 1 : 0);
  }

  void measure(const StillMethod& method, int seed, std::size_t level) {
    const StillEffort& effort = method.efforts[level];
    SolverSettings solver;
    solver.threads = options_.threads;
    solver.seed = static_cast<std::uint64_t>(seed);
    // render_still wants a solution of the room even where it reads none; that one is not timed.
    const bool needs_solution = method.integrator != Integrator::kPath;
    solver.packets = needs_solution ? effort.packets : 1U << 14;
    StillSettings still;
    still.threads = options_.threads;
    still.seed = solver.seed;
    still.integrator = method.integrator;
    still.smooth = method.smooth;
    still.width = still.height = room_.picture_size;
    if (effort.samples > 0) still.spp = effort.samples;
    still.error_target = effort.error_target;
    Solution solution;
    // The room is cut into zones anew, as `reemit solve` does it, because that takes its time.
    const double solve_seconds = seconds_of([&] {
      MeshResult mesh = tbb::task_arena(options_.threads).execute([&] { return build_zones(room_.scene); });
      solution = solve(room_.scene, std::move(mesh), solver, {}, never_);
    });
    StillImage image;
    const double render_seconds = seconds_of([&] {
      const Room walls(room_.scene, solution.mesh);
      image = render_still(walls, solution, room_.camera, still, {}, never_);
    });
    // What a picture of the zones costs, and how good it is, depends on their packets.
    const bool of_zones = method.integrator == Integrator::kZones;
    Measurement row{room_.name,
                    "still",
                    method.name,
                    solver.seed,
                    static_cast<int>(level),
                    render_seconds + (needs_solution ? solve_seconds : 0.0),
                    of_zones ? static_cast<double>(solution.record.rays) : mean_of(image.samples),
                    of_zones ? "rays of the solve" : "samples per pixel",
                    deviation(chosen_values(image, image.radiance, tiles_), reference_, norm_),
                    reference_error_};
    report(row, table_);
    if (method.name != kSmoothed) return;
    row.method = kNextView;
    row.seconds = render_seconds;
    report(row, table_);
  }

  const std::atomic<bool> never_{false};
  const StudiedRoom& room_;
  const Options& options_;
  Table& table_;
  MeshResult mesh_;
  std::vector<Tile> tiles_;
  std::vector<StillMethod> methods_;
  ErrorNorm norm_;
  Reference reference_;
  ErrorPair reference_error_;
};

}  // namespace

void measure_stills(const StudiedRoom& room, const Options& options, const ReferenceCache& cache,
                    Table& table) {
  StillCurves curves(room, options, cache, table);
  for (int seed = 1; seed <= options.seeds; ++seed)
    for (std::size_t level = 0; level < curves.levels(); ++level) curves.run(seed, level);
}

}  // namespace reemit::bench

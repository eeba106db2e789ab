// Are --error targets met by the true error? Many seeds of solve and render against long references.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <exception>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/program_options.h"
#include "scenes/io/scene_reader.h"
#include "scenes/model/stopwatch.h"
#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "solver/zoning/build_zones.h"
#include "viewer_export/still/render_still.h"

namespace {

using namespace reemit;

struct Options {
  std::string room;
  int seeds = 20;
  double solve_target = 0.01;
  double render_target = 0.02;
  double zone_area = 0;  ///< [m2], 0 = default.
  int size = 128;
  int reference_samples = 4096;
  bool only_solve = false;
};

/// The true relative error of one run in one band, what the run said, and how long it took.
struct Outcome {
  double true_error = 0;
  double stated_error = 0;
  double seconds = 0;
};

void print(const std::string& what, double target, const std::vector<Outcome>& runs, double reference_error) {
  std::vector<double> errors;
  std::vector<double> seconds;
  double sum = 0;
  double stated = 0;
  std::size_t met = 0;
  for (const Outcome& run : runs) {
    errors.push_back(run.true_error);
    seconds.push_back(run.seconds);
    sum += run.true_error;
    stated += run.stated_error;
    if (run.true_error <= target) ++met;
  }
  const auto n = static_cast<double>(runs.size());
  const auto [least, most] = std::minmax_element(errors.begin(), errors.end());
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  fmt::print("| {} | {:g} % | {} of {} | {:.3f} % | {:.3f} % .. {:.3f} % | {:.3f} % | {:.3f} % | {:.2f} |\n",
             what, 100 * target, met, runs.size(), 100 * sum / n, 100 * *least, 100 * *most, 100 * stated / n,
             100 * reference_error, *middle);
  std::fflush(stdout);
}

/// sqrt(sum A (rho dE)^2 / sum A (rho E)^2), worst band; the reference's own error is taken out in squares.
double true_zone_error(const Solution& solution, const Solution& reference) {
  double worst = 0;
  for (std::size_t b = 0; b < solution.bands.count(); ++b) {
    double difference = 0;
    double noise = 0;
    double signal = 0;
    for (std::size_t i = 0; i < solution.mesh.zone_count(); ++i) {
      const ZoneId z(i);
      const double rho = solution.zone_reflectance(z, b);
      const double weight = solution.mesh.zone_area(z) * rho * rho;
      const Estimate truth = reference.irradiance(z, b);
      const double d = solution.irradiance(z, b).mean - truth.mean;
      difference += weight * d * d;
      noise += weight * truth.stderr_of_mean * truth.stderr_of_mean;
      signal += weight * truth.mean * truth.mean;
    }
    worst = std::max(worst, std::sqrt(std::max(0.0, difference - noise) / signal));
  }
  return worst;
}

/// sqrt(mean over pixels of (dL/(L + floor))^2), worst band; the reference's own error is taken out in
/// squares.
double true_still_error(const StillImage& image, const StillImage& reference, double floor_share,
                        double* reference_error = nullptr) {
  const std::size_t bands = image.bands.count();
  const std::size_t pixels = image.pixel_count();
  double worst = 0;
  for (std::size_t b = 0; b < bands; ++b) {
    double mean = 0;
    for (std::size_t p = 0; p < pixels; ++p) mean += static_cast<double>(reference.radiance[p * bands + b]);
    const double floor = floor_share * mean / static_cast<double>(pixels);
    double difference = 0;
    double noise = 0;
    for (std::size_t k = b; k < pixels * bands; k += bands) {
      const double truth = static_cast<double>(reference.radiance[k]);
      const double scale = 1 / ((truth + floor) * (truth + floor));
      const double d = static_cast<double>(image.radiance[k]) - truth;
      const double s = static_cast<double>(reference.radiance_stderr[k]);
      if (truth + floor == 0) continue;
      difference += d * d * scale;
      noise += s * s * scale;
    }
    const auto n = static_cast<double>(pixels);
    worst = std::max(worst, std::sqrt(std::max(0.0, difference - noise) / n));
    if (reference_error != nullptr) *reference_error = std::max(*reference_error, std::sqrt(noise / n));
  }
  return worst;
}

/// A solution of each seed that meets the target, and one that all are compared with.
struct Solves {
  Solution reference;
  std::vector<Solution> by_seed;
};

Solves measure_solves(const Scene& scene, const MeshResult& mesh, const Options& options) {
  const std::atomic<bool> never{false};
  SolverSettings settings;
  settings.direct = DirectSource::kPackets;
  settings.error_target = options.solve_target / 6;
  settings.seed = 1'000'000;
  Solves solves{solve(scene, mesh, settings, {}, never), {}};
  settings.error_target = options.solve_target;
  std::vector<Outcome> by_packets;
  std::vector<Outcome> outcomes;
  for (int seed = 1; seed <= options.seeds; ++seed) {
    settings.seed = static_cast<std::uint64_t>(seed);
    const auto outcome = [&](const Solution& s) {
      return Outcome{true_zone_error(s, solves.reference), s.record.error, s.record.seconds};
    };
    settings.direct = DirectSource::kPackets;
    by_packets.push_back(outcome(solve(scene, mesh, settings, {}, never)));
    settings.direct = DirectSource::kBest;
    solves.by_seed.push_back(solve(scene, mesh, settings, {}, never));
    outcomes.push_back(outcome(solves.by_seed.back()));
  }
  const std::string command = fmt::format("solve --error {:g}%", 100 * options.solve_target);
  print(command + " --direct packets", options.solve_target, by_packets, solves.reference.record.error);
  print(command, options.solve_target, outcomes, solves.reference.record.error);
  return solves;
}

void measure_stills(const Scene& scene, const Solves& solves, const Options& options) {
  const std::atomic<bool> never{false};
  const Room walls(scene, solves.by_seed.front().mesh);
  StillSettings still;
  still.width = still.height = options.size;
  still.integrator = Integrator::kPath;
  still.spp = options.reference_samples;
  still.seed = 1'000'000;
  const Camera& camera = scene.cameras.at(0);
  const StillImage traced = render_still(walls, solves.reference, camera, still, {}, never);
  still.integrator = Integrator::kGather;
  still.error_target = options.render_target;
  double reference_error = 0;
  std::vector<Outcome> stills;
  for (int seed = 1; seed <= options.seeds; ++seed) {
    still.seed = static_cast<std::uint64_t>(seed);
    const auto begin = std::chrono::steady_clock::now();
    const StillImage image =
        render_still(walls, solves.by_seed[static_cast<std::size_t>(seed - 1)], camera, still, {}, never);
    const double seconds = seconds_since(begin);
    stills.push_back(
        {true_still_error(image, traced, still.error_floor, &reference_error), image.info.error, seconds});
  }
  print(fmt::format("render --error {:g}% --size {}x{}, against path tracing", 100 * options.render_target,
                    options.size, options.size),
        options.render_target, stills, reference_error);
}

void measure(const Options& options) {
  const Scene scene = read_scene(options.room);
  MeshSettings mesh_settings;
  if (options.zone_area > 0) mesh_settings.zone_area = options.zone_area;
  const MeshResult mesh = build_zones(scene, mesh_settings);
  fmt::print("{}: {} zones, {} seeds\n\n", options.room, mesh.mesh.zone_count(), options.seeds);
  fmt::print(
      "| command | target | met by the true error | mean true error | least .. most | mean stated error |"
      " error of the reference | median time [s] |\n|---|---|---|---|---|---|---|---|---|\n");
  const Solves solves = measure_solves(scene, mesh, options);
  if (!options.only_solve) measure_stills(scene, solves, options);
}

}  // namespace

int main(int argc, char** argv) {
  bench::ProgramOptions app("Whether the true error of solutions and stills meets the --error target");
  Options options;
  app.add_option("room", options.room, "Room file with a camera").required();
  app.add_option("--seeds", options.seeds, "Independent runs").show_default().in_range(1, 10000);
  app.add_option("--solve-error", options.solve_target, "Target of solve, as a fraction").show_default();
  app.add_option("--render-error", options.render_target, "Target of render, as a fraction").show_default();
  app.add_option("--zone-area", options.zone_area, "Largest zone area [m2]");
  app.add_option("--size", options.size, "Width and height of the stills [px]").show_default();
  app.add_option("--reference-samples", options.reference_samples,
                 "Path-traced samples per pixel of the reference")
      .show_default();
  app.add_flag("--only-solve", options.only_solve, "No stills");
  if (const auto exit_code = app.parse(argc, argv)) return *exit_code;
  try {
    measure(options);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
  return 0;
}

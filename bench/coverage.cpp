// How often the stated 95 % intervals of zones, vertices and pixels hold the truth, over many seeds, in a
// room whose answer is known in closed form.
#include <atomic>
#include <cmath>
#include <cstdint>
#include <exception>
#include <numbers>
#include <string>
#include <vector>

#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>

#include "bench/program_options.h"
#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "tests/support/variable_furnace.h"
#include "viewer_export/still/film.h"
#include "viewer_export/still/render_still.h"
#include "viewer_export/vertex/vertex_radiance.h"

namespace {

using namespace reemit;

constexpr double kRadiosity = test::VariableFurnace::kRadiosity;

struct Coverage {
  std::string what;
  int degrees_of_freedom = 0;
  std::int64_t trials = 0;
  std::int64_t inside = 0;
  std::int64_t inside_normal = 0;  // within 1.96 standard errors
  double deviation2 = 0;
  double error2 = 0;
  double bias = 0;

  void add(double value, double error, double truth) {
    using boost::math::students_t;
    const double t = boost::math::quantile(students_t(degrees_of_freedom), 0.975);
    const double d = value - truth;
    ++trials;
    if (std::abs(d) <= t * error) ++inside;
    if (std::abs(d) <= 1.96 * error) ++inside_normal;
    deviation2 += d * d;
    error2 += error * error;
    bias += d;
  }

  void print() const {
    const auto n = static_cast<double>(trials);
    const double rms = std::sqrt(deviation2 / n);
    fmt::print("| {} | {} | {} | {:.2f} % | {:.2f} % | {:.3f} | {:+.2g} % |\n", what, degrees_of_freedom,
               trials, 100 * static_cast<double>(inside) / n, 100 * static_cast<double>(inside_normal) / n,
               std::sqrt(error2 / n) / rms, 100 * bias / n / kRadiosity);
    std::fflush(stdout);
  }
};

struct Options {
  int seeds = 50;
  double error = 0.03;
};

constexpr int kVertexFreedom = static_cast<int>(ZoneSums::kGroups) - 1;
constexpr int kPixelFreedom = static_cast<int>(Film::kReplicates) - 1;

/// Zones, vertices and pixels of one room over many seeds.
class FurnaceCoverage {
 public:
  FurnaceCoverage()
      : furnace_(8), mesh_(furnace_.room().mesh().mesh), walls_(furnace_.room().scene(), mesh_) {}

  void add_seed(const Options& options, int seed) {
    SolverSettings settings;
    settings.error_target = options.error;
    settings.seed = static_cast<std::uint64_t>(seed);
    const Solution solution = add_zones(settings);
    add_vertices(solution);
    add_pixels(solution);
  }

  void print(const Options& options) const {
    fmt::print("Furnace of reflectances 0.2 to 0.9, {} zones, solved to {:g} %, {} seeds.\n\n",
               mesh_.zone_count(), 100 * options.error, options.seeds);
    fmt::print(
        "| values | degrees of freedom | trials | within the 95 % interval | within 1.96 standard errors |"
        " stated / true rms | mean deviation |\n|---|---|---|---|---|---|---|\n");
    for (const Coverage* c : {&zones_, &walk_, &vertices_, &averaged_, &coarse_, &fine_, &target_, &path_})
      c->print();
  }

 private:
  /// Returns the solution by shooting.
  Solution add_zones(SolverSettings settings) {
    Solution solution;
    for (const SolveMethod method : {SolveMethod::kWalk, SolveMethod::kShooting}) {
      settings.method = method;
      solution = solve(furnace_.room().scene(), furnace_.room().mesh(), settings, {}, never_);
      Coverage& all = method == SolveMethod::kWalk ? walk_ : zones_;
      all.degrees_of_freedom = static_cast<int>(solution.sums.batches) - 1;
      for (std::size_t z = 0; z < solution.mesh.zone_count(); ++z) {
        const Estimate e = solution.irradiance(ZoneId(z), 0);
        all.add(e.mean, e.stderr_of_mean, kRadiosity);
      }
    }
    return solution;
  }

  void add_vertices(const Solution& solution) {
    VertexSettings gather;
    gather.seed = solution.settings.seed;
    for (const bool average : {false, true}) {
      gather.average_zones = average;
      const VertexData data = gather_vertices(walls_, solution, gather, {}, never_);
      for (std::size_t v = 0; v < data.vertex_count(); ++v)
        (average ? averaged_ : vertices_)
            .add(std::numbers::pi * static_cast<double>(data.radiance[v]),
                 std::numbers::pi * static_cast<double>(data.radiance_stderr[v]), kRadiosity);
    }
  }

  void add_pixels(const Solution& solution) {
    StillSettings still;
    still.seed = solution.settings.seed;
    const auto render = [&](Coverage& coverage) {
      const StillImage image =
          render_still(walls_, solution, test::VariableFurnace::camera(), still, {}, never_);
      for (std::size_t p = 0; p < image.pixel_count(); ++p)
        coverage.add(std::numbers::pi * static_cast<double>(image.radiance[p]),
                     std::numbers::pi * static_cast<double>(image.radiance_stderr[p]), kRadiosity);
    };
    render(coarse_);
    still.spp = 64;
    render(fine_);
    still.integrator = Integrator::kPath;
    render(path_);
    still.integrator = Integrator::kGather;
    still.error_target = 0.02;
    render(target_);
  }

  test::VariableFurnace furnace_;
  ZoneMesh mesh_;
  Room walls_;
  std::atomic<bool> never_{false};
  Coverage zones_{"zones, shooting", 15};
  Coverage walk_{"zones, walk", 15};
  Coverage vertices_{"vertices, gathered", kVertexFreedom};
  Coverage averaged_{"vertices, zone averages", kVertexFreedom};
  Coverage coarse_{"pixels, 16 samples", kPixelFreedom};
  Coverage fine_{"pixels, 64 samples", kPixelFreedom};
  Coverage target_{"pixels, --error 2%", kPixelFreedom};
  Coverage path_{"pixels, path tracing, 64 samples", kPixelFreedom};
};

}  // namespace

int main(int argc, char** argv) {
  bench::ProgramOptions app(
      "Coverage of the 95 % intervals of zones, vertices and pixels in a furnace of known radiosity");
  Options options;
  app.add_option("--seeds", options.seeds, "Independent runs").show_default().in_range(1, 100000);
  app.add_option("--error", options.error, "Target of the solve, as a fraction").show_default();
  if (const auto exit_code = app.parse(argc, argv)) return *exit_code;
  try {
    FurnaceCoverage coverage;
    for (int seed = 1; seed <= options.seeds; ++seed) coverage.add_seed(options, seed);
    coverage.print(options);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
  return 0;
}

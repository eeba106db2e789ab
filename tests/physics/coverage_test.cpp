// Do 95 % intervals hold the truth 95 % of the time? A short version of bench/coverage.

#include <cmath>
#include <functional>
#include <numbers>

#include <boost/math/distributions/students_t.hpp>
#include <gtest/gtest.h>

#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "tests/support/never.h"
#include "tests/support/variable_furnace.h"
#include "viewer_export/still/film.h"
#include "viewer_export/still/render_still.h"
#include "viewer_export/vertex/vertex_radiance.h"

namespace reemit {
namespace {

using test::VariableFurnace;

constexpr int kSeeds = 6;
using test::kNever;

/// Counts values whose 95 % interval holds the truth. `error_scale` plants a wrong error bar.
class Intervals {
 public:
  explicit Intervals(double error_scale = 1) : error_scale_(error_scale) {}

  void add(double value, double error, int degrees_of_freedom) {
    const boost::math::students_t distribution(degrees_of_freedom);
    const double reach = boost::math::quantile(distribution, 0.975) * error * error_scale_;
    ++trials_;
    if (std::abs(value - VariableFurnace::kRadiosity) <= reach) ++inside_;
  }
  double share() const { return static_cast<double>(inside_) / static_cast<double>(trials_); }
  int trials() const { return trials_; }

 private:
  double error_scale_;
  int trials_ = 0;
  int inside_ = 0;
};

Solution solve_furnace(const VariableFurnace& furnace, SolveMethod method, std::uint64_t seed) {
  SolverSettings settings;
  settings.method = method;
  settings.packets = 100'000;
  settings.seed = seed;
  return solve_zones(furnace.room().scene(), furnace.room().mesh(), settings, {}, kNever);
}

// Of n trials, correlated among each other by the light they share, 93 % to 97 % must be inside. With n >=
// 2000 and a design effect of at most 4 that is 4 standard errors or more: odds of a false alarm below 1e-4.
void expect_covered(const Intervals& intervals) {
  EXPECT_GE(intervals.trials(), 2000);
  EXPECT_GT(intervals.share(), 0.93);
  EXPECT_LT(intervals.share(), 0.97);
}

void add_zones(SolveMethod method, Intervals& intervals) {
  const VariableFurnace furnace(5);
  for (std::uint64_t seed = 1; seed <= 2 * kSeeds; ++seed) {
    const Solution s = solve_furnace(furnace, method, seed);
    for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
      const Estimate e = s.irradiance(ZoneId(z), 0);
      intervals.add(e.mean, e.stderr_of_mean, static_cast<int>(s.sums.batches) - 1);
    }
  }
}

void add_vertices(bool average_zones, Intervals& intervals) {
  const VariableFurnace furnace(6);
  const ZoneMesh mesh = furnace.room().mesh().mesh;
  const Room walls(furnace.room().scene(), mesh);
  VertexSettings settings;
  settings.average_zones = average_zones;
  settings.gather_rays = 128;
  // Four in a replicate. With two their skewness shows: 93.3 % of 23,520 intervals.
  settings.light_samples = 64;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Solution s = solve_furnace(furnace, SolveMethod::kShooting, seed);
    settings.seed = seed;
    const VertexData data = gather_vertices(walls, s, settings, {}, kNever);
    for (std::size_t v = 0; v < data.vertex_count(); ++v)
      intervals.add(std::numbers::pi * static_cast<double>(data.radiance[v]),
                    std::numbers::pi * static_cast<double>(data.radiance_stderr[v]),
                    static_cast<int>(ZoneSums::kGroups) - 1);
  }
}

void add_pixels(const StillSettings& how, Intervals& intervals) {
  const VariableFurnace furnace(5);
  const ZoneMesh mesh = furnace.room().mesh().mesh;
  const Room walls(furnace.room().scene(), mesh);
  StillSettings settings = how;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Solution s = solve_furnace(furnace, SolveMethod::kShooting, seed);
    settings.seed = seed;
    const StillImage image = render_still(walls, s, VariableFurnace::camera(), settings, {}, kNever);
    for (std::size_t p = 0; p < image.pixel_count(); ++p)
      intervals.add(std::numbers::pi * static_cast<double>(image.radiance[p]),
                    std::numbers::pi * static_cast<double>(image.radiance_stderr[p]),
                    static_cast<int>(Film::kReplicates) - 1);
  }
}

TEST(Coverage, of_zones_by_shooting) {
  Intervals intervals;
  add_zones(SolveMethod::kShooting, intervals);
  expect_covered(intervals);
}

TEST(Coverage, of_zones_by_walks) {
  Intervals intervals;
  add_zones(SolveMethod::kWalk, intervals);
  expect_covered(intervals);
}

TEST(Coverage, of_gathered_vertices) {
  Intervals intervals;
  add_vertices(false, intervals);
  expect_covered(intervals);
}

TEST(Coverage, of_vertices_averaged_from_zones) {
  Intervals intervals;
  add_vertices(true, intervals);
  expect_covered(intervals);
}

TEST(Coverage, of_gathered_pixels) {
  Intervals intervals;
  add_pixels({.spp = 32}, intervals);
  expect_covered(intervals);
}

TEST(Coverage, of_pixels_rendered_to_a_target) {
  Intervals intervals;
  add_pixels({.error_target = 0.03}, intervals);
  expect_covered(intervals);
}

TEST(Coverage, of_path_traced_pixels) {
  Intervals intervals;
  add_pixels({.integrator = Integrator::kPath, .spp = 32}, intervals);
  expect_covered(intervals);
}

TEST(Coverage, error_bars_a_tenth_wrong_are_noticed) {
  Intervals narrow(0.85);
  Intervals wide(1.2);
  add_zones(SolveMethod::kShooting, narrow);
  add_zones(SolveMethod::kShooting, wide);
  EXPECT_LT(narrow.share(), 0.93);
  EXPECT_GT(wide.share(), 0.97);
}

}  // namespace
}  // namespace reemit

// Rooms of any size and anywhere, reflectance near 1, very large batches: what bench/stability measures, as
// tests.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "scenes/io/scene_reader.h"
#include "solver/progressive_solver.h"
#include "tests/support/never.h"
#include "tests/support/transformed_room.h"
#include "tests/support/variable_furnace.h"

namespace reemit {
namespace {

using test::kNever;

Scene cornell_box() {
  return read_scene(REEMIT_SOURCE_DIR "/scenes/library/cornell_box.json");
}

Solution run(const Scene& scene, double zone_area) {
  MeshSettings mesh;
  mesh.zone_area = zone_area;
  SolverSettings settings;
  settings.packets = 400'000;
  return solve_zones(scene, build_mesh(scene, mesh), settings, {}, kNever);
}

TEST(Stability, scaling_by_a_power_of_two_changes_no_bit) {
  const Scene scene = cornell_box();
  const Solution original = run(scene, 0.005);
  for (const double scale : {0x1p-10, 0x1p20}) {
    const Solution scaled = run(test::transformed(scene, scale, Vec3::Zero()), 0.005 * scale * scale);
    EXPECT_EQ(scaled.sums.direct, original.sums.direct) << scale;
    EXPECT_EQ(scaled.sums.indirect, original.sums.indirect) << scale;
  }
}

// Rounding may choose the other diagonal of a square, so zones cannot be compared one by one. 8 lit surfaces,
// errors with 15 degrees of freedom: beyond 6 standard errors lies one surface in 5e3 rooms.
TEST(Stability, size_and_place_do_not_matter) {
  const Scene scene = cornell_box();
  const double size = test::room_size(scene);
  const Solution original = run(scene, 0.005);
  struct Case {
    double scale;
    double shift;  // in room sizes
  };
  for (const Case& c : {Case{1e-3, 0}, Case{1e6, 0}, Case{1, 1e4}, Case{1e6, 1e4}}) {
    const Vec3 shift = c.shift * c.scale * size * Vec3(1, -0.7, 0.4).normalized();
    const Solution moved = run(test::transformed(scene, c.scale, shift), 0.005 * c.scale * c.scale);
    const auto deviations = test::surface_deviations(moved, original);
    EXPECT_GE(deviations.size(), 8U);
    EXPECT_LT(*std::max_element(deviations.begin(), deviations.end()), 6) << c.scale << " " << c.shift;
    EXPECT_TRUE(moved.audit.balanced());
  }
}

double area_mean(const Solution& s) {
  double power = 0;
  double area = 0;
  for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
    power += s.mesh.zone_area(ZoneId(z)) * s.irradiance(ZoneId(z), 0).mean;
    area += s.mesh.zone_area(ZoneId(z));
  }
  return power / area;
}

// What sweeps leave of a batch, a share of stop_share, walks bring home: nothing is lost, and the mean over a
// closed furnace is that of the books but for the noise of so little.
TEST(Stability, reflectance_near_one_loses_no_power) {
  for (const double rho : {0.9, 0.999}) {
    test::RoomBuilder room;
    const MaterialId all = room.material("all", rho, 1);
    room.box(Vec3::Zero(), Vec3(3, 2, 1), {all, all, all, all, all, all}, 4);
    SolverSettings settings;
    settings.packets = 32'000;
    const Solution s = solve_zones(room.scene(), room.mesh(), settings, {}, kNever);
    const double relative = area_mean(s) * (1 - rho) - 1;
    EXPECT_LT(std::abs(relative), 0.25 * settings.stop_share) << rho;
    EXPECT_EQ(s.audit.bands[0].total_escaped(), 0);
    EXPECT_EQ(s.audit.bands[0].unshot, 0);
    EXPECT_TRUE(s.audit.balanced());
  }
}

// 10^7 packets in a batch leave 4 x 10^5 quanta for a packet; rounding a share of it to a whole quantum is
// 1e-6 of it. One batch gives no error bar; 10^7 packets on 54 zones leave an error below 0.3 %.
TEST(Stability, very_large_batches_keep_their_power) {
  const test::VariableFurnace furnace(2);
  SolverSettings settings;
  settings.packets = settings.batch_packets = 10'000'000;
  const Solution s = solve_zones(furnace.room().scene(), furnace.room().mesh(), settings, {}, kNever);
  EXPECT_EQ(s.sums.batches, 1);
  EXPECT_NEAR(area_mean(s) / test::VariableFurnace::kRadiosity, 1, 5e-4);
  for (std::size_t z = 0; z < s.mesh.zone_count(); ++z)
    EXPECT_NEAR(s.irradiance(ZoneId(z), 0).mean / test::VariableFurnace::kRadiosity, 1, 0.015);
  EXPECT_TRUE(s.audit.balanced());
}

}  // namespace
}  // namespace reemit

#include "solver/gather/discretisation.h"

#include <gtest/gtest.h>

#include "solver/progressive_solver.h"
#include "tests/support/never.h"
#include "tests/support/variable_furnace.h"

namespace reemit {
namespace {

using test::kNever;

Solution solution_of(const test::RoomBuilder& room, std::uint64_t packets, std::uint64_t seed = 1) {
  SolverSettings settings;
  settings.packets = packets;
  settings.seed = seed;
  return solve(room.scene(), room.mesh(), settings, {}, kNever);
}

/// A cube whose floor alone emits: light falls off along the walls.
test::RoomBuilder lit_cube(std::uint32_t divisions) {
  test::RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5);
  const MaterialId lamp = room.material("lamp", 0.5, 1);
  room.box(Vec3::Zero(), Vec3::Ones(), {wall, wall, wall, wall, lamp, wall}, divisions);
  return room;
}

TEST(Discretisation, is_zero_where_zones_are_exact_however_noisy_they_are) {
  // Zones of a furnace all have the same radiosity as their points; with this few packets their noise is 10
  // %.
  const test::VariableFurnace furnace(8);
  const Solution s = solution_of(furnace.room(), 100'000);
  ASSERT_GT(s.record.error, 0.03);
  ASSERT_TRUE(s.record.discretisation.has_value());
  EXPECT_LT(*s.record.discretisation, 0.03);
}

TEST(Discretisation, falls_in_proportion_to_the_size_of_zones) {
  const double coarse = solution_of(lit_cube(1), 400'000).record.discretisation.value();
  const double middle = solution_of(lit_cube(4), 400'000).record.discretisation.value();
  const double fine = solution_of(lit_cube(16), 4'000'000).record.discretisation.value();
  // Reference: shooting against gathered points at the 12 zones of a cube differ by some tens of per cent.
  EXPECT_GT(coarse, 0.2);
  EXPECT_LT(coarse, 0.6);
  EXPECT_NEAR(coarse / middle, 4, 2);
  EXPECT_NEAR(middle / fine, 4, 2);
}

TEST(Discretisation, does_not_depend_on_the_noise) {
  const double few = solution_of(lit_cube(2), 100'000, 3).record.discretisation.value();
  const double many = solution_of(lit_cube(2), 3'000'000, 4).record.discretisation.value();
  EXPECT_NEAR(few / many, 1, 0.15);
}

// Half of the light of an opal sheet comes from behind it, at its points as in its zones. Without it, 60 %.
TEST(Discretisation, counts_what_comes_through_a_sheet) {
  test::RoomBuilder room = lit_cube(8);
  const MaterialId opal = room.material("opal", 0.4, 0, true);
  room.scene().materials[opal.index()].non_diffuse.diffuse_transmittance = Spectrum::Constant(1, 0.6);
  room.quad(opal, {Vec3(0, 0, .5), Vec3(1, 0, .5), Vec3(1, 1, .5), Vec3(0, 1, .5)}, 8);
  const auto of_sheet = solution_of(room, 1'000'000).record.discretisation;
  const auto without = solution_of(lit_cube(8), 1'000'000).record.discretisation;
  ASSERT_TRUE(of_sheet && without);
  EXPECT_LT(*of_sheet, 2 * *without);
}

TEST(Discretisation, is_unknown_where_noise_hides_it) {
  const test::VariableFurnace furnace(8);
  const Solution s = solution_of(furnace.room(), 2'000);
  ASSERT_GT(s.record.error, 0.15);
  EXPECT_FALSE(s.record.discretisation.has_value());
}

TEST(Discretisation, is_unknown_after_one_batch) {
  SolverSettings settings;
  settings.packets = settings.batch_packets = 1000;
  const test::RoomBuilder room = lit_cube(2);
  const Solution s = solve(room.scene(), room.mesh(), settings, {}, kNever);
  EXPECT_FALSE(s.record.discretisation.has_value());
}

}  // namespace
}  // namespace reemit

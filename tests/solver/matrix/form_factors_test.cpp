// Form factors of whole rooms: closure, reciprocity, occlusion, threads, refusals.
#include "solver/matrix/form_factors.h"

#include <atomic>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "tests/support/refusal.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using test::RoomBuilder;

FormFactors factors_of(const RoomBuilder& room, bool enforce = true, int threads = 2) {
  const MeshResult meshed = room.mesh();
  const RayTracer rays(meshed.mesh);
  const std::atomic<bool> interrupt = false;
  FormFactors result;
  tbb::task_arena(threads).execute([&] {
    result =
        compute_form_factors(meshed.mesh, rays, {.seed = 11, .enforce_closure = enforce}, nullptr, interrupt);
  });
  return result;
}

RoomBuilder cube(std::uint32_t divisions) {
  RoomBuilder room;
  const MaterialId m = room.material("all", 0.5, 1.0);
  room.box(Vec3::Zero(), Vec3(1, 1, 1), {m, m, m, m, m, m}, divisions);
  return room;
}

/// A closed box with a block that hangs in it.
RoomBuilder box_with_block(std::uint32_t divisions) {
  RoomBuilder room = cube(divisions);
  const MaterialId m = room.material("block", 0.5);
  return room.solid(Vec3(0.3, 0.25, 0.35), Vec3(0.65, 0.65, 0.65), m, 2);
}

TEST(FormFactors, ConvexRoomIsExactWithoutShadowRays) {
  for (const std::uint32_t divisions : {1U, 3U}) {
    const FormFactors f = factors_of(cube(divisions));
    const FormFactorReport& report = f.report();
    EXPECT_EQ(report.open_pairs, report.facing_pairs);
    EXPECT_EQ(report.rays, f.zones() * ZoneLeaks::kRaysPerZone);
    EXPECT_EQ(report.closed_zones, f.zones());
    EXPECT_NEAR(report.before.lowest, 1, 1e-11);
    EXPECT_NEAR(report.before.highest, 1, 1e-11);
    EXPECT_LT(report.before.rms_deviation, 1e-11);
    EXPECT_EQ(report.after.lowest, report.before.lowest) << "nothing is sampled, so nothing may change";
  }
}

/// Form factor between two surfaces of one zone set each, from zone factors.
double surface_factor(const FormFactors& f, const ZoneMesh& mesh, std::size_t from, std::size_t to,
                      double& error) {
  double exchange = 0;
  double area = 0;
  double variance = 0;
  for (std::size_t i = 0; i < f.zones(); ++i) {
    if (mesh.zone_surface(ZoneId(i)).index() != from) continue;
    area += f.zone_area(i);
    for (std::size_t j = 0; j < f.zones(); ++j) {
      if (mesh.zone_surface(ZoneId(j)).index() != to) continue;
      exchange += f.exchange_area(i, j);
      variance += std::pow(f.factor_error(i, j) * f.zone_area(i), 2);
    }
  }
  error = std::sqrt(variance) / area;
  return exchange / area;
}

/// L-shaped room: outer sides 3, arms of width 1, height 1.
RoomBuilder l_room(std::uint32_t divisions) {
  RoomBuilder room;
  const MaterialId m = room.material("all", 0.5, 1.0);
  const auto wall = [&](double x0, double y0, double x1, double y1) {
    room.quad(m, {Vec3(x0, y0, 0), Vec3(x0, y0, 1), Vec3(x1, y1, 1), Vec3(x1, y1, 0)}, divisions);
  };
  wall(0, 0, 3, 0);  // S1
  wall(3, 0, 3, 1);
  wall(3, 1, 1, 1);
  wall(1, 1, 1, 3);
  wall(1, 3, 0, 3);
  wall(0, 3, 0, 0);  // S6
  const auto level = [&](double x0, double y0, double x1, double y1) {
    room.quad(m, {Vec3(x0, y0, 0), Vec3(x1, y0, 0), Vec3(x1, y1, 0), Vec3(x0, y1, 0)}, divisions);
    room.quad(m, {Vec3(x0, y0, 1), Vec3(x0, y1, 1), Vec3(x1, y1, 1), Vec3(x1, y0, 1)}, divisions);
  };
  level(0, 0, 1, 1);
  level(1, 0, 3, 1);
  level(0, 1, 1, 3);
  return room;
}

TEST(FormFactors, LRoomHasItsObstructedFactor) {
  // Reference case lroom.F16.PB: 0.1131634213 (published layout, 1-D x 1-D Gauss with the exact shadow
  // limit). The limit is 5 standard errors plus 2e-5 for what first rays overlook: odds below 1 in 10^6.
  const RoomBuilder room = l_room(4);
  const MeshResult meshed = room.mesh();
  for (const bool enforce : {false, true}) {
    const FormFactors f = factors_of(room, enforce);
    double error = 0;
    const double factor = surface_factor(f, meshed.mesh, 0, 5, error);
    EXPECT_NEAR(factor, 0.1131634213028795, 5 * error + 2e-5) << enforce;
    EXPECT_LT(error, 2e-4);
    EXPECT_GT(std::fabs(1.02 * factor - 0.1131634213028795), 5 * error + 2e-5) << "2 % must be seen";
  }
}

TEST(FormFactors, ClosureIsEnforcedAndExactPairsStay) {
  const FormFactors before = factors_of(box_with_block(4), false);
  const FormFactors after = factors_of(box_with_block(4), true);
  const FormFactorReport& report = after.report();
  EXPECT_EQ(report.closed_zones, after.zones());
  EXPECT_GT(report.sampled_pairs, 0U);
  EXPECT_GT(report.open_pairs, 0U);
  EXPECT_LT(report.before.rms_deviation, 0.01) << "sampling and the rule of the first rays";
  EXPECT_GT(report.before.rms_deviation, 1e-6);
  EXPECT_LT(report.after.rms_deviation, 1e-12);
  EXPECT_EQ(before.report().before.rms_deviation, report.before.rms_deviation);
  double changed = 0;
  std::size_t sampled = 0;
  for (std::size_t i = 0; i < after.zones(); ++i)
    for (std::size_t j = 0; j < after.zones(); ++j) {
      EXPECT_GE(after.exchange_area(i, j), 0);
      if (after.factor_error(i, j) > 0) {
        changed += std::pow((after.factor(i, j) - before.factor(i, j)) / after.factor_error(i, j), 2);
        ++sampled;
      } else {
        EXPECT_EQ(after.exchange_area(i, j), before.exchange_area(i, j)) << i << " " << j;
      }
    }
  EXPECT_LT(changed / static_cast<double>(sampled), 2) << "changes of the order of the standard errors";
}

// Two plates of 1 cm stand in a box of 1 m, whose zones see each other past them: what those rows lack must
// not be asked of the few pairs with the plates. The factor between these has a closed form.
TEST(FormFactors, ClosureLeavesThePairsOfSmallThingsInALargeRoom) {
  RoomBuilder room;
  const MaterialId black = room.material("black", 0);
  const MaterialId plate = room.material("plate", 0, 0, true);
  room.box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {black, black, black, black, black, black}, 5);
  const double h = 0.005;
  room.quad(plate, {Vec3(-h, -h, -h), Vec3(h, -h, -h), Vec3(h, h, -h), Vec3(-h, h, -h)}, 1);
  room.quad(plate, {Vec3(-h, -h, h), Vec3(-h, h, h), Vec3(h, h, h), Vec3(h, -h, h)}, 1);
  const ZoneMesh mesh = room.mesh().mesh;
  const FormFactors f = factors_of(room, true);
  EXPECT_LT(f.report().after.rms_deviation, f.report().before.rms_deviation);
  for (std::size_t i = 0; i < f.zones(); ++i) {
    const auto is_of_plate = [&](std::size_t zone) { return mesh.zone_area(ZoneId(zone)) < 1e-3; };
    double sum = 0;
    double to_plates = 0;
    for (std::size_t j = 0; j < f.zones(); ++j) {
      sum += f.factor(i, j);
      if (is_of_plate(j)) to_plates += f.factor(i, j);
    }
    EXPECT_NEAR(sum, 1, 1e-3) << i;
    if (!is_of_plate(i)) continue;
    EXPECT_NEAR(to_plates, mesh.zone_is_front(ZoneId(i)) ? 0.199825 : 0, 1e-3) << i;
  }
}

TEST(FormFactors, ReciprocityHoldsToTheBit) {
  const FormFactors f = factors_of(box_with_block(3));
  for (std::size_t i = 0; i < f.zones(); ++i)
    for (std::size_t j = 0; j < f.zones(); ++j) EXPECT_EQ(f.exchange_area(i, j), f.exchange_area(j, i));
}

TEST(FormFactors, OpenBoxLacksWhatItsOpeningTakes) {
  RoomBuilder room;
  const MaterialId m = room.material("all", 0.5, 1.0);
  room.box(Vec3::Zero(), Vec3(1, 1, 1), {m, m, m, m, m, MaterialId()}, 2);
  const FormFactors f = factors_of(room);
  const MeshResult meshed = room.mesh();
  const Eigen::VectorXd sums = f.row_sums();
  double escaping = 0;
  for (std::size_t i = 0; i < f.zones(); ++i)
    if (meshed.mesh.zone_surface(ZoneId(i)).index() == 4)  // the floor
      escaping += f.zone_area(i) * (1 - sums(static_cast<Eigen::Index>(i)));
  EXPECT_NEAR(escaping, 0.19982489569838738, 1e-11);
  EXPECT_EQ(f.report().closed_zones, 0U);
  EXPECT_EQ(f.report().rays, f.zones() * ZoneLeaks::kRaysPerZone) << "a convex room needs no shadow rays";
}

TEST(FormFactors, TwoSidesOfASheetAreZonesOfTheirOwn) {
  RoomBuilder room = cube(2);
  const MaterialId sheet = room.material("sheet", 0.5, 0, true);
  room.quad(sheet, {Vec3(0.5, 0, 0), Vec3(0.5, 1, 0), Vec3(0.5, 1, 1), Vec3(0.5, 0, 1)},
            2);  // parts the room
  const FormFactors f = factors_of(room);
  const MeshResult meshed = room.mesh();
  for (std::size_t i = 0; i < f.zones(); ++i)
    for (std::size_t j = 0; j < f.zones(); ++j) {
      const double x = meshed.mesh.zone_centroid(ZoneId(i)).x();
      const double y = meshed.mesh.zone_centroid(ZoneId(j)).x();
      if (std::max(x, y) > 0.55 && std::min(x, y) < 0.45) {
        EXPECT_EQ(f.exchange_area(i, j), 0);
      }
    }
  EXPECT_LT(f.report().after.rms_deviation, 1e-11);
  EXPECT_EQ(f.report().closed_zones, f.zones());
}

TEST(FormFactors, SameBitsOnAnyNumberOfThreads) {
  const FormFactors one = factors_of(box_with_block(3), true, 1);
  const FormFactors two = factors_of(box_with_block(3), true, 2);
  for (std::size_t i = 0; i < one.zones(); ++i)
    for (std::size_t j = i + 1; j < one.zones(); ++j) {
      EXPECT_EQ(one.exchange_area(i, j), two.exchange_area(i, j));
      EXPECT_EQ(one.factor_error(i, j), two.factor_error(i, j));
    }
}

TEST(FormFactors, JoinedCellsGiveThoseOfGroups) {
  // All walls of a unit cube but the last are one zone, which sees itself.
  BaseMesh base = cube(2).mesh().mesh.base();
  ZoneGroups groups{.of_side = std::vector<std::uint32_t>(2 * base.triangles.size(), ZoneGroups::kOwn),
                    .count = 1};
  for (std::size_t t = 0; t < base.triangles.size(); ++t) {
    BaseTriangle& triangle = base.triangles[t];
    if (triangle.surface == SurfaceId(5)) continue;
    triangle.surface = SurfaceId(0);
    groups.of_side[side_of(TriangleId(t), true).index()] = 0;
  }
  const ZoneMesh cells(base);
  const RayTracer rays(cells);
  const std::atomic<bool> interrupt = false;
  const FormFactors of_cells = compute_form_factors(cells, rays, {.seed = 11}, nullptr, interrupt);
  const ZoneMesh zones(base, groups);
  const FormFactors f = join_cells(of_cells, zones);
  ASSERT_EQ(f.zones(), zones.zone_count());
  const std::size_t group = f.zones() - 1;
  EXPECT_NEAR(f.zone_area(group), 5, 1e-12);
  EXPECT_NEAR(f.factor(group, group), 4.0 / 5, 1e-11);
  for (std::size_t z = 0; z < group; ++z) {
    EXPECT_NEAR(f.factor(z, group), 1, 1e-11);
    EXPECT_NEAR(f.factor(group, z), f.zone_area(z) / 5, 1e-11);
  }
  EXPECT_NEAR(f.report().after.lowest, 1, 1e-11);
  EXPECT_NEAR(f.report().after.highest, 1, 1e-11);
  // Without groups they stay what they are, with their errors.
  const FormFactors block = factors_of(box_with_block(2));
  const FormFactors same = join_cells(block, box_with_block(2).mesh().mesh);
  for (std::size_t i = 0; i < block.zones(); ++i)
    for (std::size_t j = 0; j < block.zones(); ++j) {
      EXPECT_EQ(same.exchange_area(i, j), block.exchange_area(i, j));
      EXPECT_NEAR(same.factor_error(i, j), block.factor_error(i, j), 1e-6 * block.factor_error(i, j));
    }
  EXPECT_THROW(join_cells(block, cells), std::invalid_argument);
}

TEST(FormFactors, ErrorsOfJoinedCellsAddUpInSquares) {
  const MeshResult meshed = box_with_block(3).mesh();
  const FormFactors of_cells = factors_of(box_with_block(3));
  const auto of_surface = [&](std::size_t s) {
    std::vector<std::uint32_t> members(meshed.mesh.side_count(), ZoneGroups::kOwn);
    for (std::size_t t = 0; t < meshed.mesh.triangle_count(); ++t)
      if (meshed.mesh.triangle(TriangleId(t)).surface == SurfaceId(s))
        members[side_of(TriangleId(t), true).index()] = 0;
    return members;
  };
  // Two walls between which the block stands are zones.
  std::size_t sampled = 0;
  for (std::size_t to = 1; to < 6; ++to) {
    ZoneGroups groups{.of_side = of_surface(0), .count = 2};
    const std::vector<std::uint32_t> others = of_surface(to);
    for (std::size_t side = 0; side < others.size(); ++side)
      if (others[side] == 0) groups.of_side[side] = 1;
    const FormFactors f = join_cells(of_cells, ZoneMesh(meshed.mesh.base(), groups));
    const std::size_t first = f.zones() - 2;
    double error = 0;
    const double factor = surface_factor(of_cells, meshed.mesh, 0, to, error);
    EXPECT_NEAR(f.factor(first, first + 1), factor, 1e-12);
    EXPECT_NEAR(f.factor_error(first, first + 1), error, 1e-5 * error);
    sampled += error > 0 ? 1U : 0U;
  }
  EXPECT_GT(sampled, 0U);
}

TEST(FormFactors, TooManyZonesAreRefusedWithAdvice) {
  EXPECT_THAT(test::refusal_of([] { factors_of(cube(40)); }), testing::HasSubstr("--zone-area"))
      << "19200 zones";
}

TEST(FormFactors, ZonesOfSeveralTrianglesAreRefusedWithAdvice) {
  BaseMesh base = cube(2).mesh().mesh.base();
  for (BaseTriangle& t : base.triangles) t.divisions = 1;
  ZoneGroups groups;
  groups.of_side.assign(side_count(base.triangles.size()), ZoneGroups::kOwn);
  ASSERT_EQ(base.triangles[0].surface, base.triangles[1].surface);
  for (const std::size_t t : {0U, 1U}) groups.of_side[side_of(TriangleId(t), true).index()] = 0;
  groups.count = 1;
  const ZoneMesh mesh(std::move(base), std::move(groups));
  const RayTracer rays(mesh);
  const std::atomic<bool> interrupt = false;
  EXPECT_THAT(test::refusal_of([&] { compute_form_factors(mesh, rays, {}, nullptr, interrupt); }),
              testing::HasSubstr("share_zones"));
}

TEST(FormFactors, InterruptLeavesNothing) {
  const MeshResult meshed = cube(4).mesh();
  const RayTracer rays(meshed.mesh);
  const std::atomic<bool> interrupt = true;
  EXPECT_THROW(compute_form_factors(meshed.mesh, rays, {}, nullptr, interrupt), Interrupted);
}

}  // namespace
}  // namespace reemit

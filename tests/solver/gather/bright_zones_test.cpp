#include "solver/gather/bright_zones.h"

#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "solver/gather/gather_batch.h"
#include "solver/gather/replicate_gather.h"
#include "tests/support/contour_irradiance.h"
#include "tests/support/hand_made_solution.h"
#include "tests/support/mean_test.h"
#include "tests/support/variable_furnace.h"

namespace reemit {
namespace {

using test::Contour;
using test::MeanTest;

constexpr double kIrradiance = 7;
constexpr double kDarkWall = 0.01;
constexpr double kPatch = 0.8;

/// A dark room with two light patches, one below the ceiling and one before a wall, 2 % of its area, under
/// the same irradiance everywhere.
struct PatchRoom {
  test::RoomBuilder builder;
  std::array<Contour, 2> patches{
      Contour{Vec3(1, 1, 1.9), Vec3(1, 1.5, 1.9), Vec3(2, 1.5, 1.9), Vec3(2, 1, 1.9)},
      Contour{Vec3(0.05, 2, 0.5), Vec3(0.05, 2.5, 0.5), Vec3(0.05, 2.5, 1), Vec3(0.05, 2, 1)}};

  explicit PatchRoom(bool two_sided = false) {
    const MaterialId wall = builder.material("wall", kDarkWall);
    const MaterialId light = builder.material("light", kPatch, 0, two_sided);
    builder.box(Vec3::Zero(), {4, 3, 2}, {wall, wall, wall, wall, wall, wall}, 4);
    for (const Contour& p : patches) builder.quad(light, {p[0], p[1], p[2], p[3]}, 12);
  }

  /// Mean radiance over the hemisphere at a point of a wall that sees but the fronts of the patches: whatever
  /// else is seen is wall.
  double radiance(const Vec3& x, const Vec3& n) const {
    double result = kDarkWall * kIrradiance;
    for (const Contour& patch : patches)
      result += (kPatch - kDarkWall) * kIrradiance * test::contour_irradiance(patch, x, n) / std::numbers::pi;
    return result / std::numbers::pi;
  }
};

/// A point of a wall that faces along the axis `up`.
SurfacePoint wall_point(const Room& room, const Vec3& at, const Vec3& normal) {
  const Vec3 before = at + 1e-3 * normal;
  Hit hit;
  EXPECT_TRUE(room.rays().closest(room.rays().normalised(before), (-normal).cast<float>(), hit));
  return surface_point(room.rays(), hit.triangle, hit.u, hit.v, hit.front);
}

/// Gathers with an aimed ray for every two others, or without any.
template <class Place>
MeanTest gathered(const HemisphereGather& gather, const DirectLight& direct, const Place& x, bool aims,
                  double bias = 1) {
  constexpr int kReplicates = 64;
  constexpr ReplicateEffort kEffort{256, 2};
  MeanTest test;
  for (std::uint32_t r = 0; r < kReplicates; ++r) {
    GatherBatch batch(gather, aims ? kEffort.gathers : 0);
    EXPECT_EQ(batch.aims(), aims);
    const PointSampler sampler(3, RngPurpose::kProbe, 0, static_cast<int>(r),
                               std::countr_zero(static_cast<unsigned>(kEffort.points)));
    float none = 0;
    float sum = 0;
    add_replicate(
        direct, sampler, kEffort, {0, r, 0, 0}, [&](const auto&) { return x; }, batch, &none, &sum);
    batch.flush();
    test.add(bias * static_cast<double>(sum));
  }
  return test;
}

class BrightZonesOfPatches : public ::testing::Test {
 protected:
  PatchRoom patches_;
  Solution solution_ = test::uniform_solution(patches_.builder, 0.25 * kIrradiance, 0.75 * kIrradiance);
  Room room_{patches_.builder.scene(), solution_.mesh};
  RadianceField field_{room_, solution_};
  DirectLight direct_{room_};
  HemisphereGather gather_{field_, direct_, {.close_hit = 0, .continue_uneven = false}};
};

TEST_F(BrightZonesOfPatches, are_all_zones_of_the_patches_and_no_others) {
  const BrightZones& bright = gather_.bright();
  ASSERT_FALSE(bright.empty());
  const ZoneMesh& mesh = room_.mesh();
  double area = 0;
  for (std::size_t z = 0; z < mesh.zone_count(); ++z) {
    EXPECT_EQ(bright.holds(ZoneId(z)), room_.zone_reflectance(ZoneId(z))[0] > 0.5F);
    if (bright.holds(ZoneId(z))) area += mesh.zone_area(ZoneId(z));
  }
  EXPECT_NEAR(area, 0.5 + 0.25, 1e-9);
}

/// Against Lambert's contour integral. 5 standard errors of 64 replicates at 7 points, odds of a false alarm
/// below 1 in 5,000; a bias of 2 % would be noticed at each.
TEST_F(BrightZonesOfPatches, gather_what_the_contour_integral_says) {
  struct Place {
    Vec3 at, normal;
  };
  const std::vector<Place> places{{{1.5, 1.2, 0}, {0, 0, 1}},  {{3.8, 0.1, 0}, {0, 0, 1}},
                                  {{0.1, 2.2, 0}, {0, 0, 1}},  {{4, 2.2, 0.8}, {-1, 0, 0}},
                                  {{2, 0, 1.85}, {0, 1, 0}},   {{1.5, 0, 0.3}, {0, 1, 0}},
                                  {{0.1, 3, 0.75}, {0, -1, 0}}};
  for (const Place& place : places) {
    const SurfacePoint x = wall_point(room_, place.at, place.normal);
    const double truth = patches_.radiance(place.at, place.normal);
    const MeanTest aimed = gathered(gather_, direct_, x, true);
    EXPECT_TRUE(aimed.agrees_with(truth)) << place.at.transpose();
    EXPECT_TRUE(aimed.would_notice(0.02, truth)) << place.at.transpose();
    EXPECT_FALSE(gathered(gather_, direct_, x, true, 1.02).agrees_with(truth)) << place.at.transpose();
  }
}

/// A sheet that is bright on both sides has bright zones on both, and a ray aimed at one of its back meets
/// its front. Limits as above.
TEST(BrightZonesOfSheets, are_not_met_from_behind) {
  const PatchRoom patches(true);
  const Solution solution = test::uniform_solution(patches.builder, 0.25 * kIrradiance, 0.75 * kIrradiance);
  const Room room(patches.builder.scene(), solution.mesh);
  const RadianceField field(room, solution);
  const DirectLight direct(room);
  const HemisphereGather gather(field, direct, {.close_hit = 0, .continue_uneven = false});
  const Vec3 at(1.5, 1.2, 0);
  const SurfacePoint x = wall_point(room, at, Vec3::UnitZ());
  const double truth = patches.radiance(at, Vec3::UnitZ());
  const MeanTest aimed = gathered(gather, direct, x, true);
  EXPECT_TRUE(aimed.agrees_with(truth));
  EXPECT_TRUE(aimed.would_notice(0.02, truth));
}

TEST_F(BrightZonesOfPatches, are_found_from_points_in_the_air_as_well) {
  const Vec3 at(1.7, 1.4, 1.3);
  const Vec3 normal = Vec3(-0.3, 0.2, 1).normalized();
  const MeasuringPoint x = measuring_point(room_.rays(), at, normal);
  const MeanTest aimed = gathered(gather_, direct_, x, true);
  EXPECT_TRUE(aimed.agrees_with(patches_.radiance(at, normal)));
  EXPECT_TRUE(aimed.would_notice(0.02, patches_.radiance(at, normal)));
}

TEST_F(BrightZonesOfPatches, leave_less_noise_than_rays_that_go_anywhere) {
  const SurfacePoint x = wall_point(room_, {3.8, 0.1, 0}, Vec3::UnitZ());
  EXPECT_LT(3 * gathered(gather_, direct_, x, true).standard_error(),
            gathered(gather_, direct_, x, false).standard_error());
}

TEST(BrightZones, are_none_in_a_furnace_or_without_light) {
  const test::VariableFurnace furnace(6);
  const double b = test::VariableFurnace::kRadiosity;
  for (const Solution& solution :
       {test::uniform_solution(furnace.room(), 0.5 * b, 0.5 * b), test::dark_solution(furnace.room())}) {
    const Room room(furnace.room().scene(), solution.mesh);
    const RadianceField field(room, solution);
    EXPECT_TRUE(BrightZones(field).empty());
  }
}

}  // namespace
}  // namespace reemit

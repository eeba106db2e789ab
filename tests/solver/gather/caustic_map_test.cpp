// Light over a mirror, by photons and gather rays together, against the image of the lamp behind the mirror;
// a lamp inside of a ball of glass against the lamp without it.

#include "solver/gather/caustic_map.h"

#include <array>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "solver/gather/direct_light.h"
#include "solver/gather/gather_batch.h"
#include "solver/gather/hemisphere_gather.h"
#include "solver/gather/path_tracer.h"
#include "solver/gather/radiance_field.h"
#include "solver/room/room.h"
#include "solver/sampling/counter_rng.h"
#include "tests/solver/floor_point.h"
#include "tests/support/hand_made_solution.h"
#include "tests/support/mean_test.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using test::floor_point;
using test::MeanTest;
using test::RoomBuilder;

constexpr double kFloorLength = 4;  // its length away from the mirror, which stands on the near end [m]

constexpr double kScreenAt = 2;

/// A floor, and a lamp above it at x = 1 before a mirror at x = 0, or behind it; if asked for with a thin
/// black screen upright on the floor.
RoomBuilder room_with(bool mirror, double lamp_at, bool screen = false) {
  RoomBuilder room;
  const MaterialId grey = room.material("floor", 0.5);
  const MaterialId lamp = room.material("lamp", 0, 10);
  room.quad(grey, {Vec3(0, -2, 0), Vec3(kFloorLength, -2, 0), Vec3(kFloorLength, 2, 0), Vec3(0, 2, 0)}, 4);
  if (screen) {
    const MaterialId black = room.material("screen", 0, 0, true);
    room.quad(
        black,
        {Vec3(kScreenAt, -2, 0), Vec3(kScreenAt, 2, 0), Vec3(kScreenAt, 2, .5), Vec3(kScreenAt, -2, .5)}, 1);
  }
  const double x = lamp_at;
  room.quad(lamp, {Vec3(x - .2, -.2, 2), Vec3(x - .2, .2, 2), Vec3(x + .2, .2, 2), Vec3(x + .2, -.2, 2)}, 1);
  if (!mirror) return room;
  const MaterialId silver = room.material("mirror", 0);
  room.scene().materials[silver.index()].non_diffuse.specular_reflectance = Spectrum::Constant(1, 0.8);
  room.quad(silver, {Vec3(0, -9, 0), Vec3(0, 9, 0), Vec3(0, 9, 9), Vec3(0, -9, 9)}, 1);
  return room;
}

/// Irradiance at a point by what `rays` gather rays find [W/m2].
double gathered(const HemisphereGather& gather, const SurfacePoint& x, std::size_t number,
                std::uint32_t rays) {
  const CounterRng rng(4, RngPurpose::kHemisphere);
  const float weight = 1.0F / static_cast<float>(rays);
  float sum = 0;
  GatherBatch batch(gather);
  for (std::uint32_t k = 0; k < rays; ++k) {
    const auto u = rng.uniform4(number, 0, k);
    batch.add(x, u[0], u[1], PathKey{number, 0, k, 0}, &weight, &sum);
  }
  batch.flush();
  return std::numbers::pi * static_cast<double>(sum);
}
/// The same of the floor.
double gathered(const HemisphereGather& gather, const Vec3& at, std::size_t number, std::uint32_t rays) {
  return gathered(gather, floor_point(gather.room(), at.x(), at.y()), number, rays);
}

/// Irradiance over the mirror by what is gathered at points of the floor, over that of the image.
MeanTest over_truth(const std::vector<Vec3>& points, bool screen = false, std::uint64_t seed = 1) {
  const RoomBuilder room = room_with(true, 1, screen);
  const Solution dark = test::dark_solution(room);
  const Room walls(room.scene(), dark.mesh);
  const DirectLight direct(walls);
  const RadianceField field(walls, dark);
  const HemisphereGather gather(field, direct,
                                GatherSettings{.close_hit = 0, .caustics = true, .seed = seed});
  EXPECT_TRUE(gather.caustics().exists());
  EXPECT_LT(gather.caustics().left_to_rays(SurfaceId(screen ? 2 : 1)), 0.1F);
  const RoomBuilder behind = room_with(false, -1, screen);
  const ZoneMesh mesh = behind.mesh().mesh;
  const Room image(behind.scene(), mesh);
  const DirectLight of_image(image);
  MeanTest mean;
  for (std::size_t i = 0; i < points.size(); ++i) {
    double truth = 0;
    of_image.add_samples(floor_point(image, points[i].x(), points[i].y()), SobolSequence(9), 0, 256, &truth);
    mean.add(gathered(gather, points[i], i, 256) / (0.8 * truth / 256));
  }
  return mean;
}

TEST(CausticPower, MirrorShowsTheLampBehindIt) {
  std::vector<Vec3> points;
  for (int i = 0; i < 24; ++i)
    for (int j = 0; j < 24; ++j) points.emplace_back(0.4 + 0.14 * i, -1.7 + 0.14 * j, 0);
  const MeanTest mean = over_truth(points);
  EXPECT_TRUE(mean.agrees_with(1));
  EXPECT_TRUE(mean.would_notice(0.1, 1));
}

TEST(CausticMap, LosesNothingWhereAFaceEnds) {
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i) points.emplace_back(kFloorLength - 0.01, -1.8 + 3.6 * i / 299, 0);
  // By 3 sets of photons, as all points of one share its noise.
  MeanTest mean;
  for (const std::uint64_t seed : {1, 2, 3}) mean.add(over_truth(points, false, seed).mean());
  RecordProperty("over_truth", std::to_string(mean.mean()));
  // Without a look for the end of the face, 0.55.
  EXPECT_NEAR(mean.mean(), 1, 5 * mean.standard_error() + 0.03);
  EXPECT_LT(mean.standard_error(), 0.02);
}

TEST(CausticPower, DoesNotReadThroughWhatStandsOnAFace) {
  std::vector<Vec3> before;
  for (int i = 0; i < 300; ++i) before.emplace_back(kScreenAt - 0.03, -1.8 + 3.6 * i / 299, 0);
  const MeanTest lit = over_truth(before, true);
  EXPECT_NEAR(lit.mean(), 1, 5 * lit.standard_error() + 0.05);

  const RoomBuilder room = room_with(true, 1, true);
  const Solution dark = test::dark_solution(room);
  const Room walls(room.scene(), dark.mesh);
  const DirectLight direct(walls);
  const RadianceField field(walls, dark);
  const HemisphereGather gather(field, direct, GatherSettings{.close_hit = 0, .caustics = true});
  double shadow = 0;
  double open = 0;
  for (std::size_t i = 0; i < 100; ++i) {
    const double y = -1.8 + 3.6 * static_cast<double>(i) / 99;
    shadow += gathered(gather, {kScreenAt + 0.03, y, 0}, i, 64);
    open += gathered(gather, {kScreenAt - 0.03, y, 0}, i, 64);
  }
  // Without a look for the screen, 0.17.
  EXPECT_LT(shadow, 0.01 * open);
}

TEST(CausticMap, DoesNotReachWhatLiesAHairsBreadthBelow) {
  RoomBuilder room = room_with(true, 1);
  const MaterialId cover = room.material("cover", 0.5, 0, true);
  constexpr double kAbove = 2e-4;
  room.quad(cover, {Vec3(1, -2, kAbove), Vec3(3, -2, kAbove), Vec3(3, 2, kAbove), Vec3(1, 2, kAbove)}, 4);
  const Solution dark = test::dark_solution(room);
  const Room walls(room.scene(), dark.mesh);
  const DirectLight direct(walls);
  const RadianceField field(walls, dark);
  const HemisphereGather gather(field, direct, GatherSettings{.close_hit = 0, .caustics = true});
  double open = 0;
  for (std::size_t i = 0; i < 100; ++i) {
    const double y = -1.8 + 3.6 * static_cast<double>(i) / 99;
    Hit under;
    ASSERT_TRUE(
        walls.rays().closest(walls.rays().normalised(Vec3(2, y, kAbove / 2)), -Vec3f::UnitZ(), under));
    EXPECT_EQ(gathered(gather, surface_point(walls.rays(), under, -Vec3f::UnitZ()), i, 64), 0);
    open += gathered(gather, {0.9, y, 0}, i, 64);
  }
  EXPECT_GT(open, 0);
}

/// A floor, and a round lamp above it, if asked for inside of a ball of glass about it.
RoomBuilder room_with_bulb(bool glass) {
  RoomBuilder room;
  const MaterialId grey = room.material("floor", 0.5);
  const MaterialId bright = room.material("bulb", 0, 10);
  room.quad(grey, {Vec3(0, -2, 0), Vec3(kFloorLength, -2, 0), Vec3(kFloorLength, 2, 0), Vec3(0, 2, 0)}, 4);
  room.shape(bright, Sphere{Vec3(2, 0, 0.5), 0.1, false}, 2);
  if (!glass) return room;
  const MaterialId clear = room.material("glass", 0, 0, true);
  NonDiffusePart& part = room.scene().materials[clear.index()].non_diffuse;
  part.angle_law = AngleLaw::kDielectric;
  part.specular_transmittance = Spectrum::Constant(1, 1);
  part.index_of_refraction = 1.5;
  part.is_solid = true;
  room.shape(clear, Sphere{Vec3(2, 0, 0.5), 0.3, false}, 2);
  return room;
}

TEST(CausticPower, LampInsideOfGlassSendsItsPower) {
  // All its rays meet the glass within 20 degrees of upright, and what is mirrored there comes back to it: it
  // looks n times as large, n^2 times darker, and loses ((n-1)/(n+1))^2.
  constexpr double kLeft = 0.96;
  const RoomBuilder room = room_with_bulb(true);
  const Solution dark = test::dark_solution(room);
  const Room walls(room.scene(), dark.mesh);
  const DirectLight direct(walls);
  const RadianceField field(walls, dark);
  const HemisphereGather by_photons(field, direct, GatherSettings{.close_hit = 0, .caustics = true});
  const HemisphereGather by_rays(field, direct, GatherSettings{.close_hit = 0, .caustics = false});
  const PathTracer paths(walls, direct, 5);
  const RoomBuilder bare = room_with_bulb(false);
  const ZoneMesh mesh = bare.mesh().mesh;
  const Room air(bare.scene(), mesh);
  const DirectLight of_bulb(air);
  const CounterRng rng(6, RngPurpose::kHemisphere);
  std::array<MeanTest, 3> mean;
  for (std::size_t i = 0; i < 100; ++i) {
    const Vec3 at(1.7 + 0.06 * static_cast<double>(i % 10), -0.3 + 0.06 * static_cast<double>(i / 10), 0);
    double truth = 0;
    of_bulb.add_samples(floor_point(air, at.x(), at.y()), SobolSequence(9), 0, 256, &truth);
    truth *= kLeft / 256;
    constexpr std::uint32_t kRays = 2048;
    mean[0].add(gathered(by_photons, at, i, kRays) / truth);
    mean[1].add(gathered(by_rays, at, i, kRays) / truth);
    float sum = 0;
    for (std::uint32_t k = 0; k < kRays; ++k) {
      const auto u = rng.uniform4(i, 1, k);
      float weight = 1.0F / kRays;
      paths.add_indirect(floor_point(walls, at.x(), at.y()), u[0], u[1], PathKey{i, 0, k, 0}, &weight, &sum);
    }
    mean[2].add(std::numbers::pi * static_cast<double>(sum) / truth);
  }
  for (const MeanTest& m : mean) {
    EXPECT_TRUE(m.agrees_with(1));
    EXPECT_TRUE(m.would_notice(0.3, 1));
  }
}

TEST(CausticMap, IsEmptyWithoutMirrors) {
  const RoomBuilder room = room_with(false, 1);
  const ZoneMesh mesh = room.mesh().mesh;
  const Room walls(room.scene(), mesh);
  EXPECT_FALSE(CausticMap(walls, 2, 1, nullptr, nullptr).exists());
  EXPECT_FALSE(CausticMap().exists());
}

}  // namespace
}  // namespace reemit

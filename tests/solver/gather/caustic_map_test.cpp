// Light over a mirror, by photons and gather rays together, against the image of the lamp behind the mirror.

#include "solver/gather/caustic_map.h"

#include <array>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/gather/direct_light.h"
#include "solver/gather/hemisphere_gather.h"
#include "solver/gather/radiance_field.h"
#include "solver/room/room.h"
#include "solver/sampling/counter_rng.h"
#include "tests/support/hand_made_solution.h"
#include "tests/support/mean_test.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using test::MeanTest;
using test::RoomBuilder;

constexpr double kFloor = 4;  // its length away from the mirror, which stands on the near end [m]

/// A floor, and a lamp above it at x = 1 before a mirror at x = 0, or behind it.
RoomBuilder room_with(bool mirror, double lamp_at) {
  RoomBuilder room;
  const MaterialId grey = room.material("floor", 0.5);
  const MaterialId lamp = room.material("lamp", 0, 10);
  room.quad(grey, {Vec3(0, -2, 0), Vec3(kFloor, -2, 0), Vec3(kFloor, 2, 0), Vec3(0, 2, 0)}, 4);
  const double x = lamp_at;
  room.quad(lamp, {Vec3(x - .2, -.2, 2), Vec3(x - .2, .2, 2), Vec3(x + .2, .2, 2), Vec3(x + .2, -.2, 2)}, 1);
  if (!mirror) return room;
  const MaterialId silver = room.material("mirror", 0);
  room.scene().materials[silver.index()].non_diffuse.specular_reflectance = Spectrum::Constant(1, 0.8);
  room.quad(silver, {Vec3(0, -9, 0), Vec3(0, 9, 0), Vec3(0, 9, 9), Vec3(0, -9, 9)}, 1);
  return room;
}

/// Where the floor is met from above.
SurfacePoint floor_point(const Room& room, double x, double y) {
  const RayTracer& rays = room.rays();
  const Vec3f above = ((Vec3(x, y, 1) - rays.centre()) / rays.metres_per_unit()).cast<float>();
  Hit hit;
  EXPECT_TRUE(rays.closest(above, {0, 0, -1}, hit));
  return surface_point(rays, hit.triangle, hit.u, hit.v, hit.front);
}

/// Irradiance over the mirror by what is gathered at points of the floor, over that of the image.
MeanTest over_truth(const std::vector<Vec3>& points) {
  const RoomBuilder room = room_with(true, 1);
  const Solution dark = test::dark_solution(room);
  const Room walls(room.scene(), dark.mesh);
  const DirectLight direct(walls);
  const RadianceField field(walls, dark);
  const HemisphereGather gather(field, direct, GatherSettings{.close_hit = 0, .caustics = true});
  EXPECT_TRUE(gather.caustics().exists());
  EXPECT_LT(gather.caustics().left_to_rays(SurfaceId(1)), 0.1F);
  const RoomBuilder behind = room_with(false, -1);
  const ZoneMesh mesh = behind.mesh().mesh;
  const Room image(behind.scene(), mesh);
  const DirectLight of_image(image);
  const CounterRng rng(4, RngPurpose::kHemisphere);
  MeanTest mean;
  for (std::size_t i = 0; i < points.size(); ++i) {
    double truth = 0;
    of_image.add_samples(floor_point(image, points[i].x(), points[i].y()), SobolSequence(9), 0, 256, &truth);
    truth *= 0.8 / 256;
    const SurfacePoint x = floor_point(walls, points[i].x(), points[i].y());
    constexpr std::uint32_t kRays = 256;
    const float weight = 1.0F / kRays;
    float sum = 0;
    GatherBatch batch(gather);
    for (std::uint32_t k = 0; k < kRays; ++k) {
      const auto u = rng.uniform4(i, 0, k);
      batch.add(x, u[0], u[1], PathKey{i, 0, k, 0}, &weight, &sum);
    }
    batch.flush();
    mean.add(std::numbers::pi * static_cast<double>(sum) / truth);
  }
  return mean;
}

TEST(CausticMap, MirrorShowsTheLampBehindIt) {
  std::vector<Vec3> points;
  for (int i = 0; i < 24; ++i)
    for (int j = 0; j < 24; ++j) points.emplace_back(0.4 + 0.14 * i, -1.7 + 0.14 * j, 0);
  const MeanTest mean = over_truth(points);
  EXPECT_TRUE(mean.agrees_with(1));
  EXPECT_TRUE(mean.would_notice(0.1, 1));
}

TEST(CausticMap, LosesNothingWhereAFaceEnds) {
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i) points.emplace_back(kFloor - 0.01, -1.8 + 3.6 * i / 299, 0);
  const MeanTest mean = over_truth(points);
  // Without a look for the end of the face, 0.55.
  EXPECT_NEAR(mean.mean(), 1, 5 * mean.standard_error() + 0.05);
  EXPECT_LT(mean.standard_error(), 0.02);
}

TEST(CausticMap, IsEmptyWithoutMirrors) {
  const RoomBuilder room = room_with(false, 1);
  const ZoneMesh mesh = room.mesh().mesh;
  const Room walls(room.scene(), mesh);
  EXPECT_FALSE(CausticMap(walls, 2, 1, nullptr).exists());
  EXPECT_FALSE(CausticMap().exists());
}

}  // namespace
}  // namespace reemit

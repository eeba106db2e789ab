// Parallel light over a mirror makes a strip with sharp edges on the floor: what is read across it adds up to
// what the mirror sends.
#include <array>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/gather/caustic_map.h"
#include "solver/room/room.h"
#include "solver/sampling/counter_rng.h"
#include "tests/support/mean_test.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using test::MeanTest;
using test::RoomBuilder;

constexpr double kLow = 0.3, kHigh = 0.36;  // of the mirror [m]; the strip is as far away from it
constexpr double kBeam = 5;                 // [W/m2] across the light
constexpr double kMirror = 0.9;

/// A floor 1.2 m long, and an upright mirror above its end that light meets at 45 degrees.
RoomBuilder floor_before_mirror() {
  RoomBuilder room;
  const MaterialId grey = room.material("floor", 0.5);
  const MaterialId silver = room.material("mirror", 0);
  room.scene().materials[silver.index()].non_diffuse.specular_reflectance = Spectrum::Constant(1, kMirror);
  room.quad(grey, {Vec3(0, -.6, 0), Vec3(1, -.6, 0), Vec3(1, .6, 0), Vec3(0, .6, 0)}, 4);
  room.quad(silver, {Vec3(0, -.5, kLow), Vec3(0, .5, kLow), Vec3(0, .5, kHigh), Vec3(0, -.5, kHigh)}, 1);
  room.scene().lights.push_back(
      DirectionalLight{"sun", Vec3(-1, 0, -1).normalized(), Spectrum::Constant(1, kBeam)});
  return room;
}

TEST(CausticTotal, IsWhatCameWhereEdgesAreSharp) {
  constexpr std::size_t kParts = 32;
  constexpr std::uint32_t kPoints = 4096;  // for each part
  constexpr double kFrom = kLow - 0.04, kTo = kHigh + 0.04;
  const RoomBuilder builder = floor_before_mirror();
  const ZoneMesh mesh = builder.mesh().mesh;
  const Room room(builder.scene(), mesh);
  const RayTracer& rays = room.rays();
  const CausticMap map(room, kParts, 1, nullptr);
  ASSERT_TRUE(map.exists());
  const CounterRng rng(3, RngPurpose::kHemisphere);
  const float white = 1;
  MeanTest power;  // of a metre of the strip [W/m]
  for (std::uint32_t part = 0; part < kParts; ++part) {
    float sum = 0;
    for (std::uint32_t k = 0; k < kPoints; ++k) {
      const std::array<float, 4> u = rng.uniform4(k, part, 0);
      const double x = kFrom + (kTo - kFrom) * (k + static_cast<double>(u[0])) / kPoints;
      const Vec3 at(x, 0.9 * (static_cast<double>(u[1]) - 0.5), 0.01);
      Hit hit;
      ASSERT_TRUE(
          rays.closest(((at - rays.centre()) / rays.metres_per_unit()).cast<float>(), {0, 0, -1}, hit));
      map.add_reflected(surface_point(rays, hit.triangle, hit.u, hit.v, hit.front), part, true, u[2],
                        {&white, 1}, &white, &sum);
    }
    power.add(static_cast<double>(sum) / kPoints * (kTo - kFrom));
  }
  const double truth = kMirror * kBeam / std::numbers::sqrt2 * (kHigh - kLow);
  RecordProperty("over_truth", std::to_string(power.mean() / truth));
  EXPECT_TRUE(power.agrees_with(truth));
  EXPECT_TRUE(power.would_notice(0.02, truth)) << power.standard_error() / truth;
}

}  // namespace
}  // namespace reemit

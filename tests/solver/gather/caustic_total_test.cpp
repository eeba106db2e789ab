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

constexpr double kCut = 0.303;  // where light ends that a wall or the end of the floor cuts off

enum class End { kFar, kOfFloor, kWall, kOfBoard };
constexpr double kBoardFrom = 0.32, kBoardTo = 0.323;  // a floor that ends on both sides

/// A floor 1.2 m wide, and an upright mirror above its end that light meets at 45 degrees.
RoomBuilder floor_before_mirror(End end) {
  RoomBuilder room;
  const MaterialId grey = room.material("floor", 0.5);
  const MaterialId silver = room.material("mirror", 0);
  room.scene().materials[silver.index()].non_diffuse.specular_reflectance = Spectrum::Constant(1, kMirror);
  const double from = end == End::kOfBoard ? kBoardFrom : 0;
  const double length = end == End::kOfFloor ? kCut : end == End::kOfBoard ? kBoardTo : 1;
  room.quad(grey, {Vec3(from, -.6, 0), Vec3(length, -.6, 0), Vec3(length, .6, 0), Vec3(from, .6, 0)}, 4);
  room.quad(silver, {Vec3(0, -.5, kLow), Vec3(0, .5, kLow), Vec3(0, .5, kHigh), Vec3(0, -.5, kHigh)}, 1);
  if (end == End::kWall) {
    const MaterialId wall = room.material("wall", 0.5, 0, true);
    room.quad(wall, {Vec3(kCut, .6, 0), Vec3(kCut, -.6, 0), Vec3(kCut, -.6, .2), Vec3(kCut, .6, .2)}, 1);
  }
  room.scene().lights.push_back(
      DirectionalLight{"sun", Vec3(-1, 0, -1).normalized(), Spectrum::Constant(1, kBeam)});
  return room;
}

/// What is read on the floor between two distances from the mirror, for each metre of the strip [W/m].
MeanTest power_between(const RoomBuilder& builder, double from, double to, std::uint64_t maps = 2) {
  constexpr std::size_t kParts = 16;
  constexpr std::uint32_t kPoints = 4096;  // for each part
  const ZoneMesh mesh = builder.mesh().mesh;
  const Room room(builder.scene(), mesh);
  const RayTracer& rays = room.rays();
  const CounterRng rng(3, RngPurpose::kHemisphere);
  const float white = 1;
  MeanTest power;
  for (std::uint64_t seed = 1; seed <= maps; ++seed) {
    const CausticMap map(room, kParts, seed, nullptr, nullptr);
    EXPECT_TRUE(map.exists());
    for (std::uint32_t part = 0; part < kParts; ++part) {
      float sum = 0;
      for (std::uint32_t k = 0; k < kPoints; ++k) {
        const std::array<float, 4> u = rng.uniform4(k, part, 0);
        const double x = from + (to - from) * (k + static_cast<double>(u[0])) / kPoints;
        const Vec3 at(x, 0.9 * (static_cast<double>(u[1]) - 0.5), 0.01);
        Hit hit;
        EXPECT_TRUE(
            rays.closest(((at - rays.centre()) / rays.metres_per_unit()).cast<float>(), {0, 0, -1}, hit));
        map.add_reflected(surface_point(rays, hit.triangle, hit.u, hit.v, hit.front), part, true, u[2],
                          {&white, 1}, &white, &sum);
      }
      power.add(static_cast<double>(sum) / kPoints * (to - from));
    }
  }
  return power;
}

constexpr double kOverStrip = kMirror * kBeam / std::numbers::sqrt2;  // [W/m2] on the floor
constexpr double kMargin = 0.04;                                      // more than the radius of a photon

TEST(CausticTotal, IsWhatCameWhereEdgesAreSharp) {
  const MeanTest power = power_between(floor_before_mirror(End::kFar), kLow - kMargin, kHigh + kMargin);
  const double truth = kOverStrip * (kHigh - kLow);
  RecordProperty("over_truth", std::to_string(power.mean() / truth));
  EXPECT_TRUE(power.agrees_with(truth));
  EXPECT_TRUE(power.would_notice(0.02, truth)) << power.standard_error() / truth;
}

// A strip as narrow as the radius of a photon, along the end of the floor or the foot of a wall. With the
// part of the kernel beyond taken out of its area alone, 0.81.
TEST(CausticTotal, IsWhatCameWhereTheFloorEnds) {
  constexpr double kScaling = 0.03;  // to which the gains are those that keep the total
  for (const End end : {End::kOfFloor, End::kWall}) {
    const MeanTest power = power_between(floor_before_mirror(end), kLow - kMargin, kCut, 4);
    const double truth = kOverStrip * (kCut - kLow);
    RecordProperty(end == End::kWall ? "over_truth_wall" : "over_truth_end",
                   std::to_string(power.mean() / truth));
    EXPECT_NEAR(power.mean() / truth, 1, kScaling + 3 * power.standard_error() / truth);
    EXPECT_LT(power.standard_error() / truth, 0.02);
  }
}

// Even light on a board hardly wider than that, whose two ends are not one behind the other: gains of half
// planes alone read 1.25, what is lost beyond both ends told apart from that beyond one 1.17.
TEST(CausticTotal, IsNotMuchMoreThanCameOnANarrowBoard) {
  const MeanTest power =
      power_between(floor_before_mirror(End::kOfBoard), kBoardFrom + 1e-6, kBoardTo - 1e-6, 4);
  const double truth = kOverStrip * (kBoardTo - kBoardFrom);
  RecordProperty("over_truth_board", std::to_string(power.mean() / truth));
  EXPECT_GT(power.mean(), 0.98 * truth);
  EXPECT_LT(power.mean() + 3 * power.standard_error(), 1.22 * truth);
  EXPECT_LT(power.standard_error() / truth, 0.02);
}

}  // namespace
}  // namespace reemit

// Parallel light over a mirror makes a strip with sharp edges on the floor: what is read across it adds up to
// what the mirror sends.
#include <array>
#include <numbers>
#include <string>

#include <fmt/format.h>
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
constexpr double kBoardFrom = 0.32;  // where a floor begins that ends on both sides

/// A floor 1.2 m wide, for kOfBoard of the given length, and an upright mirror above its end that light meets
/// at 45 degrees.
RoomBuilder floor_before_mirror(End end, double board = 0) {
  RoomBuilder room;
  const MaterialId grey = room.material("floor", 0.5);
  const MaterialId silver = room.material("mirror", 0);
  room.scene().materials[silver.index()].non_diffuse.specular_reflectance = Spectrum::Constant(1, kMirror);
  const double from = end == End::kOfBoard ? kBoardFrom : 0;
  const double length = end == End::kOfFloor ? kCut : end == End::kOfBoard ? kBoardFrom + board : 1;
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
constexpr double kScaling = 0.03;  // to which gains at ends of faces keep the total

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
  for (const End end : {End::kOfFloor, End::kWall}) {
    const MeanTest power = power_between(floor_before_mirror(end), kLow - kMargin, kCut, 4);
    const double truth = kOverStrip * (kCut - kLow);
    RecordProperty(end == End::kWall ? "over_truth_wall" : "over_truth_end",
                   std::to_string(power.mean() / truth));
    EXPECT_NEAR(power.mean() / truth, 1, kScaling + 3 * power.standard_error() / truth);
    EXPECT_LT(power.standard_error() / truth, 0.02);
  }
}

// Even light on boards of a third and of a fifth of a photon's radius, which is made smaller there.
TEST(CausticTotal, IsWhatCameOnANarrowBoard) {
  for (const double width : {0.005, 0.003}) {
    const MeanTest power = power_between(floor_before_mirror(End::kOfBoard, width), kBoardFrom + 1e-6,
                                         kBoardFrom + width - 1e-6, 4);
    const double truth = kOverStrip * width;
    RecordProperty(fmt::format("over_truth_{}", width), std::to_string(power.mean() / truth));
    // With gains of half planes alone 1.25 on the narrower, with a radius as elsewhere 1.14.
    EXPECT_NEAR(power.mean() / truth, 1, kScaling + 3 * power.standard_error() / truth);
    EXPECT_LT(power.standard_error() / truth, 0.02);
  }
}

}  // namespace
}  // namespace reemit

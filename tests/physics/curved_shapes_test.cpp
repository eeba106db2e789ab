// Rooms of spheres, disks, cylinders and cones against closed forms.

#include <atomic>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "solver/progressive_solver.h"
#include "tests/support/chi_square.h"
#include "tests/support/test_rooms.h"
#include "tests/support/zone_irradiances.h"

namespace reemit {
namespace {

using test::furnace_fit;
using test::kFalseAlarm;
using test::RoomBuilder;

constexpr double kPi = std::numbers::pi;

Solution run(const Scene& scene, MeshResult mesh, SolveMethod method, std::uint64_t packets) {
  SolverSettings settings;
  settings.method = method;
  settings.packets = packets;
  settings.batch_packets = packets / 32;
  settings.gather_small_zones = false;
  settings.seed = 7;
  settings.threads = 2;
  const std::atomic<bool> interrupt = false;
  return solve_zones(scene, std::move(mesh), settings, nullptr, interrupt);
}

/// A box that holds a ball, a capped cylinder that stands on the floor, a truncated cone with caps and a
/// ring: everything emits 1 W/m2 and reflects rho.
RoomBuilder curved_furnace(double rho) {
  RoomBuilder room;
  const MaterialId wall = room.material("wall", rho, 1.0);
  const MaterialId m = room.material("bodies", rho, 1.0, true);
  room.scene().materials[m.index()].emits_both_sides = true;
  room.box({0, 0, 0}, {3, 3, 3}, {wall, wall, wall, wall, wall, wall}, 4);
  room.shape(m, Sphere{{0.8, 0.8, 0.9}, 0.6, false}, 2);
  room.shape(m, Cylinder{{2.2, 0.8, 0}, {2.2, 0.8, 1.1}, 0.4, false}, 2);
  room.shape(m, Disk{{2.2, 0.8, 1.1}, {0, 0, 1}, 0.4, 0}, 2);
  room.shape(m, Cone{{1, 2.2, 1}, {1, 2.2, 2}, 0.5, 0.2, false}, 2);
  room.shape(m, Disk{{1, 2.2, 1}, {0, 0, -1}, 0.5, 0}, 2);
  room.shape(m, Disk{{1, 2.2, 2}, {0, 0, 1}, 0.2, 0}, 2);
  room.shape(m, Disk{{2.2, 2.2, 2}, Vec3(1, 1, 1).normalized(), 0.5, 0.2}, 2);
  return room;
}

TEST(CurvedShapes, FurnaceHasItsClosedFormAndNothingEscapes) {
  for (const SolveMethod method : {SolveMethod::kShooting, SolveMethod::kWalk}) {
    const RoomBuilder room = curved_furnace(0.5);
    const Solution s = run(room.scene(), room.mesh(), method, 1'000'000);
    // Zones inside the closed bodies see a furnace too: both sides emit.
    EXPECT_GT(furnace_fit(s, 2.0), kFalseAlarm);
    EXPECT_LT(furnace_fit(s, 2.0 * 1.02), kFalseAlarm) << "a bias of 2 % went unnoticed";
    EXPECT_EQ(s.audit.bands[0].total_escaped(), 0);
  }
}

TEST(CurvedShapes, IntegratingSphereIsUniformWhereverTheLightHits) {
  // [cases] Indirect irradiance of a sphere of radius R: Phi / (4 pi R^2) * rho / (1 - rho), the same all
  // over.
  constexpr double kRho = 0.6;
  RoomBuilder room;
  const MaterialId wall = room.material("wall", kRho);
  room.shape(wall, Sphere{{0, 0, 0}, 1.5, true}, 4);
  room.scene().lights.push_back(PointLight{"lamp", {0.7, 0.3, -0.2}, room.flat(10 / (4 * kPi))});
  const Solution s = run(room.scene(), room.mesh(), SolveMethod::kShooting, 2'000'000);
  EXPECT_EQ(s.audit.bands[0].total_escaped(), 0);
  const double truth = 10 / (4 * kPi * 1.5 * 1.5) * kRho / (1 - kRho);
  std::vector<test::Measured> measured;
  std::vector<test::Measured> expected;
  for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
    const Estimate e = s.indirect_irradiance(ZoneId(z), 0);
    measured.push_back({e.mean, e.stderr_of_mean});
    expected.push_back({truth, 0});
  }
  EXPECT_GT(test::agreement(measured, expected, static_cast<double>(s.sums.batches)), kFalseAlarm);
}

TEST(CurvedShapes, ConcentricSpheresExchangeAsTheClosedFormSays) {
  // Two zones: everything from the inner sphere reaches the outer, F21 = (R1/R2)^2 of the outer returns.
  // B1 = M1 + rho1 B2, B2 = rho2 (k B1 + (1-k) B2).
  RoomBuilder room;
  const MaterialId inner = room.material("inner", 0.5, 1.0);
  const MaterialId outer = room.material("outer", 0.7);
  room.shape(inner, Sphere{{0, 0, 0}, 0.5, false}, 4);
  room.shape(outer, Sphere{{0, 0, 0}, 1, true}, 4);
  const Solution s = run(room.scene(), room.mesh(), SolveMethod::kShooting, 2'000'000);
  constexpr double k = 0.25;
  const double b2_per_b1 = 0.7 * k / (1 - 0.7 * (1 - k));
  const double b1 = 1 / (1 - 0.5 * b2_per_b1);
  std::vector<test::Measured> measured;
  std::vector<test::Measured> expected;
  for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
    const Estimate e = s.irradiance(ZoneId(z), 0);
    measured.push_back({e.mean, e.stderr_of_mean});
    const bool is_inner = s.mesh.zone_surface(ZoneId(z)).index() == 0;
    expected.push_back({is_inner ? b2_per_b1 * b1 : k * b1 + (1 - k) * b2_per_b1 * b1, 0});
  }
  EXPECT_GT(test::agreement(measured, expected, static_cast<double>(s.sums.batches)), kFalseAlarm);
}

TEST(CurvedShapes, MeshedFromARoomTheirAreasAreExact) {
  const RoomBuilder room = curved_furnace(0.5);
  const MeshResult result = build_mesh(room.scene());
  double area = 0;
  for (std::size_t z = 0; z < result.mesh.zone_count(); ++z)
    if (result.mesh.zone_surface(ZoneId(z)).index() == 6) area += result.mesh.zone_area(ZoneId(z));
  EXPECT_NEAR(area, 2 * 4 * kPi * 0.36, 1e-9);  // both sides of the ball
  const Solution s = run(room.scene(), build_mesh(room.scene()), SolveMethod::kShooting, 1'000'000);
  EXPECT_GT(furnace_fit(s, 2.0), kFalseAlarm);
  EXPECT_EQ(s.audit.bands[0].total_escaped(), 0);
}

TEST(CurvedShapes, NarrowEmissionBooksItsPowerAndItsDirections) {
  // A disk with L ~ cos^e lights the point of the floor below it with E = L A / h^2 for small A; the share of
  // its power within the angle a is 1 - cos^(e+2) a.
  constexpr double kExponent = 6;
  RoomBuilder room;
  const MaterialId black = room.material("black", 0);
  const MaterialId lamp = room.material("lamp", 0, 1.0);
  room.scene().materials[lamp.index()].emission_exponent = kExponent;
  const double peak = (kExponent + 2) / (2 * kPi) * 5;
  room.scene().materials[lamp.index()].emitted_radiance = room.flat(peak);
  room.shape(black, Disk{{0, 0, 0}, {0, 0, 1}, 1, 0}, 1);  // seen from height 2 within atan(1/2)
  room.shape(lamp, Disk{{0, 0, 2}, {0, 0, -1}, 1e-3, 0}, 1);
  const Solution s = run(room.scene(), room.mesh(), SolveMethod::kShooting, 1'000'000);
  const double power = 5 * kPi * 1e-6;
  EXPECT_NEAR(
      (static_cast<double>(s.audit.bands[0].emitted) * s.audit.bands[0].watts_per_quantum / 32) / power, 1,
      1e-12);
  double caught = 0;
  double variance = 0;
  for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
    if (s.mesh.zone_surface(ZoneId(z)).index() != 0) continue;
    const Estimate e = s.irradiance(ZoneId(z), 0);
    caught += e.mean * s.mesh.zone_area(ZoneId(z));
    variance += std::pow(e.stderr_of_mean * s.mesh.zone_area(ZoneId(z)), 2);
  }
  const double share = 1 - std::pow(2 / std::sqrt(5.0), kExponent + 2);
  EXPECT_NEAR(caught / power, share, 5 * std::sqrt(variance) / power + 1e-6);  // 5 standard errors
  EXPECT_LT(std::sqrt(variance) / power, 0.002 * share);
}

}  // namespace
}  // namespace reemit

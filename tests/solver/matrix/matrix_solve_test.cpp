// Solutions of the matrix method against closed forms, references, and the Monte Carlo methods.
#include "solver/matrix/matrix_solve.h"

#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "scenes/model/error.h"
#include "solver/matrix/form_factors.h"
#include "solver/progressive_solver.h"
#include "tests/support/chi_square.h"
#include "tests/support/test_rooms.h"
#include "tests/support/zone_irradiances.h"

namespace reemit {
namespace {

using test::RoomBuilder;
using test::zone_irradiances;

Solution run(const RoomBuilder& room, SolveMethod method, std::uint64_t packets = 0, int threads = 2) {
  const std::atomic<bool> interrupt = false;
  SolverSettings settings;
  settings.method = method;
  settings.reemission = Reemission::kFromZones;  // the system that the matrix method solves
  settings.packets = packets;
  settings.batch_packets = packets / 32;
  settings.seed = 77;
  settings.threads = threads;
  return solve_zones(room.scene(), room.mesh(), settings, nullptr, interrupt);
}

/// Unit cube of twelve triangles; every face is split along the (0,0)-(1,1) diagonal of its axes (y,z), (x,z)
/// or (x,y), and the half with the larger first coordinate is `a`. The floor emits 1.
RoomBuilder twelve_triangles(double rho) {
  RoomBuilder room;
  const MaterialId plain = room.material("plain", rho);
  const MaterialId lamp = room.material("lamp", rho, 1.0);
  for (int axis = 0; axis < 3; ++axis)
    for (const double at : {0.0, 1.0}) {
      const auto p = [&](double u, double v) {
        Vec3 x;
        x[axis] = at;
        x[(axis == 0) ? 1 : 0] = u;
        x[(axis == 2) ? 1 : 2] = v;
        return x;
      };
      const MaterialId m = axis == 2 && at == 0 ? lamp : plain;
      const Vec3 inward = (at == 0 ? 1.0 : -1.0) * Vec3::Unit(axis);
      for (const bool first : {true, false}) {
        std::array<Vec3, 3> c = first ? std::array<Vec3, 3>{p(0, 0), p(1, 0), p(1, 1)}
                                      : std::array<Vec3, 3>{p(0, 0), p(1, 1), p(0, 1)};
        if ((c[1] - c[0]).cross(c[2] - c[0]).dot(inward) < 0) std::swap(c[1], c[2]);
        room.triangle(m, c, 1);
      }
    }
  return room;
}

TEST(MatrixSolve, TwelveTriangleCubeMatchesItsReference) {
  // Reference cases cubetri12.rho*: exact zonal system, factors by tanh-sinh quadrature of Lambert's formula.
  struct Case {
    double rho;
    std::array<double, 12> irradiance;  // x0a x0b x1a x1b y0a y0b y1a y1b z0a z0b z1a z1b
  };
  const std::array<Case, 4> cases{{
      {0.2,
       {0.3049757997272378, 0.172427039811743, 0.308423133753986, 0.175874373838492, 0.304975799727239,
        0.172427039811743, 0.30842313375399, 0.175874373838488, 0.0515242639180502, 0.0515242639180503,
        0.236775388950485, 0.236775388950485}},
      {0.5,
       {0.42469586209179067, 0.294654756986897, 0.432690318797615, 0.302649213692721, 0.424695862091793,
        0.294654756986896, 0.432690318797619, 0.302649213692717, 0.189812652921213, 0.189812652921213,
        0.355497195509752, 0.355497195509752}},
      {0.8,
       {0.9206754717548705, 0.791475999163211, 0.932726985597668, 0.803527513006009, 0.920675471754875,
        0.79147599916321, 0.932726985597674, 0.803527513006003, 0.701706705898928, 0.701706705898928,
        0.849887324579239, 0.849887324579239}},
      {0.99,
       {16.752031389650707, 16.6225372652455, 16.766505360846, 16.6370112364407, 16.7520313896508,
        16.6225372652454, 16.766505360846, 16.6370112364407, 16.5420199031066, 16.5420199031066,
        16.6798948446802, 16.6798948446802}},
  }};
  for (const Case& c : cases) {
    const Solution s = run(twelve_triangles(c.rho), SolveMethod::kMatrix);
    for (std::size_t z = 0; z < 12; ++z) {
      EXPECT_NEAR(s.irradiance(ZoneId(z), 0).mean, c.irradiance[z], 1e-8 * std::max(1.0, c.irradiance[z]))
          << "cubetri12.rho" << c.rho << " zone " << z;
      EXPECT_LT(s.irradiance(ZoneId(z), 0).stderr_of_mean, 1e-7 * c.irradiance[z]) << "nothing is sampled";
    }
  }
}

/// Coloured room with a two-sided screen and a block that cast shadows; closed, or open at the ceiling.
RoomBuilder room_with_screen(bool open, std::uint32_t divisions = 3) {
  RoomBuilder room(BandSet::rgb());
  const auto rgb = [](double r, double g, double b) { return Spectrum(Eigen::Array3d(r, g, b)); };
  const MaterialId lamp = room.material("lamp", rgb(0.2, 0.2, 0.2), rgb(10, 5, 1));
  const MaterialId red = room.material("red", rgb(0.8, 0.1, 0.05), rgb(0, 0, 0));
  const MaterialId white = room.material("white", rgb(0.75, 0.7, 0.65), rgb(0, 0, 0));
  const MaterialId screen = room.material("screen", rgb(0.5, 0.6, 0.7), rgb(0, 0, 0), true);
  room.box(Vec3::Zero(), Vec3(1, 1, 1), {red, white, lamp, white, white, open ? MaterialId() : white},
           divisions);
  room.quad(screen, {Vec3(0.2, 0.6, 0), Vec3(0.9, 0.5, 0), Vec3(0.9, 0.5, 0.6), Vec3(0.2, 0.6, 0.6)},
            divisions);
  return room;
}

TEST(MatrixSolve, ShootingAndWalkAgreeWithTheMatrixInAnOccludedRoom) {
  for (const bool open : {false, true}) {
    const RoomBuilder room = room_with_screen(open);
    const Solution reference = run(room, SolveMethod::kMatrix);
    ASSERT_GT(reference.form_factors->sampled_pairs, 100U);
    for (const SolveMethod method : {SolveMethod::kShooting, SolveMethod::kWalk}) {
      const Solution estimate = run(room, method, 1'600'000);
      auto measured = zone_irradiances(estimate);
      const auto matrix = zone_irradiances(reference);
      EXPECT_GT(test::agreement(measured, matrix, 16), test::kFalseAlarm) << to_string(method) << open;
      for (auto& m : measured) m.mean *= 1.02;
      EXPECT_LT(test::agreement(measured, matrix, 16), test::kFalseAlarm) << "a bias of 2 % went unseen";
    }
  }
}

TEST(MatrixSolve, StatedErrorsCoverWhatOtherRaysGive) {
  // Two independent sets of shadow rays. Errors may be stated too large: closure and stratification make the
  // factors better than their rays alone.
  const RoomBuilder room = room_with_screen(true);
  const auto first = zone_irradiances(run(room, SolveMethod::kMatrix));
  const std::atomic<bool> interrupt = false;
  SolverSettings settings;
  settings.method = SolveMethod::kMatrix;
  settings.seed = 78;
  auto second = zone_irradiances(solve_zones(room.scene(), room.mesh(), settings, nullptr, interrupt));
  EXPECT_GT(test::agreement(first, second, 16), test::kFalseAlarm);
  double differences = 0;
  double variances = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    differences += std::pow(first[i].mean - second[i].mean, 2);
    variances += std::pow(first[i].stderr_of_mean, 2) + std::pow(second[i].stderr_of_mean, 2);
  }
  EXPECT_GT(differences, 0.1 * variances) << "errors are stated far too large";
  for (auto& e : second) e.mean *= 1.02;
  EXPECT_LT(test::agreement(first, second, 16), test::kFalseAlarm) << "a bias of 2 % went unseen";
}

TEST(MatrixSolve, LightThroughANarrowGapArrives) {
  // A dark room behind a wall with a slit much narrower than a zone. First looks find most pairs hidden.
  RoomBuilder room;
  const MaterialId lamp = room.material("lamp", 0.5, 10.0);
  const MaterialId grey = room.material("grey", 0.5);
  const MaterialId wall = room.material("wall", 0.5, 0, true);
  room.box(Vec3::Zero(), Vec3(2, 1, 1), {lamp, grey, grey, grey, grey, grey}, 3);
  room.quad(wall, {Vec3(1, 0, 0), Vec3(1, 0.48, 0), Vec3(1, 0.48, 1), Vec3(1, 0, 1)}, 3);
  room.quad(wall, {Vec3(1, 0.52, 0), Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(1, 0.52, 1)}, 3);
  const Solution matrix = run(room, SolveMethod::kMatrix);
  const Solution shooting = run(room, SolveMethod::kShooting, 3'200'000);
  double matrix_power = 0;
  double shooting_power = 0;
  for (std::size_t z = 0; z < matrix.mesh.zone_count(); ++z) {
    if (matrix.mesh.zone_centroid(ZoneId(z)).x() < 1.01) continue;  // the far side of the dark room
    matrix_power += matrix.mesh.zone_area(ZoneId(z)) * matrix.irradiance(ZoneId(z), 0).mean;
    shooting_power += matrix.mesh.zone_area(ZoneId(z)) * shooting.irradiance(ZoneId(z), 0).mean;
  }
  // Zones of the box straddle the wall and carry light through it, the same for both methods.
  EXPECT_NEAR(matrix_power / shooting_power, 1, 0.01);
}

TEST(MatrixSolve, ConjugateGradientsSolveWhatEliminationSolves) {
  const RoomBuilder room = room_with_screen(false, 2);
  const Solution s = run(room, SolveMethod::kMatrix);
  const RayTracer rays(s.mesh);
  const std::atomic<bool> interrupt = false;
  const FormFactors f =
      compute_form_factors(s.mesh, rays, {.seed = 77, .enforce_closure = true}, nullptr, interrupt);
  const auto n = static_cast<Eigen::Index>(f.zones());
  for (std::size_t b = 0; b < 3; ++b) {
    Eigen::MatrixXd system = Eigen::MatrixXd::Identity(n, n);
    Eigen::VectorXd first_hit = Eigen::VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) {
        const ZoneId other(static_cast<std::size_t>(j));
        const double factor = f.factor(static_cast<std::size_t>(i), other.index());
        system(i, j) -= factor * s.zone_material(other).reflectance[static_cast<Eigen::Index>(b)];
        first_hit(i) += factor * s.emitted_radiosity(other, b);
      }
    const Eigen::VectorXd expected = system.partialPivLu().solve(first_hit);
    for (Eigen::Index i = 0; i < n; ++i) {
      const ZoneId zone(static_cast<std::size_t>(i));
      EXPECT_NEAR(s.irradiance(zone, b).mean, expected(i), 1e-11 * expected.maxCoeff());
      EXPECT_NEAR(s.direct_irradiance(zone, b).mean, first_hit(i), 1e-11 * expected.maxCoeff());
    }
  }
}

TEST(MatrixSolve, FurnaceWithABlockHasItsClosedForm) {
  RoomBuilder room;
  const MaterialId m = room.material("all", 0.9, 1.0, true);
  room.box(Vec3::Zero(), Vec3(3, 2, 1), {m, m, m, m, m, m}, 2);
  room.quad(m, {Vec3(1, 0.5, 0), Vec3(1, 0.5, 0.7), Vec3(1.5, 1.5, 0.7), Vec3(1.5, 1.5, 0)}, 2);
  for (Material& material : room.scene().materials) material.emits_both_sides = true;
  const Solution s = run(room, SolveMethod::kMatrix);
  // Enforced closure makes the furnace exact for all zones inside, whatever the sampled shares are.
  for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
    const double e = s.irradiance(ZoneId(z), 0).mean;
    if (e > 0) {
      EXPECT_NEAR(e, 10, 1e-8);
    }
  }
}

TEST(MatrixSolve, BooksBalanceAndEscapesGoWhereTheOpeningIs) {
  for (const bool open : {false, true}) {
    const Solution s = run(room_with_screen(open), SolveMethod::kMatrix);
    EXPECT_EQ(s.audit.batches, s.sums.batches);
    EXPECT_TRUE(s.audit.balanced());
    for (const BandAudit& b : s.audit.bands) {
      EXPECT_EQ(b.roulette_net, 0);
      EXPECT_EQ(b.emitted, s.audit.batches << 42);
      // Closed: roundings and the residual only. Open: rows off by sampling as well.
      EXPECT_LT(std::fabs(static_cast<double>(b.unshot)),
                (open ? 1e-3 : 1e-11) * static_cast<double>(b.emitted));
      EXPECT_EQ(b.total_escaped() > 0, open);
      if (open) {
        EXPECT_GT(b.escaped[4], b.escaped[0] + b.escaped[1] + b.escaped[2] + b.escaped[3]);
        EXPECT_EQ(b.escaped[5], 0);
      }
    }
  }
}

// A black cube of 1 m whose floor shines at a hole of 5 cm in the ceiling. Few zones have a leak ray that
// finds it, and what leaves is the form factor from the middle of the hole to the floor, over the area of the
// floor.
TEST(MatrixSolve, WhatLeavesThroughASmallOpeningIsBookedAsEscaped) {
  RoomBuilder room;
  const MaterialId black = room.material("black", 0);
  const MaterialId lamp = room.material("lamp", 0, 1);
  constexpr double kFrom = 0.475;
  constexpr double kTo = 0.525;
  const auto ceiling = [&](double x0, double x1, double y0, double y1) {
    room.quad(black, {Vec3(x0, y0, 1), Vec3(x0, y1, 1), Vec3(x1, y1, 1), Vec3(x1, y0, 1)}, 1);
  };
  ceiling(0, kFrom, 0, 1);
  ceiling(kTo, 1, 0, 1);
  ceiling(kFrom, kTo, 0, kFrom);
  ceiling(kFrom, kTo, kTo, 1);
  room.quad(lamp, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, 4);
  room.quad(black, {Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(1, 0, 0)}, 1);
  room.quad(black, {Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(0, 1, 1)}, 1);
  room.quad(black, {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(0, 1, 1), Vec3(0, 0, 1)}, 1);
  room.quad(black, {Vec3(1, 0, 0), Vec3(1, 0, 1), Vec3(1, 1, 1), Vec3(1, 1, 0)}, 1);
  const Solution s = run(room, SolveMethod::kMatrix);
  const BandAudit& books = s.audit.bands[0];
  const double slope = 0.5 / std::hypot(1, 0.5);  // from a point to a quarter of the floor (Howell, B-4)
  const double factor = 4 * (2 * slope * std::atan(slope)) / (2 * std::numbers::pi);
  const auto share = [&](RunQuanta quanta) {
    return static_cast<double>(quanta) / static_cast<double>(books.emitted);
  };
  EXPECT_NEAR(share(books.total_escaped()), factor * 0.05 * 0.05, 0.01 * factor * 0.05 * 0.05);
  EXPECT_LT(std::fabs(share(books.unshot)), 1e-6);
}

TEST(MatrixSolve, LightsWithoutAreaDeliverTheirPower) {
  RoomBuilder room;
  const MaterialId grey = room.material("grey", 0.5);
  room.box(Vec3(-1, -1, -1), Vec3(1, 1, 1), {grey, grey, grey, grey, grey, grey}, 2);
  room.scene().lights = {PointLight{"p", Vec3(0.2, 0.1, -0.3), room.flat(3)},
                         SpotLight{"s", Vec3::Zero(), Vec3(0, 0, -1), room.flat(2), 0.2, 0.5}};
  Solution s = run(room, SolveMethod::kMatrix);
  const double inner = std::cos(0.2);
  const double outer = std::cos(0.5);
  const double power = 12 * std::numbers::pi + 4 * std::numbers::pi * ((1 - inner) + (inner - outer) / 3);
  const BandAudit& band = s.audit.bands[0];
  EXPECT_NEAR(s.audit.watts(band, band.emitted), power, 1e-9);
  EXPECT_NEAR(s.audit.watts(band, band.total_absorbed()), power, 1e-8);
  const auto matrix = zone_irradiances(s);
  EXPECT_GT(test::agreement(zone_irradiances(run(room, SolveMethod::kShooting, 800'000)), matrix, 16),
            test::kFalseAlarm);

  PhotometricLight measured;
  measured.position = Vec3(-0.2, 0.3, 0.6);
  measured.table = std::make_shared<const IntensityTable>(PhotometricType::kC, std::vector<double>{0, 30, 90},
                                                          std::vector<double>{0, 90, 360},
                                                          std::vector<double>{5, 4, 0, 5, 8, 1, 5, 4, 0});
  measured.intensity_per_candela = room.flat(2);
  measured.opening.shape = LuminousOpening::Shape::kBox;
  measured.opening.length = 0.6;
  measured.opening.width = 0.3;
  room.scene().lights = {measured};
  s = run(room, SolveMethod::kMatrix);
  EXPECT_NEAR(s.audit.watts(s.audit.bands[0], s.audit.bands[0].emitted), 2 * measured.table->total_flux(),
              1e-9);
  EXPECT_GT(
      test::agreement(zone_irradiances(run(room, SolveMethod::kShooting, 800'000)), zone_irradiances(s), 16),
      test::kFalseAlarm);

  RoomBuilder slab;
  const MaterialId black = slab.material("black", 0.0);
  slab.quad(black, {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 2, 0), Vec3(0, 2, 0)}, 2);
  slab.scene().lights = {DirectionalLight{"d", Vec3(0, 0.6, -0.8), slab.flat(5)}};
  s = run(slab, SolveMethod::kMatrix);
  EXPECT_NEAR(s.audit.watts(s.audit.bands[0], s.audit.bands[0].absorbed[0]), 5 * 0.8 * 4, 1e-5);
  EXPECT_TRUE(s.audit.balanced());
  EXPECT_GT(s.audit.bands[0].total_escaped(), 0);
}

TEST(MatrixSolve, SameBitsOnAnyNumberOfThreads) {
  const RoomBuilder room = room_with_screen(true);
  const Solution one = run(room, SolveMethod::kMatrix, 0, 1);
  const Solution two = run(room, SolveMethod::kMatrix, 0, 2);
  EXPECT_EQ(one.sums.direct, two.sums.direct);
  EXPECT_EQ(one.sums.indirect, two.sums.indirect);
  EXPECT_EQ(one.sums.total_squared, two.sums.total_squared);
  EXPECT_EQ(one.sums.group_total, two.sums.group_total);
}

TEST(MatrixSolve, PerfectReflectorsThatLightCannotLeaveAreRefused) {
  RoomBuilder room;
  const MaterialId mirror = room.material("perfect", 1.0, 1.0);
  room.box(Vec3::Zero(), Vec3(1, 1, 1), {mirror, mirror, mirror, mirror, mirror, mirror}, 2);
  EXPECT_THROW(run(room, SolveMethod::kMatrix), InputError);
  // A grey object outside does not help the light inside.
  const MaterialId grey = room.material("grey", 0.5);
  room.quad(grey, {Vec3(3, 0, 0), Vec3(4, 0, 0), Vec3(4, 1, 0), Vec3(3, 1, 0)}, 1);
  EXPECT_THROW(run(room, SolveMethod::kMatrix), InputError);
}

TEST(MatrixSolve, DarkRoomIsBlack) {
  RoomBuilder room;
  const MaterialId m = room.material("all", 0.5);
  room.box(Vec3::Zero(), Vec3(1, 1, 1), {m, m, m, m, m, m}, 1);
  const Solution s = run(room, SolveMethod::kMatrix);
  EXPECT_EQ(s.record.stopped, StopReason::kNoLuminaire);
}

}  // namespace
}  // namespace reemit

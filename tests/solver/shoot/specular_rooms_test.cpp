// Packets over mirrors and glass against closed forms.

#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "solver/gather/direct_light.h"
#include "solver/gather/path_tracer.h"
#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "solver/solution/mean_light.h"
#include "tests/solver/shoot/methods.h"
#include "tests/support/chi_square.h"
#include "tests/support/mean_test.h"
#include "tests/support/specular_furnace.h"

namespace reemit {
namespace {

using test::kMethods;
using test::MeanTest;
using test::RoomBuilder;
using test::SpecularFurnace;

Spectrum one_band(double value) {
  return Spectrum::Constant(1, value);
}

Solution solved(const RoomBuilder& room, SolveMethod method, std::uint64_t packets, int threads = 2) {
  SolverSettings s;
  s.method = method;
  s.packets = packets;
  s.batch_packets = packets / 32;
  s.seed = 77;
  s.threads = threads;
  const std::atomic<bool> interrupt = false;
  return solve_zones(room.scene(), room.mesh(), s, nullptr, interrupt);
}

/// Area mean of the irradiance of one side of a surface, by the spread of the groups of batches; direct light
/// alone has no spread.
MeanTest mean_irradiance(const Solution& s, std::size_t surface, bool front = true) {
  MeanTest mean;
  for (std::size_t g = 0; g < ZoneSums::kGroups; ++g) {
    double sum = 0, area = 0;
    for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
      if (s.mesh.zone_surface(ZoneId(z)).index() != surface || s.mesh.zone_is_front(ZoneId(z)) != front)
        continue;
      area += s.mesh.zone_area(ZoneId(z));
      sum += s.mesh.zone_area(ZoneId(z)) *
             static_cast<double>(s.sums.group_total[g * s.sums.direct.size() + z * s.bands.count()]);
    }
    mean.add(sum / (area * static_cast<double>(s.sums.group_weight[g])));
  }
  return mean;
}

/// Is the mean within 5 standard errors of 16 groups (false alarms: 1 in 6,000 for each value tested; seeds
/// are fixed) of the truth?
::testing::AssertionResult is_at(const MeanTest& m, double truth) {
  const double limit = 5 * m.standard_error() + 1e-5 * truth;
  const auto text = ::testing::Message() << m.mean() << " +- " << m.standard_error() << ", truth " << truth;
  if (m.count() == ZoneSums::kGroups && std::fabs(m.mean() - truth) <= limit)
    return ::testing::AssertionSuccess() << text;
  return ::testing::AssertionFailure() << text;
}

void expect_closed_books(const Solution& s) {
  EXPECT_TRUE(s.audit.balanced());
  for (const BandAudit& band : s.audit.bands) {
    EXPECT_EQ(band.balance(), 0);
    EXPECT_EQ(band.total_escaped(), 0);
    for (const std::int64_t backs : band.absorbed_on_backs) EXPECT_EQ(backs, 0);
  }
}

/// A closed box whose side walls are perfect mirrors, so that floor and ceiling see each other as infinite
/// plates would.
RoomBuilder plates(const Material& floor, const Material& ceiling) {
  RoomBuilder room;
  const MaterialId mirror = room.material("mirror", 0);
  room.scene().materials[mirror.index()].non_diffuse.specular_reflectance = one_band(1);
  room.scene().materials.push_back(floor);
  room.scene().materials.push_back(ceiling);
  room.box(Vec3::Zero(), {1, 1.3, 0.7}, {mirror, mirror, mirror, mirror, MaterialId(1), MaterialId(2)}, 3);
  return room;
}
Material plate(double rho, double exitance) {
  Material m;
  m.reflectance = one_band(rho);
  m.emitted_radiance = one_band(exitance / std::numbers::pi);
  m.two_sided = false;
  return m;
}

constexpr std::size_t kFloor = 4, kCeiling = 5;

TEST(SpecularRooms, InfinitePlates) {
  // B1 = (E1 + rho1 E2) / (1 - rho1 rho2).
  for (const SolveMethod method : kMethods) {
    const Solution s = solved(plates(plate(0.5, 1), plate(0.4, 0)), method, 640'000);
    const double b1 = 1 / (1 - 0.2), b2 = 0.4 * b1;
    EXPECT_TRUE(is_at(mean_irradiance(s, kCeiling), b1));
    EXPECT_TRUE(is_at(mean_irradiance(s, kFloor), b2));
    EXPECT_FALSE(is_at(mean_irradiance(s, kFloor), 1.02 * b2)) << "a bias of 2 % went unseen";
    expect_closed_books(s);
  }
}

TEST(SpecularRooms, PaneBetweenPlates) {
  // Hemispherical transmittance of a clear pane, n = 1.5, by quadrature of Fresnel's equations.
  constexpr double kThrough = 0.850938300895591;
  RoomBuilder room = plates(plate(0, 1), plate(0, 0));
  const MaterialId glass = room.material("glass", 0, 0, true);
  NonDiffusePart& part = room.scene().materials[glass.index()].non_diffuse;
  part.angle_law = AngleLaw::kDielectric;
  part.index_of_refraction = 1.5;
  part.specular_transmittance = one_band(1);
  room.quad(glass, {Vec3(0, 0, 0.3), Vec3(1, 0, 0.3), Vec3(1, 1.3, 0.3), Vec3(0, 1.3, 0.3)}, 2);
  for (const SolveMethod method : kMethods) {
    const Solution s = solved(room, method, 640'000);
    EXPECT_TRUE(is_at(mean_irradiance(s, kCeiling), kThrough));
    EXPECT_TRUE(is_at(mean_irradiance(s, kFloor), 1 - kThrough));
    EXPECT_FALSE(is_at(mean_irradiance(s, kCeiling), 1.02 * kThrough)) << "a bias of 2 % went unseen";
    expect_closed_books(s);
  }
}

TEST(SpecularRooms, OpalSheetBetweenPlates) {
  // Irradiances t, b on the sheet and h1, h2 on the plates: h1 = r t + tau b, h2 = tau t + r b,
  // t = E1 + r1 h1, b = r2 h2; r = 0.35, tau = 0.55, r1 = 0.8, r2 = 0.3, E1 = 10.
  constexpr double kTop = 15.6523259881077, kBottom = 2.88562434417629;
  RoomBuilder room = plates(plate(0.3, 0), plate(0.8, 10));
  const MaterialId opal = room.material("opal", 0.35, 0, true);
  room.scene().materials[opal.index()].non_diffuse.diffuse_transmittance = one_band(0.55);
  room.quad(opal, {Vec3(0, 0, 0.3), Vec3(1, 0, 0.3), Vec3(1, 1.3, 0.3), Vec3(0, 1.3, 0.3)}, 2);
  constexpr std::size_t kSheet = 6;
  for (const SolveMethod method : kMethods) {
    const Solution s = solved(room, method, 640'000);
    EXPECT_TRUE(is_at(mean_irradiance(s, kCeiling), 7.06540748513466));
    EXPECT_TRUE(is_at(mean_irradiance(s, kFloor), 9.61874781392095));
    EXPECT_TRUE(is_at(mean_irradiance(s, kSheet, true), kTop));
    EXPECT_TRUE(is_at(mean_irradiance(s, kSheet, false), kBottom));
    EXPECT_FALSE(is_at(mean_irradiance(s, kSheet, false), 1.02 * kBottom)) << "a bias of 2 % went unseen";
    // Solutions hold what the sheet sends on from either side.
    double sent = 0, area = 0;
    for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
      if (s.mesh.zone_surface(ZoneId(z)).index() != kSheet || s.mesh.zone_is_front(ZoneId(z))) continue;
      sent += s.mesh.zone_area(ZoneId(z)) * s.radiosity(ZoneId(z), 0).mean;
      area += s.mesh.zone_area(ZoneId(z));
    }
    EXPECT_NEAR(sent / area, mean_irradiance(s, kFloor).mean(), 0.01 * sent / area);
    expect_closed_books(s);
  }
}

TEST(SpecularRooms, SheetsWhoseSidesReflectDifferently) {
  // As before, with r = 0.35 on the front, which the lit plate sees, and q = 0.1 on the back:
  // h1 = r t + tau b, h2 = tau t + q b, t = E1 + r1 h1, b = r2 h2.
  constexpr double kFront = 0.35, kBack = 0.1, kThrough = 0.55, kLit = 0.8, kOther = 0.3, kExitance = 10;
  const double back = kOther * kThrough / (1 - kOther * kBack);  // b / t
  const double top = kExitance / (1 - kLit * (kFront + kThrough * back));
  RoomBuilder room = plates(plate(kOther, 0), plate(kLit, kExitance));
  const MaterialId opal = room.material("opal", kFront, 0, true);
  Material& sheet = room.scene().materials[opal.index()];
  sheet.back_reflectance = one_band(kBack);
  sheet.non_diffuse.diffuse_transmittance = one_band(kThrough);
  room.quad(opal, {Vec3(0, 0, 0.3), Vec3(1, 0, 0.3), Vec3(1, 1.3, 0.3), Vec3(0, 1.3, 0.3)}, 2);
  constexpr std::size_t kSheet = 6;
  for (const SolveMethod method : kMethods) {
    const Solution s = solved(room, method, 640'000);
    EXPECT_TRUE(is_at(mean_irradiance(s, kSheet, true), top));
    EXPECT_TRUE(is_at(mean_irradiance(s, kSheet, false), back * top));
    EXPECT_TRUE(is_at(mean_irradiance(s, kCeiling), kFront * top + kThrough * back * top));
    EXPECT_TRUE(is_at(mean_irradiance(s, kFloor), kThrough * top + kBack * back * top));
    EXPECT_FALSE(is_at(mean_irradiance(s, kFloor), 1.02 * (kThrough + kBack * back) * top))
        << "a bias of 2 % went unseen";
    const RoomLight light = mean_light(s);
    for (const SideLight& side : light.sides) {
      if (side.surface.index() != kSheet) continue;
      const double sent =
          side.front ? kFront * top + kThrough * back * top : kThrough * top + kBack * back * top;
      EXPECT_NEAR(side.light.exitance[0].mean, sent, 5 * side.light.exitance[0].stderr_of_mean);
      EXPECT_LT(side.light.exitance[0].stderr_of_mean, 0.004 * sent);
    }
    expect_closed_books(s);
  }
}

TEST(SpecularRooms, GreyGlassTakesWhatBeerSays) {
  // A slab that nothing is reflected at (n = 1) between plates: exp(-a d / cos) over the hemisphere is
  // 2 E3(a d); E3(0.5) = 0.22160436.
  RoomBuilder room = plates(plate(0, 1), plate(0, 0));
  const MaterialId grey = room.material("grey", 0, 0, true);
  NonDiffusePart& part = room.scene().materials[grey.index()].non_diffuse;
  part.angle_law = AngleLaw::kDielectric;
  part.specular_transmittance = one_band(1);
  part.is_solid = true;
  part.absorption_per_m = one_band(5);
  // Upper and lower surface; the mirrors close it.
  room.quad(grey, {Vec3(0, 0, 0.4), Vec3(1, 0, 0.4), Vec3(1, 1.3, 0.4), Vec3(0, 1.3, 0.4)}, 1);
  room.quad(grey, {Vec3(0, 0, 0.3), Vec3(0, 1.3, 0.3), Vec3(1, 1.3, 0.3), Vec3(1, 0, 0.3)}, 1);
  for (const SolveMethod method : kMethods) {
    const Solution s = solved(room, method, 320'000);
    EXPECT_NEAR(mean_irradiance(s, kCeiling).mean(), 0.4433, 0.003);
    expect_closed_books(s);
  }
}

TEST(SpecularRooms, WhatABallOfGlassKeepsOfALampInsideIsUnshot) {
  // A ray that starts a from the middle at the angle t to the radius meets the ball at the sine a sin t / r,
  // every time again, and never gets out where n times that is above 1: the share sqrt(1 - (r / (n a))^2).
  constexpr double kRadius = 0.2, kFromMiddle = 0.16, kIndex = 1.5;
  RoomBuilder room;
  const MaterialId black = room.material("black", 0);
  room.box(Vec3::Zero(), {1, 1, 1}, {black, black, black, black, black, black}, 2);
  Material glass;
  glass.reflectance = one_band(0);
  glass.emitted_radiance = one_band(0);
  glass.two_sided = true;
  glass.non_diffuse.angle_law = AngleLaw::kDielectric;
  glass.non_diffuse.index_of_refraction = kIndex;
  glass.non_diffuse.specular_transmittance = one_band(1);
  glass.non_diffuse.is_solid = true;
  room.scene().materials.push_back(glass);
  const Vec3 middle(0.5, 0.5, 0.5);
  room.shape(MaterialId(room.scene().materials.size() - 1), Sphere{middle, kRadius}, 8);
  room.scene().lights = {PointLight{"bulb", middle + kFromMiddle * Vec3::UnitX(), room.flat(1)}};
  const double kept = std::sqrt(1 - std::pow(kRadius / (kIndex * kFromMiddle), 2));
  for (const SolveMethod method : kMethods) {
    const Solution s = solved(room, method, 4'000);
    EXPECT_NEAR(s.audit.worst_unshot_share(), kept, 0.03);
    EXPECT_TRUE(s.audit.balanced());
  }
}

TEST(SpecularRooms, LightOverMirrorsIsCausticThroughPanesDirectThroughOpalSheetsIndirect) {
  struct Parts {
    double direct = 0, caustic = 0, indirect = 0;
    double total() const { return direct + caustic + indirect; }
  };
  /// Light that the ceiling receives of the floor, per W/m2 of it.
  const auto parts_of = [](const RoomBuilder& room, SolveMethod method) {
    const Solution s = solved(room, method, 64'000);
    Parts parts;
    for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
      if (s.mesh.zone_surface(ZoneId(z)).index() != kCeiling || !s.mesh.zone_is_front(ZoneId(z))) continue;
      const auto weight = static_cast<double>(s.sums.weight()) * 1.3 / s.mesh.zone_area(ZoneId(z));
      parts.direct += s.sums.direct[z] / weight;
      parts.caustic += s.sums.caustic[z] / weight;
      parts.indirect += s.sums.indirect[z] / weight;
    }
    return parts;
  };
  for (const SolveMethod method : kMethods) {
    RoomBuilder room = plates(plate(0, 1), plate(0, 0));
    const Parts bare = parts_of(room, method);
    // F between 1 x 1.3 rectangles at 0.7: what comes over no mirror.
    EXPECT_NEAR(bare.direct / bare.total(), 0.345, 0.02);
    EXPECT_EQ(bare.indirect, 0);
    const MaterialId clear = room.material("clear", 0, 0, true);
    room.scene().materials[clear.index()].non_diffuse.specular_transmittance = one_band(0.5);
    room.quad(clear, {Vec3(0, 0, 0.3), Vec3(1, 0, 0.3), Vec3(1, 1.3, 0.3), Vec3(0, 1.3, 0.3)}, 2);
    const Parts dimmed = parts_of(room, method);
    EXPECT_NEAR(dimmed.direct / bare.direct, 0.5, 0.02) << "a pane leaves direct light direct";
    EXPECT_NEAR(dimmed.caustic / bare.caustic, 0.5, 0.02);
    EXPECT_EQ(dimmed.indirect, 0);
    NonDiffusePart opal;
    opal.diffuse_transmittance = one_band(0.5);
    room.scene().materials[clear.index()].non_diffuse = opal;
    const Parts veiled = parts_of(room, method);
    EXPECT_EQ(veiled.direct, 0);
    EXPECT_EQ(veiled.caustic, 0) << "mirrors beyond an opal sheet throw no caustics";
    EXPECT_NEAR(veiled.indirect, 0.5, 0.02);
  }
}

TEST(SpecularRooms, FurnaceOfMirrorsAndGlass) {
  const SpecularFurnace furnace;
  for (const SolveMethod method : kMethods) {
    const Solution s = solved(furnace.room(), method, 640'000);
    for (std::size_t k = 0; k < 8; ++k)
      EXPECT_TRUE(is_at(mean_irradiance(s, k), SpecularFurnace::kIrradiance)) << "surface " << k;
    for (std::size_t k = 0; k < 6; ++k)
      EXPECT_FALSE(is_at(mean_irradiance(s, k), 1.02 * SpecularFurnace::kIrradiance)) << "surface " << k;
    expect_closed_books(s);
  }
}

TEST(SpecularRooms, GlossyWallsSendPacketsWherePathsFindThem) {
  RoomBuilder room = plates(plate(0, 1), plate(0.3, 0));
  NonDiffusePart& walls = room.scene().materials[0].non_diffuse;
  walls.specular_reflectance = one_band(0.8);
  walls.roughness = 0.3;
  room.scene().materials[2].non_diffuse.specular_reflectance = one_band(0.5);
  room.scene().materials[2].non_diffuse.roughness = 0.5;
  for (const GlossLobe lobe : {GlossLobe::kGgx, GlossLobe::kWard, GlossLobe::kPhong}) {
    for (Material& m : room.scene().materials) m.non_diffuse.lobe = lobe;
    const ZoneMesh mesh = room.mesh().mesh;
    const Room space(room.scene(), mesh);
    const DirectLight direct(space);
    const PathTracer tracer(space, direct, 5);
    const CounterRng rng(8, RngPurpose::kPath);
    // Ceiling points; each group of 1,024 is one estimate.
    MeanTest paths;
    for (std::uint32_t g = 0; g < 32; ++g) {
      float sum = 0;
      for (std::uint32_t i = 0; i < 1024; ++i) {
        const auto u = rng.uniform4(i, g, 0);
        const auto place = rng.uniform4(i, g, 1);
        std::vector<TriangleId> ceiling;
        for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
          if (mesh.triangle(TriangleId(t)).surface.index() == kCeiling) ceiling.push_back(TriangleId(t));
        const float root = std::sqrt(place[1]);
        const SurfacePoint x =
            surface_point(space.rays(), ceiling[static_cast<std::size_t>(place[0] * ceiling.size())],
                          1 - root, place[2] * root, true);
        float one = 1.0F / 1024;
        direct.add_sample(x, {u[0], u[1], u[2]}, &one, &sum);
        float weight = std::numbers::pi_v<float> * one;
        tracer.add_indirect(x, place[3], u[3], {i, g, 0, 0}, &weight, &sum);
      }
      paths.add(static_cast<double>(sum));
    }
    for (const SolveMethod method : kMethods) {
      const Solution s = solved(room, method, 320'000);
      const MeanTest packets = mean_irradiance(s, kCeiling);
      const double error = std::hypot(packets.standard_error(), paths.standard_error());
      EXPECT_NEAR(packets.mean(), paths.mean(), 5 * error) << "lobe " << static_cast<int>(lobe);
      EXPECT_LT(5 * error, 0.02 * paths.mean()) << "a bias of 2 % would go unseen";
      expect_closed_books(s);
    }
  }
}

TEST(SpecularRooms, SameBitsOnAnyNumberOfThreads) {
  const SpecularFurnace furnace;
  for (const SolveMethod method : kMethods) {
    const Solution one = solved(furnace.room(), method, 64'000, 1);
    const Solution two = solved(furnace.room(), method, 64'000, 2);
    EXPECT_EQ(one.sums.direct, two.sums.direct);
    EXPECT_EQ(one.sums.indirect, two.sums.indirect);
    EXPECT_EQ(one.sums.group_total, two.sums.group_total);
    EXPECT_EQ(one.audit.bands[0].absorbed, two.audit.bands[0].absorbed);
  }
}

TEST(SpecularRooms, ShadowRaysCrossPanesWithTheirTransmittance) {
  const auto lit_through = [](double clear, bool is_solid, int panes) {
    RoomBuilder room;
    const MaterialId floor = room.material("floor", 0.5);
    const MaterialId lamp = room.material("lamp", 0, 10);
    const MaterialId pane = room.material("pane", 0, 0, true);
    NonDiffusePart& part = room.scene().materials[pane.index()].non_diffuse;
    part.specular_transmittance = one_band(clear);
    part.is_solid = is_solid;
    room.quad(floor, {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)}, 1);
    room.quad(lamp, {Vec3(-.2, -.2, 2), Vec3(-.2, .2, 2), Vec3(.2, .2, 2), Vec3(.2, -.2, 2)}, 1);
    for (int k = 0; k < panes; ++k) {
      const double z = 0.5 + 0.3 * k;
      room.quad(pane, {Vec3(-1, -1, z), Vec3(1, -1, z), Vec3(1, 1, z), Vec3(-1, 1, z)}, 1);
    }
    const ZoneMesh mesh = room.mesh().mesh;
    const Room walls(room.scene(), mesh);
    const DirectLight direct(walls);
    double sum = 0;
    direct.add_samples(surface_point(walls.rays(), TriangleId(0), 0.3F, 0.3F, true), SobolSequence(5), 0, 64,
                       &sum);
    return sum / 64;
  };
  const double open = lit_through(0.8, false, 0);
  EXPECT_GT(open, 0);
  EXPECT_NEAR(lit_through(0.8, false, 1), 0.8 * open, 1e-5 * open);
  EXPECT_NEAR(lit_through(0.8, false, 3), 0.512 * open, 1e-5 * open);
  EXPECT_EQ(lit_through(0.8, true, 1), 0) << "glass that bends light casts a shadow";
  EXPECT_EQ(lit_through(0, false, 1), 0);
}

}  // namespace
}  // namespace reemit

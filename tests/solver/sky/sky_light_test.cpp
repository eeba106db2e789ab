// Skies as packets, shadow rays and rays that leave the room meet them, in rooms.
#include "solver/sky/sky_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/gather/direct_audit.h"
#include "solver/gather/direct_light.h"
#include "solver/gather/gather_batch.h"
#include "solver/gather/hemisphere_gather.h"
#include "solver/gather/path_tracer.h"
#include "solver/gather/radiance_field.h"
#include "solver/progressive_solver.h"
#include "solver/sampling/sobol.h"
#include "tests/solver/floor_point.h"
#include "tests/support/mean_test.h"
#include "tests/support/never.h"
#include "tests/support/skies.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::cie_sky_over_z;
using test::floor_point;
using test::kNever;
using test::MeanTest;
using test::RoomBuilder;
using test::sky_over_z;

MeanTest direct_irradiance(const Room& room, const SurfacePoint& x, int samples = 256) {
  const DirectLight direct(room);
  MeanTest result;
  for (std::uint64_t replicate = 0; replicate < 32; ++replicate) {
    std::vector<double> sum(room.band_count(), 0.0);
    direct.add_samples(x, SobolSequence(300 + replicate), 0, samples, sum.data());
    result.add(sum[0] / samples);
  }
  return result;
}

/// A level square, facing up.
RoomBuilder plane_outside(const Sky& sky) {
  RoomBuilder room;
  room.quad(room.material("plane", 0.5), {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)}, 2);
  room.scene().sky = sky;
  return room;
}

/// Inside 4 x 6 x 3 m, with an opening of 2 x 1.2 m in the wall y = 0 from 0.9 m up. Walls reflect on both
/// sides.
constexpr double kLeft = 1, kRight = 3, kSill = 0.9, kHead = 2.1;
RoomBuilder room_with_window(const Sky& sky, double reflectance = 0.5) {
  RoomBuilder room;
  const MaterialId m = room.material("wall", reflectance, 0, true);
  room.box({0, 0, 0}, {4, 6, 3}, {m, m, MaterialId(), m, m, m}, 4);
  const auto piece = [&](double x0, double x1, double z0, double z1) {
    room.quad(m, {Vec3(x0, 0, z0), Vec3(x0, 0, z1), Vec3(x1, 0, z1), Vec3(x1, 0, z0)}, 3);
  };
  piece(0, kLeft, 0, 3);
  piece(kRight, 4, 0, 3);
  piece(kLeft, kRight, 0, kSill);
  piece(kLeft, kRight, kHead, 3);
  room.scene().sky = sky;
  return room;
}

/// Of an overcast sky that sends 1 W/m2 to a level plane.
double overcast_radiance(const Vec3& towards) {
  return 9 / (7 * pi) * (1 + 2 * towards.z()) / 3;
}

/// Of a point, through the opening, by midpoints over it. No light comes from below the horizon.
template <class Radiance>
double through_window(const Vec3& x, Radiance&& radiance, const Vec3& normal = Vec3::UnitZ()) {
  constexpr int kSteps = 400;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const Vec3 at(kLeft + (i + 0.5) / kSteps * (kRight - kLeft), 0,
                    kSill + (j + 0.5) / kSteps * (kHead - kSill));
      const Vec3 way = at - x;
      const double r = way.norm();
      if (way.z() > 0 && way.dot(normal) > 0)
        sum += radiance(Vec3(way / r)) * (way.dot(normal) / r) * (-way.y() / r) / (r * r);
    }
  return sum * (kRight - kLeft) * (kHead - kSill) / (kSteps * kSteps);
}

TEST(SkyLight, a_plane_outside_gets_what_the_sky_is_said_to_send) {
  std::vector<Sky> skies{sky_over_z(SkyKind::kUniform, 50), sky_over_z(SkyKind::kOvercast, 50)};
  for (const int type : {1, 5, 8, 12, 15}) skies.push_back(cie_sky_over_z(type, 50));
  for (const Sky& sky : skies) {
    const RoomBuilder builder = plane_outside(sky);
    const ZoneMesh mesh = builder.mesh().mesh;
    const Room room(builder.scene(), mesh);
    const MeanTest e =
        direct_irradiance(room, surface_point(room.rays(), TriangleId(0), 0.3F, 0.3F, true), 1024);
    EXPECT_TRUE(e.agrees_with(50)) << sky.description << sky.gradation.a;
    EXPECT_TRUE(e.would_notice(0.02, 50));
  }
}

TEST(SkyLight, a_plane_outside_gets_the_sun_and_the_ground) {
  Sky sky = cie_sky_over_z(12, 50);
  sky.sun->irradiance = Spectrum::Constant(1, 200.0);
  sky.ground_reflectance.setConstant(0.3);
  const double outside = 50 + 200 * std::sin(0.7);
  const RoomBuilder builder = plane_outside(sky);
  const ZoneMesh mesh = builder.mesh().mesh;
  const Room room(builder.scene(), mesh);
  const MeanTest up =
      direct_irradiance(room, surface_point(room.rays(), TriangleId(0), 0.3F, 0.3F, true), 1024);
  EXPECT_TRUE(up.agrees_with(outside));
  EXPECT_TRUE(up.would_notice(0.02, outside));
  const MeanTest down =
      direct_irradiance(room, surface_point(room.rays(), TriangleId(0), 0.3F, 0.3F, false), 1024);
  EXPECT_TRUE(down.agrees_with(0.3 * outside)) << "from below, all of it ground";
}

TEST(SkyLight, packets_fill_a_plane_outside_and_the_books_balance) {
  for (const SolveMethod method : {SolveMethod::kShooting, SolveMethod::kWalk}) {
    Sky sky = cie_sky_over_z(12, 50);
    sky.sun->irradiance = Spectrum::Constant(1, 200.0);
    const double outside = 50 + 200 * std::sin(0.7);
    const RoomBuilder room = plane_outside(sky);
    SolverSettings settings;
    settings.packets = 400'000;
    settings.method = method;
    const Solution solution = solve_zones(room.scene(), room.mesh(), settings, {}, kNever);
    EXPECT_TRUE(solution.audit.balanced());
    double power = 0;
    double error2 = 0;
    for (std::size_t z = 0; z < solution.mesh.zone_count(); ++z) {
      const Estimate e = solution.irradiance(ZoneId(z), 0);
      power += e.mean * solution.mesh.zone_area(ZoneId(z));
      error2 += std::pow(e.stderr_of_mean * solution.mesh.zone_area(ZoneId(z)), 2);
    }
    // Zones share packets, so errors of zones add up to no more than their sum in the worst case; they are
    // independent enough for five of them.
    EXPECT_NEAR(power, 4 * outside, 5 * std::sqrt(error2) + 1e-4 * power);
    EXPECT_LT(5 * std::sqrt(error2), 0.01 * power) << "would notice 2 %";
  }
}

TEST(SkyLight, points_deep_inside_see_the_sky_through_the_window) {
  const Sky clear = cie_sky_over_z(12, 1);
  const auto relative = [&](const Vec3& d) {
    const double to_sun = std::acos(std::clamp(d.dot(clear.towards_sun()), -1.0, 1.0));
    return clear.gradation.relative_luminance(d.z(), to_sun);
  };
  double level = 0;  // irradiance of a level plane, by midpoints of half a degree
  constexpr int kSteps = 180;
  const double step = 0.5 * pi / kSteps;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < 4 * kSteps; ++j) {
      const double altitude = (i + 0.5) * step;
      level += relative(clear.towards(altitude, (j + 0.5) * step)) * std::sin(altitude) * std::cos(altitude) *
               step * step;
    }
  const auto by_formula = [&](const Vec3& d) { return relative(d) / level; };
  for (const bool is_clear : {false, true}) {
    const RoomBuilder builder = room_with_window(is_clear ? clear : sky_over_z(SkyKind::kOvercast, 1));
    const ZoneMesh mesh = builder.mesh().mesh;
    const Room room(builder.scene(), mesh);
    for (const double depth : {0.5, 1.5, 3.0, 5.5}) {
      const Vec3 x(1.7, depth, 0);
      const double expected = is_clear ? through_window(x, by_formula) : through_window(x, overcast_radiance);
      const MeanTest e = direct_irradiance(room, floor_point(room, x.x(), x.y()), 8192);
      // Cells of the sky are one degree high, and the quadrature has steps of half of one.
      EXPECT_NEAR(e.mean(), expected, 5 * e.standard_error() + 1e-3 * expected) << depth;
      EXPECT_TRUE(e.would_notice(0.02, expected)) << depth;
    }
  }
}

TEST(SkyLight, survey_makes_shadow_rays_through_the_window_quiet) {
  // With directions by brightness alone, 256 shadow rays to the far end have a standard error of over 20 %.
  const RoomBuilder builder = room_with_window(sky_over_z(SkyKind::kOvercast, 1));
  const ZoneMesh mesh = builder.mesh().mesh;
  const Room room(builder.scene(), mesh);
  const MeanTest e = direct_irradiance(room, floor_point(room, 2, 5.5), 256);
  EXPECT_LT(e.standard_error() * std::sqrt(32.0), 0.1 * e.mean());
}

// No surface is there that rays of the survey could have started from. What they meet is told by the opening
// itself. 16 shadow rays of a replicate by brightness alone would often miss it altogether.
TEST(SkyLight, shadow_rays_from_the_air_find_the_window) {
  const RoomBuilder builder = room_with_window(sky_over_z(SkyKind::kOvercast, 1));
  const ZoneMesh mesh = builder.mesh().mesh;
  const Room room(builder.scene(), mesh);
  const auto passes_window = [](const Vec3& x, const Vec3& towards) {
    if (!(towards.y() < 0)) return false;
    const Vec3 at = x - x.y() / towards.y() * towards;
    return at.x() > kLeft && at.x() < kRight && at.z() > kSill && at.z() < kHead;
  };
  for (const Vec3& x : {Vec3(1.7, 2.5, 0.85), Vec3(0.4, 4, 0.85), Vec3(3.1, 5.4, 1.2)})
    for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0, -1, 0), Vec3(0.6, 0, 0.8)}) {
      MeanTest e;
      const Vec3f from = room.rays().normalised(x);
      for (std::uint64_t replicate = 0; replicate < 32; ++replicate) {
        const SobolSequence points(500 + replicate);
        constexpr int kRays = 256;
        double sum = 0;
        for (std::uint32_t i = 0; i < kRays; ++i) {
          const std::array<float, 2> u{points.sample(i, 0), points.sample(i, 1)};
          const SkyLight::Sample sample = room.sky()->sample_sky(from, normal.cast<float>(), u[0], u[1]);
          if (passes_window(x, sample.towards.cast<double>())) sum += static_cast<double>(sample.factor);
        }
        e.add(sum / kRays * room.sky()->sky_strength()[0]);
      }
      const double expected = through_window(x, overcast_radiance, normal);
      EXPECT_NEAR(e.mean(), expected, 5 * e.standard_error() + 2e-3 * expected) << x.transpose();
      EXPECT_LT(e.standard_error() * std::sqrt(32.0), 0.3 * expected) << x.transpose();
    }
}

// Few rays of the survey start from what is small. The errors of replicates without a hit would be 0.
TEST(SkyLight, shadow_rays_from_a_thin_leg_find_the_window) {
  RoomBuilder builder = room_with_window(sky_over_z(SkyKind::kOvercast, 1));
  const auto leg = static_cast<std::uint32_t>(builder.scene().surfaces.size());
  builder.quad(builder.material("leg", 0.3),
               {Vec3(2.03, 4.6, 0), Vec3(2.04, 4.6, 0), Vec3(2.04, 4.6, 0.02), Vec3(2.03, 4.6, 0.02)}, 1);
  const ZoneMesh mesh = builder.mesh().mesh;
  const Room room(builder.scene(), mesh);
  for (std::size_t t = 0; t < mesh.flat_count(); ++t) {
    if (mesh.triangle(TriangleId(t)).surface != SurfaceId(leg)) continue;
    const SurfacePoint x = surface_point(room.rays(), TriangleId(t), 0.3F, 0.3F, true);
    ASSERT_LT(x.normal.y(), -0.99F);
    const MeanTest e = direct_irradiance(room, x, 256);
    const Vec3 at(2.035, 4.6, 0.01);
    const double expected = through_window(at, overcast_radiance, Vec3(0, -1, 0));
    EXPECT_NEAR(e.mean(), expected, 5 * e.standard_error() + 0.01 * expected);
    EXPECT_LT(e.standard_error() * std::sqrt(32.0), 0.25 * expected);
  }
}

TEST(SkyLight, packets_and_shadow_rays_find_the_same_light_inside) {
  const RoomBuilder room = room_with_window(cie_sky_over_z(12, 100));
  SolverSettings settings;
  settings.packets = 5'000'000;
  settings.direct = DirectSource::kPackets;
  Solution solution = solve_zones(room.scene(), room.mesh(), settings, {}, kNever);
  EXPECT_TRUE(solution.audit.balanced());
  const Room walls(room.scene(), solution.mesh);
  const DirectAudit audit = audit_direct_light(walls, solution, {}, {}, kNever);
  EXPECT_GT(audit.compared, 100U);
  EXPECT_TRUE(audit.agrees()) << audit.different.size() << " zones differ";
  for (double& direct : solution.sums.direct) direct *= 1.02;
  EXPECT_FALSE(audit_direct_light(walls, solution, {}, {}, kNever).agrees()) << "2 % too much";
}

TEST(SkyLight, zones_inside_agree_between_methods) {
  // Walks know nothing of which zones need packets; shooting does.
  const RoomBuilder room = room_with_window(sky_over_z(SkyKind::kOvercast, 100), 0.7);
  std::vector<Solution> solutions;
  for (const SolveMethod method : {SolveMethod::kShooting, SolveMethod::kWalk}) {
    SolverSettings settings;
    settings.packets = 1'000'000;
    settings.method = method;
    solutions.push_back(solve_zones(room.scene(), room.mesh(), settings, {}, kNever));
    EXPECT_TRUE(solutions.back().audit.balanced());
  }
  double chi2 = 0;
  double zones = 0;
  const ZoneMesh& mesh = solutions[0].mesh;
  for (std::size_t z = 0; z < mesh.zone_count(); ++z) {
    const Estimate a = solutions[0].irradiance(ZoneId(z), 0);
    const Estimate b = solutions[1].irradiance(ZoneId(z), 0);
    const double error2 = a.stderr_of_mean * a.stderr_of_mean + b.stderr_of_mean * b.stderr_of_mean;
    if (!(error2 > 0)) continue;
    chi2 += (a.mean - b.mean) * (a.mean - b.mean) / error2;
    ++zones;
  }
  // Batches are few, so errors of zones are themselves uncertain: chi^2 per zone of up to 1.5 is no surprise.
  EXPECT_GT(zones, 100);
  EXPECT_LT(chi2 / zones, 1.5);
}

TEST(SkyLight, a_closed_room_stays_exactly_dark) {
  RoomBuilder room;
  const MaterialId m = room.material("wall", 0.8, 0, true);
  room.box({0, 0, 0}, {4, 6, 3}, {m, m, m, m, m, m}, 3);
  Sky sky = cie_sky_over_z(12, 100);
  sky.sun->irradiance = Spectrum::Constant(1, 500.0);
  sky.ground_reflectance.setConstant(0.3);
  room.scene().sky = sky;
  SolverSettings settings;
  settings.packets = 300'000;
  const Solution solution = solve_zones(room.scene(), room.mesh(), settings, {}, kNever);
  EXPECT_TRUE(solution.audit.balanced());
  for (std::size_t z = 0; z < solution.mesh.zone_count(); ++z) {
    const bool inside = solution.mesh.zone_is_front(ZoneId(z));
    const double e = solution.irradiance(ZoneId(z), 0).mean;
    if (inside)
      EXPECT_EQ(e, 0) << z;
    else
      EXPECT_GT(e, 0) << z;
  }
  const Room walls(room.scene(), solution.mesh);
  EXPECT_EQ(direct_irradiance(walls, floor_point(walls, 2, 3)).mean(), 0);
}

/// Indirect irradiance of the first band by the gather and by paths, with rays that leave the room.
TEST(SkyLight, gathers_agree_with_paths_inside) {
  const RoomBuilder builder = room_with_window(sky_over_z(SkyKind::kOvercast, 100), 0.6);
  SolverSettings settings;
  settings.packets = 2'000'000;
  const Solution solution = solve_zones(builder.scene(), builder.mesh(), settings, {}, kNever);
  const Room room(builder.scene(), solution.mesh);
  const DirectLight direct(room);
  const RadianceField field(room, solution);
  GatherSettings gather_settings;
  gather_settings.close_hit = 1e3;  // zones of this room are large: as good as never read
  gather_settings.most_bounces = 24;
  const HemisphereGather gather(field, direct, gather_settings);
  const PathTracer paths(room, direct, 5);
  const SurfacePoint x = floor_point(room, 2, 4);
  MeanTest gathered;
  MeanTest traced;
  constexpr std::uint32_t kRays = 512;
  for (std::uint32_t replicate = 0; replicate < 32; ++replicate) {
    const SobolSequence numbers(20 + replicate);
    GatherBatch batch(gather);
    float sum = 0;
    float path_sum = 0;
    const float weight = 1.0F / kRays;
    for (std::uint32_t i = 0; i < kRays; ++i) {
      batch.add(x, numbers.sample(i, 0), numbers.sample(i, 1), {replicate, 0, i, 0}, &weight, &sum);
      float path_weight = weight;
      paths.add_indirect(x, numbers.sample(i, 0), numbers.sample(i, 1), {replicate, 0, i, 0}, &path_weight,
                         &path_sum);
    }
    batch.flush();
    gathered.add(static_cast<double>(sum));
    traced.add(static_cast<double>(path_sum));
  }
  EXPECT_TRUE(agree(gathered, traced));
  EXPECT_TRUE(traced.would_notice(0.2, traced.mean()));
}

TEST(SkyLight, cells_of_packets_share_all_of_the_light) {
  Sky sky = cie_sky_over_z(12, 100);
  sky.sun->irradiance = Spectrum::Constant(1, 500.0);
  const RoomBuilder builder = room_with_window(sky);
  const ZoneMesh mesh = builder.mesh().mesh;
  const Room room(builder.scene(), mesh);
  const SkyLight& light = *room.sky();
  double packets = 0;
  double power = 0;
  for (std::size_t c = 0; c < light.cell_count(); ++c) {
    packets += light.packet_share(c);
    power += light.power(c).sum();
    EXPECT_GT(light.packet_share(c), 0);
  }
  EXPECT_NEAR(packets, 1, 1e-9);
  EXPECT_GT(light.cell_count(), 100U);
  // Through the top of the box alone: 24 m2 of level plane under sky; all sides and the beam come on top.
  EXPECT_GT(power, 24 * 100);
  EXPECT_GT(light.mean_need(), 1);
}

}  // namespace
}  // namespace reemit

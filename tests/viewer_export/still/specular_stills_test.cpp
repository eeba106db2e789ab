// What cameras see of mirrors and glass.

#include <atomic>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "tests/support/hand_made_solution.h"
#include "tests/support/mean_test.h"
#include "tests/support/never.h"
#include "tests/support/specular_furnace.h"
#include "tests/support/variable_furnace.h"
#include "viewer_export/points/measured_light.h"
#include "viewer_export/still/render_still.h"
#include "viewer_export/vertex/vertex_radiance.h"

namespace reemit {
namespace {

using test::MeanTest;
using test::RoomBuilder;
using test::SpecularFurnace;

TEST(SpecularStills, FurnaceIsEvenlyBright) {
  const SpecularFurnace furnace;
  // Zones are right by construction, so only rays are tested.
  const Solution solution = test::uniform_solution(furnace.room(), 0, SpecularFurnace::kIrradiance);
  const Room walls(furnace.room().scene(), solution.mesh);
  for (const Integrator integrator : {Integrator::kZones, Integrator::kGather, Integrator::kPath}) {
    StillSettings settings;
    settings.width = 32;
    settings.height = 24;
    settings.integrator = integrator;
    settings.spp = 16;
    settings.threads = 2;
    const std::atomic<bool> interrupt{false};
    const StillImage image =
        render_still(walls, solution, test::VariableFurnace::camera(), settings, {}, interrupt);
    // Rows are independent estimates of the one radiance that there is.
    MeanTest mean;
    for (std::size_t half = 0; half < 48; ++half) {
      double sum = 0;
      for (std::size_t p = 0; p < 16; ++p) {
        const std::size_t pixel = half * 16 + p;
        sum += static_cast<double>(image.radiance[pixel]) / 16;
      }
      mean.add(sum);
    }
    const double truth = SpecularFurnace::kIrradiance / std::numbers::pi;
    EXPECT_TRUE(mean.agrees_with(truth)) << to_string(integrator);
    EXPECT_TRUE(mean.would_notice(0.05, truth)) << to_string(integrator);
  }
}

/// A lamp of radiance 1 above the eye, and what the eye looks down at: `below`, then a floor that reflects so
/// much; or, if the lamp is `under`, the lamp in place of the floor.
StillImage look_down(const NonDiffusePart& below, Integrator integrator, bool under = false, int spp = 16,
                     double of_floor = 0) {
  RoomBuilder room;
  const MaterialId lamp = room.material("lamp", 0, std::numbers::pi);
  const MaterialId black = room.material("floor", of_floor);
  const MaterialId seen = room.material("seen", 0, 0, true);
  room.scene().materials[seen.index()].non_diffuse = below;
  const auto level = [&](MaterialId m, double z, bool down) {
    const Vec3 a(-9, -9, z), b(9, -9, z), c(9, 9, z), d(-9, 9, z);
    room.quad(m, down ? std::array{a, d, c, b} : std::array{a, b, c, d}, 1);
  };
  level(under ? black : lamp, 2, true);
  level(seen, 0, false);
  level(under ? lamp : black, -1, false);
  const Solution solution = test::dark_solution(room);
  const Room walls(room.scene(), solution.mesh);
  Camera camera;
  camera.eye = {0, 0, 1};
  camera.look_at = {0, 0, 0};
  camera.up = {0, 1, 0};
  camera.vertical_fov_deg = 4;
  StillSettings settings;
  settings.width = settings.height = 8;
  settings.integrator = integrator;
  settings.spp = spp;
  const std::atomic<bool> interrupt{false};
  return render_still(walls, solution, camera, settings, {}, interrupt);
}

// Smoothing divides by it: patterns behind a pane would be taken for noise.
TEST(SpecularStills, ReflectanceOfWhatIsSeenIsThatBehindPanes) {
  NonDiffusePart sheet;
  sheet.specular_transmittance = Spectrum::Constant(1, 0.8);
  const StillImage through = look_down(sheet, Integrator::kGather, false, 16, 0.5);
  for (const float albedo : through.albedo) EXPECT_NEAR(albedo, 0.8 * 0.5, 1e-5);
}

/// A black room of 4 m with a spot that a mirror throws onto a square of 0.6 m, as if from 5.1 m away.
class SpotOverMirror {
 public:
  static constexpr double kIntensity = 50;  // [W/sr]
  static constexpr double kMirror = 0.9;
  static constexpr double kDistance = 5.1;  // from the image of the spot

  explicit SpotOverMirror(const std::function<MaterialId(RoomBuilder&)>& square_of) {
    const MaterialId black = room.material("black", 0);
    room.box(Vec3(0, -2, -2), Vec3(4, 2, 2), {black, black, black, black, black, black}, 1);
    const MaterialId mirror = room.material("mirror", 0, 0, true);
    room.scene().materials[mirror.index()].non_diffuse.specular_reflectance = Spectrum::Constant(1, kMirror);
    room.quad(mirror, {Vec3(0.1, -1, -1), Vec3(0.1, 1, -1), Vec3(0.1, 1, 1), Vec3(0.1, -1, 1)}, 1);
    room.quad(square_of(room),
              {Vec3(3.8, -0.3, -0.3), Vec3(3.8, -0.3, 0.3), Vec3(3.8, 0.3, 0.3), Vec3(3.8, 0.3, -0.3)}, 1);
    SpotLight spot{"spot", Vec3(1.5, 0, 0), Vec3(-1, 0, 0), Spectrum::Constant(1, kIntensity), 0.2, 0.25};
    room.scene().lights.push_back(spot);
    SolverSettings settings;
    settings.packets = 1'000'000;
    solution = solve_zones(room.scene(), room.mesh(), settings, {}, test::kNever);
  }

  /// Irradiance at a point of the square.
  static double truth(double y, double z) {
    const double d2 = kDistance * kDistance + y * y + z * z;
    return kMirror * kIntensity * kDistance / (d2 * std::sqrt(d2));
  }

  RoomBuilder room;
  Solution solution;
};

// Photons blur over some 5 cm and are few: 1 % of the mean, where all of it was missing.
TEST(SpecularStills, BlackSurfacesMeasureLightOverMirrors) {
  const SpotOverMirror spot([](RoomBuilder& room) { return room.material("sensor", 0); });
  const Room walls(spot.room.scene(), spot.solution.mesh);
  const VertexData data = gather_vertices(walls, spot.solution, {}, {}, test::kNever);
  double found = 0;
  double expected = 0;
  for (std::size_t v = 0; v < data.vertex_count(); ++v) {
    const Vec3& p = data.positions[v];
    if (p.x() != 3.8) continue;
    found += static_cast<double>(data.irradiance[v]);
    expected += SpotOverMirror::truth(p.y(), p.z());
  }
  ASSERT_GT(expected, 0);
  EXPECT_NEAR(found, expected, 0.04 * expected);
}

// A point 1 cm behind an opal square sees nothing else; its rays meet a zone that is far larger than that.
TEST(SpecularStills, LightOverMirrorsComesThroughOpalSheets) {
  constexpr double kOpal = 0.5;
  for (const double reflectance : {0.0, 0.02}) {
    const SpotOverMirror spot([&](RoomBuilder& room) {
      const MaterialId opal = room.material("opal", reflectance, 0, true);
      room.scene().materials[opal.index()].non_diffuse.diffuse_transmittance = Spectrum::Constant(1, kOpal);
      return opal;
    });
    const Room walls(spot.room.scene(), spot.solution.mesh);
    MeasureSettings settings;
    settings.gather_rays = 65536;
    const MeasuredLight light = measure_light(
        walls, spot.solution, {{"behind", {Vec3(3.81, 0, 0)}, {Vec3(-1, 0, 0)}}}, settings, {}, test::kNever);
    const double truth = kOpal * SpotOverMirror::truth(0, 0);
    EXPECT_NEAR(light.irradiance[0].all, truth, 0.04 * truth) << reflectance;
  }
}

TEST(SpecularStills, LightOverMirrorsIsALayerOfItsOwn) {
  // Between mirrors a lamp of the size of the floor lights the ceiling as one without end would: E = 1, and
  // what does not come straight from it comes over the mirrors.
  RoomBuilder room;
  const MaterialId mirror = room.material("mirror", 0);
  room.scene().materials[mirror.index()].non_diffuse.specular_reflectance = Spectrum::Constant(1, 1.0);
  const MaterialId lamp = room.material("lamp", 0, 1);
  const MaterialId ceiling = room.material("ceiling", 0.5);
  room.box(Vec3::Zero(), {1, 1.3, 0.7}, {mirror, mirror, mirror, mirror, lamp, ceiling}, 3);
  Camera camera;
  camera.eye = {0.5, 0.65, 0.35};
  camera.look_at = {0.5, 0.65, 0.7};
  camera.up = {0, 1, 0};
  camera.vertical_fov_deg = 60;
  SolverSettings solve;
  solve.packets = 640'000;
  solve.batch_packets = 20'000;
  solve.threads = 2;
  const std::atomic<bool> interrupt{false};
  const Solution solution = solve_zones(room.scene(), room.mesh(), solve, nullptr, interrupt);
  const Room walls(room.scene(), solution.mesh);
  for (const Integrator integrator : {Integrator::kZones, Integrator::kGather, Integrator::kPath}) {
    StillSettings settings;
    settings.width = settings.height = 16;
    settings.integrator = integrator;
    settings.spp = 256;
    settings.threads = 2;
    const StillImage image = render_still(walls, solution, camera, settings, {}, interrupt);
    MeanTest caustic;
    for (std::size_t p = 0; p < image.pixel_count(); ++p) {
      // Zones read the parts of the solution one by one, but caustics of them all.
      EXPECT_LT(image.indirect[p], integrator == Integrator::kZones ? 2e-4 : 1e-6) << to_string(integrator);
      caustic.add(static_cast<double>(image.caustic[p] + image.direct[p]));
      EXPECT_GT(image.caustic[p], 0) << to_string(integrator);
      EXPECT_GT(image.direct[p], 0) << to_string(integrator);
    }
    const double truth = 0.5 / std::numbers::pi;
    EXPECT_TRUE(caustic.agrees_with(truth)) << to_string(integrator) << " " << caustic.mean() << " " << truth;
    EXPECT_TRUE(caustic.would_notice(0.02, truth)) << to_string(integrator);
  }
}

TEST(SpecularStills, LampsAreSeenInMirrorsAndPanesWithTheirShare) {
  NonDiffusePart mirror;
  mirror.specular_reflectance = Spectrum::Constant(1, 0.7);
  NonDiffusePart pane;
  pane.angle_law = AngleLaw::kDielectric;
  pane.index_of_refraction = 1.5;
  pane.specular_transmittance = Spectrum::Constant(1, 1);
  NonDiffusePart surface = pane;
  surface.is_solid = true;
  for (const Integrator integrator : {Integrator::kZones, Integrator::kGather, Integrator::kPath}) {
    const auto brightness = [&](const NonDiffusePart& part) {
      const StillImage image = look_down(part, integrator);
      return image.direct[5] + image.indirect[5];
    };
    EXPECT_NEAR(brightness(mirror), 0.7, 1e-5) << to_string(integrator);
    EXPECT_NEAR(brightness(pane), 1 / 13.0, 1e-4) << to_string(integrator);
    EXPECT_NEAR(brightness(surface), 0.04, 1e-4) << to_string(integrator);
  }
}

TEST(SpecularStills, OpalSheetsGlowByTheLampBehindThem) {
  NonDiffusePart opal;
  opal.diffuse_transmittance = Spectrum::Constant(1, 0.6);
  // A square seen from above its middle fills this share of the cosine-weighted hemisphere.
  const double side = 9 / std::sqrt(82.0);
  const double truth = 0.6 * 4 / std::numbers::pi * side * std::atan(side);
  for (const Integrator integrator : {Integrator::kGather, Integrator::kPath}) {
    const StillImage image = look_down(opal, integrator, true, 64);
    MeanTest mean;
    for (std::size_t p = 0; p < image.pixel_count(); ++p)
      mean.add(static_cast<double>(image.direct[p] + image.indirect[p]));
    EXPECT_TRUE(mean.agrees_with(truth)) << to_string(integrator) << " " << mean.mean() << " " << truth;
    EXPECT_TRUE(mean.would_notice(0.02, truth)) << to_string(integrator);
  }
}

TEST(SpecularStills, LampsAreSeenInGlossAsFoundByShadowRaysAndByTheLobe) {
  // Lamps that fill the lobe: the share times the albedo of the lobe along the normal (gloss_test.cpp).
  NonDiffusePart gloss;
  gloss.specular_reflectance = Spectrum::Constant(1, 0.7);
  gloss.roughness = 0.2;
  NonDiffusePart sheet;
  sheet.specular_transmittance = Spectrum::Constant(1, 0.6);
  sheet.transmission_roughness = 0.2;
  for (const Integrator integrator : {Integrator::kZones, Integrator::kGather, Integrator::kPath})
    for (const auto& [lobe, albedo] :
         {std::pair(GlossLobe::kWard, 0.96), std::pair(GlossLobe::kPhong, 1.0)}) {
      gloss.lobe = sheet.lobe = lobe;
      for (const bool under : {false, true}) {
        const StillImage image = look_down(under ? sheet : gloss, integrator, under, 64);
        MeanTest mean;
        for (std::size_t p = 0; p < image.pixel_count(); ++p)
          mean.add(static_cast<double>(image.direct[p] + image.indirect[p]));
        const double truth = (under ? 0.6 : 0.7) * albedo;
        EXPECT_TRUE(mean.agrees_with(truth)) << to_string(integrator) << " " << mean.mean() << " " << truth;
        EXPECT_TRUE(mean.would_notice(0.05, truth)) << to_string(integrator);
      }
    }
}

}  // namespace
}  // namespace reemit

// What the reference makes of mirrors and glass, against closed forms: it has formulas of its own, so that it
// can tell of the program's.
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "bench/hit_paths/glass_shares.h"
#include "bench/hit_paths/hit_path_tracer.h"
#include "tests/support/mean_test.h"
#include "tests/support/specular_furnace.h"
#include "tests/support/variable_furnace.h"

namespace reemit::hit_paths {
namespace {

using test::MeanTest;
using test::RoomBuilder;
using test::SpecularFurnace;

constexpr double kDegree = std::numbers::pi / 180;

NonDiffusePart glass(double ior, bool solid, double clear = 1) {
  NonDiffusePart part;
  part.angle_law = AngleLaw::kDielectric;
  part.index_of_refraction = ior;
  part.specular_transmittance = Spectrum::Constant(1, clear);
  part.is_solid = solid;
  return part;
}

TEST(GlassShares, of_a_surface_are_those_of_tables) {
  // n = 1.5.
  const std::array<std::array<double, 2>, 5> truth{{{0, 0.04},
                                                    {30, 0.0415226259758215},
                                                    {45, 0.0502399110122359},
                                                    {60, 0.0891867128022128},
                                                    {85, 0.612799645264827}}};
  for (const auto& [angle, reflected] : truth)
    EXPECT_NEAR(at_surface(1.5, angle * kDegree).reflected, reflected, 1e-12) << angle;
  EXPECT_NEAR(at_surface(1.5, 0.99e-6).reflected, at_surface(1.5, 1.01e-6).reflected, 1e-9)
      << "the limit along the normal";
  EXPECT_EQ(at_surface(1 / 1.5, 42 * kDegree).transmitted, 0) << "beyond the critical angle of 41.8 degrees";
  const double behind = refracted_angle(1.5, 1.0);
  EXPECT_NEAR(at_surface(1.5, 1.0).reflected, at_surface(1 / 1.5, behind).reflected, 1e-13);
}

TEST(GlassShares, of_a_pane_keep_polarisations_apart) {
  const GlassShares clear = at_pane(1.5, 1, 60 * kDegree);
  EXPECT_NEAR(clear.transmitted, 0.8481284097288, 1e-12);
  EXPECT_NEAR(clear.reflected, 0.1518715902712, 1e-12);
  const GlassShares grey = at_pane(1.52, std::exp(-0.1), 80 * kDegree);
  EXPECT_NEAR(grey.transmitted, 0.384797136332192, 1e-12);
  EXPECT_NEAR(grey.reflected, 0.502359516509637, 1e-12);
}

/// Mean of what the reference sees in pictures of 8 x 8 pixels.
MeanTest look(const Scene& scene, const Camera& camera, int pictures) {
  const HitPathTracer tracer(scene, camera, 8, 8);
  HitPathTracer::Random random(7);
  MeanTest mean;
  for (int picture = 0; picture < pictures; ++picture) {
    double sum = 0;
    for (int pixel = 0; pixel < 64; ++pixel) tracer.add_path(pixel % 8, pixel / 8, random, &sum);
    mean.add(sum / 64);
  }
  return mean;
}

TEST(HitPathsOverGlass, a_furnace_of_mirrors_and_glass_is_evenly_bright) {
  const SpecularFurnace furnace;
  const MeanTest mean = look(furnace.room().scene(), test::VariableFurnace::camera(), 400);
  const double truth = SpecularFurnace::kIrradiance / std::numbers::pi;
  EXPECT_TRUE(mean.agrees_with(truth));
  EXPECT_TRUE(mean.would_notice(0.05, truth));
}

/// A lamp of radiance 1 far below, seen at an angle to the normal of what lies between.
class LookDown {
 public:
  explicit LookDown(const NonDiffusePart& between) {
    const MaterialId lamp = room_.material("lamp", 0, std::numbers::pi);
    quad(lamp, -10);
    between_ = room_.material("between", 0, 0, true);
    room_.scene().materials[between_.index()].non_diffuse = between;
  }
  LookDown& pane() {
    quad(between_, 0);
    return *this;
  }
  LookDown& slab(double thickness) {
    room_.solid({-kWide, -kWide, -thickness}, {kWide, kWide, 0}, between_, 1);
    return *this;
  }
  MeanTest seen(double angle) const {
    Camera camera;
    camera.eye = Vec3(std::sin(angle * kDegree), 0, std::cos(angle * kDegree));
    camera.look_at = Vec3::Zero();
    camera.up = {0, 1, 0};
    camera.vertical_fov_deg = 0.01;
    return look(room_.scene(), camera, 400);
  }

 private:
  static constexpr double kWide = 1000;
  void quad(MaterialId m, double z) {
    room_.quad(
        m, {Vec3(-kWide, -kWide, z), Vec3(kWide, -kWide, z), Vec3(kWide, kWide, z), Vec3(-kWide, kWide, z)},
        1);
  }

  RoomBuilder room_;
  MaterialId between_;
};

TEST(HitPathsOverGlass, panes_let_through_what_they_do) {
  LookDown clear(glass(1.5, false));
  clear.pane();
  EXPECT_TRUE(clear.seen(60).agrees_with(0.8481284097288));
  LookDown grey(glass(1.52, false, std::exp(-0.1)));
  grey.pane();
  EXPECT_TRUE(grey.seen(40).agrees_with(0.813912941293186));
  NonDiffusePart sheet;
  sheet.specular_transmittance = Spectrum::Constant(1, 0.3);
  LookDown constant(sheet);
  constant.pane();
  EXPECT_TRUE(constant.seen(70).agrees_with(0.3));
}

TEST(HitPathsOverGlass, a_slab_bends_reflects_and_absorbs) {
  NonDiffusePart part = glass(1.5, true);
  part.absorption_per_m = Spectrum::Constant(1, 3);
  LookDown slab(part);
  slab.slab(0.05);
  for (const double angle : {0.0, 60.0}) {
    const double r = angle == 0 ? 0.04 : 0.0891867128022128;
    const double behind = std::asin(std::sin(angle * kDegree) / 1.5);
    const double once = std::exp(-3 * 0.05 / std::cos(behind));
    EXPECT_TRUE(slab.seen(angle).agrees_with((1 - r) * (1 - r) * once / (1 - r * r * once * once))) << angle;
  }
}

/// The eye stands beside the lamp and sees it in what lies below.
TEST(HitPathsOverGlass, metals_reflect_more_at_grazing_angles) {
  for (const AngleLaw law : {AngleLaw::kConstant, AngleLaw::kSchlick}) {
    RoomBuilder room;
    const MaterialId lamp = room.material("lamp", 0, std::numbers::pi);
    const MaterialId metal = room.material("metal", 0.1);
    NonDiffusePart& part = room.scene().materials[metal.index()].non_diffuse;
    part.specular_reflectance = Spectrum::Constant(1, 0.6);
    part.angle_law = law;
    room.quad(metal, {Vec3(-9, -9, 0), Vec3(9, -9, 0), Vec3(9, 9, 0), Vec3(-9, 9, 0)}, 1);
    // Behind the mirror plane's normal through the point that is looked at, edge-on to the rest of the
    // metal's light.
    room.quad(lamp, {Vec3(-8, -1e-3, 0), Vec3(-8, 1e-3, 0), Vec3(-8, 1e-3, 8), Vec3(-8, -1e-3, 8)}, 1);
    Camera camera;
    camera.eye = Vec3(std::sin(60 * kDegree), 0, std::cos(60 * kDegree));
    camera.look_at = Vec3::Zero();
    camera.vertical_fov_deg = 1e-4;
    const MeanTest mean = look(room.scene(), camera, 2000);
    const double truth = law == AngleLaw::kConstant ? 0.6 : 0.6 + 0.3 / 32;
    EXPECT_NEAR(mean.mean(), truth, 5 * mean.standard_error() + 2e-4)
        << "the lamp's diffuse light is below 2e-5";
    EXPECT_LT(mean.standard_error(), 0.001);
  }
}

}  // namespace
}  // namespace reemit::hit_paths

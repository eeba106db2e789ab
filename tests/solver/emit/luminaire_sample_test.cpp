// What samples of luminaires say of their direction and density.
#include "solver/emit/luminaire_sample.h"

#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "solver/emit/luminaire_table.h"
#include "solver/sampling/sobol.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using test::RoomBuilder;

/// A floor with lamps of several shapes above it, and lights without area.
class Lamps : public testing::Test {
 protected:
  Lamps() {
    const MaterialId floor = room_.material("floor", 0.5);
    const MaterialId lamp = room_.material("lamp", 0, std::numbers::pi);
    room_.quad(floor, {Vec3(-2, -2, 0), {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}, 1);
    room_.quad(lamp, {Vec3(-1, -1, 2), {-1, 0, 2}, {0, 0, 2}, {0, -1, 2}}, 1);
    room_.triangle(lamp, {Vec3(1, 1, 2), {1, 1.5, 2}, {1.5, 1, 2}}, 1);
    room_.shape(lamp, Sphere{{1, -1, 1}, 0.3}, 1);
    room_.shape(lamp, Disk{{0, 1, 1.5}, {0, 0, -1}, 0.2}, 1);
    room_.shape(lamp, Cylinder{{-1, 1, 1}, {-0.5, 1, 1}, 0.1}, 1);
  }
  template <class Use>
  void for_each_sample(Use&& use) {
    const ZoneMesh mesh = room_.mesh().mesh;
    const Room walls(room_.scene(), mesh);
    const LuminaireTable table(walls);
    const Vec3f x = walls.rays().ray_origin(TriangleId(0), 0.4F, 0.3F, true);
    const SobolSequence numbers(3);
    for (std::size_t entry = 0; entry < table.size(); ++entry)
      for (std::uint32_t k = 0; k < 64; ++k) {
        LuminaireSample sample;
        if (table.sample(entry, x, Vec3f::UnitZ(), numbers.sample(k, 0), numbers.sample(k, 1), sample))
          use(entry, x, sample);
      }
  }

  RoomBuilder room_;
};

TEST_F(Lamps, FactorIsTheCosineOverTheDensityOfTheDirection) {
  std::set<std::size_t> seen;
  for_each_sample([&](std::size_t entry, const Vec3f& x, const LuminaireSample& sample) {
    seen.insert(entry);
    ASSERT_FALSE(sample.at_infinity);
    const float cosine = sample.towards(x).normalized().z();
    EXPECT_NEAR(sample.factor * sample.pdf_per_sr, cosine, 1e-3 * cosine) << entry;
  });
  EXPECT_EQ(seen.size(), 5U);
}

TEST_F(Lamps, NoRayMeetsLightsWithoutAreaSoTheyHaveNoDensity) {
  RoomBuilder bare;
  bare.quad(bare.material("floor", 0.5), {Vec3(-2, -2, 0), {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}, 1);
  bare.scene().lights = {PointLight{"p", {0, 0, 1}, bare.flat(1)},
                         SpotLight{"s", {0.5, 0, 1}, {0, 0, -1}, bare.flat(1)},
                         DirectionalLight{"d", Vec3(0.6, 0, -0.8), bare.flat(1)}};
  room_ = bare;
  int at_infinity = 0;
  int samples = 0;
  for_each_sample([&](std::size_t, const Vec3f& x, const LuminaireSample& sample) {
    EXPECT_EQ(sample.pdf_per_sr, 0);
    EXPECT_GT(sample.towards(x).z(), 0);
    at_infinity += sample.at_infinity ? 1 : 0;
    ++samples;
  });
  EXPECT_EQ(samples, 3 * 64);
  EXPECT_EQ(at_infinity, 64);
}

}  // namespace
}  // namespace reemit

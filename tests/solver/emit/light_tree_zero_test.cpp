// Where a light tree may rule a luminaire out, and where it must not: weights must be positive for every
// luminaire that contributes ([SWZ96] sec. 4, and the mistake confessed in sec. 4.2).
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "solver/emit/light_tree.h"
#include "tests/solver/emit/random_luminaires.h"

namespace reemit {
namespace {

using test::ShapedLuminaire;

TEST(LightTreeZero, NoLuminaireThatContributesIsRuledOut) {
  test::RandomLuminaires random(1);
  int contributing = 0, centre_below = 0, ruled_out = 0;
  for (int scene = 0; scene < 60; ++scene) {
    const float size = std::pow(10.0F, random.uniform(-3, 0.3F));
    const std::size_t count = std::array<std::size_t, 4>{1, 3, 40, 400}[static_cast<std::size_t>(scene % 4)];
    // All kinds, or one: bounds of spots alone are the narrowest, and any other kind would widen them.
    const int kind = scene % 5;
    const std::vector<ShapedLuminaire> luminaires =
        kind == 4 ? random.scene(count, size)
                  : random.scene_of(static_cast<ShapedLuminaire::Kind>(kind), count, size);
    const LightTree tree(test::bounds_of(luminaires));
    for (int i = 0; i < 60; ++i) {
      // Anywhere, close to a luminaire, or just about in its plane and at its horizon.
      const ShapedLuminaire& one =
          luminaires[static_cast<std::size_t>(random.unit() * static_cast<double>(luminaires.size()))];
      Vec3f x = random.in_cube(1.5F);
      if (i % 3 > 0) x = one.corner[0] + size * std::pow(10.0F, random.uniform(-4, 0)) * random.direction();
      Vec3f n = random.direction();
      if (i % 3 == 2) {
        const Vec3f away = (one.corner[1] - x + 1e-3F * size * random.direction()).normalized();
        n = (n - n.dot(away) * away).normalized();
      }
      for (std::size_t k = 0; k < luminaires.size(); ++k) {
        const Vec3 at = x.cast<double>(), normal = n.cast<double>();
        const bool zero = !(tree.probability(static_cast<std::uint32_t>(k), x, n) > 0);
        ruled_out += zero;
        if (!luminaires[k].can_light(at, normal)) continue;
        ++contributing;
        centre_below += normal.dot(luminaires[k].middle() - at) < 0;
        EXPECT_FALSE(zero) << "scene " << scene << " receiver " << i << " luminaire " << k;
      }
    }
  }
  EXPECT_GT(contributing, 100000);
  EXPECT_GT(centre_below, 2000);  // Where a test of the middle alone would have been wrong.
  EXPECT_GT(ruled_out, 100000);   // The bounds are good for something.
}

TEST(LightTreeZero, CentreBelowTheHorizon) {
  // The very case of [SWZ96, sec. 4.2]: sphere and panel whose middle is below the horizon, not all of them.
  const Vec3f x(0, 0, 0), n(0, 0, 1);
  const LuminaireBounds sphere = sphere_bounds({1, 0, -0.4F}, 0.5F, 1);
  const LuminaireBounds panel =
      flat_bounds(std::array{Vec3f(1, -1, -2), Vec3f(1, 1, -2), Vec3f(1, 0, 0.01F)}, {-1, 0, 0}, 1);
  const LuminaireBounds lamp = sphere_bounds({0, 0, 1}, 0.1F, 1000);
  const LightTree tree(std::array{sphere, panel, lamp});
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_GT(tree.probability(i, x, n), 0) << i;
  EXPECT_EQ(LightTree(std::array{sphere}).probability(0, x, n), 1);
}

TEST(LightTreeZero, WhatIsProvenDarkIsNeverPicked) {
  const Vec3f x(0, 0, 0), n(0, 0, 1);
  const LuminaireBounds below = sphere_bounds({1, 0, -0.6F}, 0.5F, 1e6F);
  const LuminaireBounds turned_away = flat_bounds(
      std::array{Vec3f(-0.1F, -0.1F, 1), Vec3f(0.1F, -0.1F, 1), Vec3f(0, 0.1F, 1)}, {0, 0, 1}, 1e6F);
  const LuminaireBounds spot_beside = spot_bounds({0.5F, 0, 1}, {0, 0, -1}, std::cos(0.3F), 1e6F);
  const LuminaireBounds spot_on = spot_bounds({0.2F, 0, 1}, {0, 0, -1}, std::cos(0.3F), 1);
  const std::array all{below, turned_away, spot_beside, spot_on};
  const LightTree tree(all);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(tree.probability(i, x, n), 0) << i;
  EXPECT_EQ(tree.probability(3, x, n), 1);

  const LightTree dark(std::span<const LuminaireBounds>(all).first(3));
  double u = 0.5;
  Pick pick;
  EXPECT_FALSE(dark.pick(x, n, u, pick));
  EXPECT_EQ(u, 0.5);
}

}  // namespace
}  // namespace reemit

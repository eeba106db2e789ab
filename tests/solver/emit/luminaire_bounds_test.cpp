#include "solver/emit/luminaire_bounds.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "solver/emit/selection.h"
#include "solver/sampling/warp.h"
#include "tests/solver/emit/random_luminaires.h"

namespace reemit {
namespace {

double angle(const Vec3f& a, const Vec3f& b) {
  const Vec3 p = a.cast<double>(), q = b.cast<double>();
  return std::atan2(p.cross(q).norm(), p.dot(q));
}

TEST(LuminaireBounds, MergedHoldBoth) {
  test::RandomLuminaires random(1);
  for (int i = 0; i < 2000; ++i) {
    LuminaireBounds a = random.any(0.3F).bounds(), b = random.any(0.3F).bounds();
    const float spread = std::pow(10.0F, random.uniform(-6, 0.3F));
    a.cos_normals = std::cos(std::min(spread, 3.14159F));
    b.cos_normals = std::cos(random.uniform(0, 1) * spread);
    if (i % 3 == 0) b.axis = (a.axis + 1e-4F * random.direction()).normalized();
    if (i % 17 == 0) b.axis = -a.axis;
    const LuminaireBounds both = merged(a, b);
    EXPECT_TRUE(valid(both));
    EXPECT_EQ(both.intensity, a.intensity + b.intensity);
    EXPECT_EQ(both.cos_emission, std::min(a.cos_emission, b.cos_emission));
    for (const LuminaireBounds& part : {a, b}) {
      EXPECT_TRUE((both.min.array() <= part.min.array()).all());
      EXPECT_TRUE((both.max.array() >= part.max.array()).all());
      const double needed = std::acos(static_cast<double>(part.cos_normals)) + angle(part.axis, both.axis);
      EXPECT_GE(std::acos(static_cast<double>(both.cos_normals)), std::min(needed, std::numbers::pi) - 3e-7)
          << i;
    }
  }
}

TEST(LuminaireBounds, MergedAreTight) {
  const auto side = [](const Vec3f& normal) { return flat_bounds(std::array{Vec3f(0, 0, 0)}, normal, 1); };
  const LuminaireBounds same = merged(side(Vec3f::UnitX()), side(Vec3f::UnitX()));
  EXPECT_EQ(same.cos_normals, 1);
  EXPECT_EQ(same.axis, Vec3f::UnitX());
  const LuminaireBounds across = merged(side(Vec3f::UnitX()), side(Vec3f::UnitY()));
  EXPECT_NEAR(across.cos_normals, std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(across.axis.dot(Vec3f(1, 1, 0).normalized()), 1, 1e-6);
  EXPECT_EQ(merged(side(Vec3f::UnitX()), side(-Vec3f::UnitX())).cos_normals, -1);
}

TEST(LuminaireBounds, ShapesAreHeld) {
  test::RandomLuminaires random(2);
  for (int i = 0; i < 200; ++i) {
    const Vec3f centre = random.in_cube(1);
    const Vec3f normal = random.direction();
    const LuminaireBounds disk = disk_bounds(centre, normal, 0.5F, 1);
    const Frame frame(normal);
    Vec3f farthest = Vec3f::Zero();
    for (int k = 0; k < 3600; ++k) {
      const float phi = static_cast<float>(k) * std::numbers::pi_v<float> / 1800;
      const Vec3f offset = frame.to_world({0.5F * std::cos(phi), 0.5F * std::sin(phi), 0});
      farthest = farthest.cwiseMax(offset);
    }
    EXPECT_LT((disk.max - centre - farthest).cwiseAbs().maxCoeff(), 1e-5F);
    EXPECT_LT((centre - disk.min - farthest).cwiseAbs().maxCoeff(), 1e-5F);
  }
  EXPECT_EQ(sphere_bounds({1, 2, 3}, 0.5F, 1).min, Vec3f(0.5F, 1.5F, 2.5F));
  EXPECT_EQ(spot_bounds({1, 2, 3}, {0, 0, 1}, 0.7F, 1).cos_emission, 0.7F);
}

TEST(LuminaireBounds, NonsenseIsNotValid) {
  const LuminaireBounds good = sphere_bounds({0, 0, 0}, 0.1F, 1);
  EXPECT_TRUE(valid(good));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, infinity, -infinity, 2e6F}) {
    LuminaireBounds b = good;
    b.max[1] = bad;
    EXPECT_FALSE(valid(b)) << bad;
    b = good;
    b.min[2] = bad;
    EXPECT_FALSE(valid(b)) << bad;
    b = good;
    b.axis[0] = bad;
    EXPECT_FALSE(valid(b)) << bad;
    b = good;
    b.cos_normals = bad;
    EXPECT_FALSE(valid(b)) << bad;
    b = good;
    b.cos_emission = bad;
    EXPECT_FALSE(valid(b)) << bad;
  }
  for (const float bad : {nan, infinity, 0.0F, -1.0F}) {
    LuminaireBounds b = good;
    b.intensity = bad;
    EXPECT_FALSE(valid(b)) << bad;
  }
}

TEST(Selection, NamesAreInTheOrderOfTheEnumeration) {
  EXPECT_EQ(name_of(Selection::kConstant), "constant");
  EXPECT_EQ(name_of(Selection::kLinear), "linear");
  EXPECT_EQ(name_of(Selection::kSpatial), "spatial");
}

}  // namespace
}  // namespace reemit

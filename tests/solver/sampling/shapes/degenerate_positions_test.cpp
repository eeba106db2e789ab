#include <cmath>
#include <random>

#include "solver/sampling/shapes/cylinder_sampler.h"
#include "solver/sampling/shapes/disk_sampler.h"
#include "solver/sampling/shapes/rectangle_sampler.h"
#include "solver/sampling/shapes/sphere_sampler.h"
#include "tests/solver/sampling/shapes/shape_checks.h"

namespace reemit {
namespace {

const std::array<Vec3, 3> kTriangle{Vec3(-0.6, -0.5, 0), Vec3(0.7, -0.2, 0), Vec3(0.1, 0.8, 0)};
const Vec3 kUpwards(0, 0, 1);

/// A shape of size 1 or so about the origin, planar ones in z = 0 with their front up, made for a shading
/// point and a density; `check` gets a name and the sampler.
template <class Check>
void for_all_shapes(const Vec3& x, const Vec3& n, Density d, const Check& check) {
  check("sphere", SphereSampler({{0, 0, 0}, 0.5}, x, n, d));
  check("inward sphere", SphereSampler({{0, 0, 0}, 0.5, true}, x, n, d));
  check("disk", DiskSampler({{0, 0, 0}, kUpwards, 0.5}, x, n, d));
  check("cylinder", CylinderSampler({{0, 0, -0.5}, {0, 0, 0.5}, 0.5}, x, n, d));
  check("inward cylinder", CylinderSampler({{0, 0, -0.5}, {0, 0, 0.5}, 0.5, true}, x, n, d));
  check("thin cylinder", CylinderSampler({{0, 0, -0.5}, {0, 0, 0.5}, 0.001}, x, n, d));
  check("rectangle", RectangleSampler({-0.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0}, kUpwards, x, n, d));
  check("triangle", TriangleSampler(kTriangle, kUpwards, x, n, d));
}

/// Nothing that is not finite, and no weight beyond what a density can be asked for.
template <class Sampler>
void expect_sound(const Sampler& sampler, const Vec3& x, const Vec3& n, int count) {
  const auto s = test::statistics(sampler, x, n, count);
  EXPECT_TRUE(s.finite);
  if (!sampler.lights()) {
    EXPECT_EQ(s.largest, 0);
  }
  if (sampler.lights() && sampler.density() == Density::kSolidAngle) {
    EXPECT_LT(s.largest, 4 * std::numbers::pi * 30);
  }
  if (sampler.lights() && sampler.density() == Density::kCosine) {
    EXPECT_LT(s.largest, std::numbers::pi * 130);
  }
  EXPECT_LT(
      s.mean,
      1e3 / (1 + x.squaredNorm()) +
          (sampler.density() == Density::kArea || sampler.density() == Density::kVisibleArea ? 1e300 : 0.0));
  const Vec3 anywhere(0.1, 0.2, 0);
  EXPECT_TRUE(std::isfinite(sampler.pdf_per_sr(anywhere)) || anywhere == x);
  const auto u = sampler.invert(anywhere);
  EXPECT_TRUE(u[0] >= 0 && u[0] <= 1 && u[1] >= 0 && u[1] <= 1) << u[0] << " " << u[1];
}

TEST(DegeneratePositions, OnInAndAtTheEdgesOfTheShapes) {
  const double tiny = 1e-12;
  const std::vector<Vec3> places{
      {0, 0, 0},          {0, 0, 0.5},        {0, 0, -0.5},       {0.5, 0, 0},        {0.5, 0, 0.5},
      {-0.5, -0.5, 0},    {0.5, 0.5, tiny},   {0.5, 0, tiny},     {0, 0, tiny},       {0, 0, 1e-300},
      {0.5 + tiny, 0, 0}, {0.5 - tiny, 0, 0}, {2, 0, 0},          {2, 0, tiny},       {2, 0, -tiny},
      {0, 0, 1},          {0, 0, -1},         {0.5, 0, 1},        {0.5 + 1e-9, 0, 1}, {0.001, 0, 0.2},
      {-0.6, -0.5, 0},    {-0.6, -0.5, 1e-3}, {-0.6, -0.5, 1e-9}, {0.7, -0.2, 0.3},   {0.05, -0.35, 1e-6},
      {0, 0.5, 0.25},     {0.3, 0.4, 0},      {1e-200, 0, 0.3},   {0.5, 1e-170, 0.3}};
  const std::vector<Vec3> normals{{0, 0, 1}, {0, 0, -1}, {1, 0, 0},   {-1, 0, 0},
                                  {0, 1, 0}, {1, 1, 1},  {-1, 2, -3}, {1e-12, 0, 1}};
  for (const Vec3& x : places)
    for (const Vec3& to : normals) {
      const Vec3 n = to.normalized();
      for (const Density d : test::kDensities)
        for_all_shapes(x, n, d, [&](const char* name, const auto& sampler) {
          SCOPED_TRACE(std::string(name) + ", " + test::name_of(d));
          SCOPED_TRACE(::testing::Message() << "x " << x.transpose() << ", n " << n.transpose());
          expect_sound(sampler, x, n, 40);
        });
    }
}

TEST(DegeneratePositions, AtAnyDistance) {
  // Distances from 1e-4 to 1e8 sizes, all directions and normals.
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-4, 8);
  const auto direction = [&] { return Vec3(normal(random), normal(random), normal(random)).normalized(); };
  for (int i = 0; i < 1500; ++i) {
    const Vec3 x = std::pow(10, exponent(random)) * direction();
    const Vec3 n = direction();
    for (const Density d : test::kDensities)
      for_all_shapes(x, n, d, [&](const char* name, const auto& sampler) {
        SCOPED_TRACE(std::string(name) + ", " + test::name_of(d));
        SCOPED_TRACE(::testing::Message() << "x " << x.transpose() << ", n " << n.transpose());
        expect_sound(sampler, x, n, 10);
      });
  }
}

TEST(DegeneratePositions, RoundTripsAndDensitiesFrom1e3SizesTo1e3thOfASize) {
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-3, 3);
  const auto direction = [&] { return Vec3(normal(random), normal(random), normal(random)).normalized(); };
  for (int i = 0; i < 1500; ++i) {
    // Above a point of the shapes, or anywhere.
    Vec3 x = std::pow(10, exponent(random)) * direction();
    if (i % 2 == 0) x = Vec3(0.3 * normal(random), 0.3 * normal(random), std::fabs(x.z()));
    const Vec3 n = direction();
    for (const Density d : {Density::kVisibleArea, Density::kSolidAngle, Density::kCosine})
      for_all_shapes(x, n, d, [&](const char* name, const auto& sampler) {
        SCOPED_TRACE(std::string(name) + ", " + test::name_of(d));
        SCOPED_TRACE(::testing::Message() << "x " << x.transpose() << ", n " << n.transpose());
        const auto s = test::statistics(sampler, x, n, 20);
        EXPECT_LT(s.round_trip, 1e-5);
        EXPECT_LT(s.pdf_mismatch, 1e-5);
        EXPECT_LT(s.weight_mismatch, 1e-6);
      });
  }
}

TEST(DegeneratePositions, WhatIsCalledDarkGetsNothingByArea) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 400; ++i) {
    const Vec3 x(normal(random), normal(random), normal(random));
    const Vec3 n = Vec3(normal(random), normal(random), normal(random)).normalized();
    for (const Density d : test::kDensities) {
      if (!DiskSampler({{0, 0, 0}, kUpwards, 0.5}, x, n, d).lights()) {
        const DiskSampler all({{0, 0, 0}, kUpwards, 0.5}, x, n, Density::kArea);
        EXPECT_EQ(test::statistics(all, x, n, 50).largest, 0);
      }
      // A sampler that lights agrees with area samples that something arrives.
      const SphereSampler sphere({{0, 0, 0}, 0.5}, x, n, d);
      if (sphere.lights()) {
        EXPECT_GT(sphere.irradiance(), 0);
      }
    }
  }
}

TEST(DegeneratePositions, ShapesWithoutSizeLightNothing) {
  const Vec3 x(0.2, 0.1, 1);
  const Vec3 n(0, 0, -1);
  for (const Density d : test::kDensities) {
    const std::array<Vec3, 3> line{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)};
    EXPECT_FALSE(TriangleSampler(line, kUpwards, x, n, d).lights()) << test::name_of(d);
    EXPECT_FALSE(RectangleSampler({0, 0, 0}, {1, 0, 0}, {0, 0, 0}, kUpwards, x, n, d).lights());
    EXPECT_FALSE(RectangleSampler({0, 0, 0}, {0, 0, 0}, {0, 0, 0}, kUpwards, x, n, d).lights());
    const std::vector<Vec3> two{Vec3(0, 0, 0), Vec3(1, 0, 0)};
    EXPECT_FALSE(ConvexPolygonSampler(two, kUpwards, x, n, d).lights());
  }
}

}  // namespace
}  // namespace reemit

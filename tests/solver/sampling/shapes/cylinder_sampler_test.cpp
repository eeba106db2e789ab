#include "solver/sampling/shapes/cylinder_sampler.h"

#include <cmath>
#include <numbers>

#include "tests/solver/sampling/shapes/shape_cases.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::ShapeCase;

CylinderSampler make_cylinder(const Cylinder& s, const Vec3& x, const Vec3& n, Density d) {
  return {s, x, n, d};
}

/// Outside: contour integral over the visible patch with 15 digits, the first also Howell's closed form B-31.
/// Inside, looking up the axis from an end at distance h from the other: pi less the disk at that end,
/// pi r^2/(r^2 + h^2). Looking in from beside the axis: pi times the difference of the disks at the ends, as
/// all of the mantle between them that x sees is lit, less what the near edge hides; unknown here.
const std::vector<ShapeCase<Cylinder>>& cylinders() {
  static const std::vector<ShapeCase<Cylinder>> all{
      {"B-31", {{0, 0, 0}, {0, 0, 2}, 1}, {3, 0, 0}, {-1, 0, 0}, 0.4154350528842505},
      {"middle", {{0, 0, 0}, {0, 0, 2}, 1}, {3, 0, 0.5}, {-1, 0, 0}, 0.5090930793123153},
      {"tube", {{-0.6, 0, 2}, {0.6, 0, 2}, 0.019}, {0, 0, 0}, {0, 0, 1}, 0.01083925982598737},
      {"tube beside", {{-0.6, 0, 2}, {0.6, 0, 2}, 0.019}, {0.4, 1, 0}, {0, 0, 1}, 0.007421466054401516},
      {"tilted", {{0, 0, 0}, {0, 0, 2}, 0.5}, {3, 1, 0.5}, {-1, -0.5, 0.3}, 0.200728250552567},
      {"inside on the axis", {{0, 0, 0}, {0, 0, 2}, 1, true}, {0, 0, 0}, {0, 0, 1}, pi * 0.8},
      {"inside off the axis", {{0, 0, -1}, {0, 0, 2}, 1, true}, {0.3, 0.5, 0}, {1, 0.2, 0.4}, -1},
      {"looking in", {{0, 0, 1}, {0, 0, 3}, 1, true}, {1.5, 0, 0}, {-0.3, 0, 1}, -1},
  };
  return all;
}

double cylinder_area(const Cylinder& s) {
  return 2 * pi * s.radius * (s.top - s.base).norm();
}

TEST(CylinderSampler, MeansAreTheClosedForms) {
  test::expect_means(cylinders(), make_cylinder, [](Density) { return false; });
}

TEST(CylinderSampler, SamplesAndInverseFollowTheDensity) {
  test::expect_densities(cylinders(), make_cylinder, cylinder_area);
}

TEST(CylinderSampler, DensitiesAgreeWhereNoClosedFormIsKnown) {
  for (std::size_t i = 6; i < cylinders().size(); ++i) {
    const ShapeCase<Cylinder>& c = cylinders()[i];
    const Vec3 n = c.n.normalized();
    const auto exact = test::statistics(make_cylinder(c.shape, c.x, n, Density::kCosine), c.x, n, 200'000);
    for (const Density d : test::kDensities) {
      const auto s = test::statistics(make_cylinder(c.shape, c.x, n, d), c.x, n, 200'000, 5);
      EXPECT_LT(std::fabs(s.mean - exact.mean), 4 * std::hypot(s.error, exact.error))
          << c.name << ", " << test::name_of(d);
    }
  }
}

TEST(CylinderSampler, FarCylindersAreTheirProjectedArea) {
  // 2 r L sin(gamma) cos(theta) / d^2 to first order in 1/d.
  const Cylinder tube{{0, 0, -0.5}, {0, 0, 0.5}, 0.02};
  for (const double d : {1e3, 1e4, 5e4})
    for (const Vec3& to : {Vec3(1, 0, 0), Vec3(1, 2, -2), Vec3(0.01, 0, 1), Vec3(-3, 1, 20)}) {
      const Vec3 direction = to.normalized();
      const Vec3 n = (-direction + Vec3(0.1, 0.2, 0.3)).normalized();
      const double sine = std::hypot(direction.x(), direction.y());
      const double truth = 2 * 0.02 * sine * n.dot(-direction) / (d * d);
      const Vec3 x = d * direction;
      for (const Density density : {Density::kSolidAngle, Density::kCosine}) {
        const auto s = test::statistics(make_cylinder(tube, x, n, density), x, n, 2000);
        EXPECT_NEAR(s.mean / truth, 1, 4 / d + 4 * s.error / truth) << d << ", " << to.transpose();
        EXPECT_LT(s.error / truth * std::sqrt(2000), 0.05);
      }
    }
}

TEST(CylinderSampler, BothFitsRejectAPlantedBias) {
  const ShapeCase<Cylinder>& c = cylinders()[1];
  const CylinderSampler by_area(c.shape, c.x, c.n, Density::kArea);
  const CylinderSampler sampler(c.shape, c.x, c.n, Density::kCosine);
  EXPECT_LT(test::fit_of_samples(sampler, by_area, cylinder_area(c.shape), c.x, test::kManyDraws, 0.02).odds,
            test::kFalseAlarm);
  EXPECT_LT(test::fit_of_inverse(sampler, by_area, cylinder_area(c.shape), c.x, test::kManyDraws, 0.04),
            test::kFalseAlarm);
}

TEST(CylinderSampler, WhatItHidesOfItselfIsDark) {
  const Vec3 up(0, 0, 1);
  for (const Density d : test::kDensities) {
    EXPECT_FALSE(
        make_cylinder({{0, 0, -1}, {0, 0, 1}, 1}, {0, 0, 0}, up, d).lights());  // inside an outward one
    EXPECT_FALSE(
        make_cylinder({{0, 0, -1}, {0, 0, 1}, 1, true}, {2, 0, 0}, up, d).lights());  // beside an inward one
    EXPECT_FALSE(
        make_cylinder({{0, 0, 1}, {0, 0, 2}, 1}, {0.5, 0, 0}, up, d).lights());  // below an outward one
    EXPECT_TRUE(
        make_cylinder({{0, 0, 1}, {0, 0, 2}, 1, true}, {0.5, 0, 0}, up, d).lights());  // into an inward one
    EXPECT_FALSE(
        make_cylinder({{3, 0, -1}, {3, 0, -2}, 0.9}, {0, 0, 0}, up, d).lights());       // below the horizon
    EXPECT_FALSE(make_cylinder({{3, 0, 1}, {3, 0, 1}, 1}, {0, 0, 0}, up, d).lights());  // no length
    EXPECT_FALSE(make_cylinder({{3, 0, 1}, {3, 0, 2}, 0}, {0, 0, 0}, up, d).lights());  // no radius
  }
}

}  // namespace
}  // namespace reemit

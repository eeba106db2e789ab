#include "solver/sampling/shapes/sphere_sampler.h"

#include <cmath>
#include <numbers>

#include "tests/solver/sampling/shapes/shape_cases.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::ShapeCase;

SphereSampler make_sphere(const Sphere& s, const Vec3& x, const Vec3& n, Density d) {
  return {s, x, n, d};
}
SphereSampler make_clear_sphere(const Sphere& s, const Vec3& x, const Vec3& n, Density d) {
  return {s, x, n, d, true};
}

/// Whole sphere above the horizon: pi (R/d)^2 cos(theta). Partly below, with h = d/R, w = sqrt(h^2 - 1),
/// y = -w cot(theta): [cos(theta) acos(y) - w sin(theta) sqrt(1 - y^2)]/h^2 + atan(sin(theta) sqrt(1 -
/// y^2)/w) (Howell's catalogue of configuration factors), evaluated with 30 digits.
const std::vector<ShapeCase<Sphere>>& spheres() {
  static const std::vector<ShapeCase<Sphere>> all{
      {"above", {{1, 0, 1.7320508075688772}, 0.5}, {0, 0, 0}, {0, 0, 1}, 0.17004369039695794},
      {"partly below the horizon", {{2, 0, 0.3}, 1}, {0, 0, 0}, {0, 0, 1}, 0.15385944604615762},
      {"half below the horizon", {{2, 0, 0}, 1}, {0, 0, 0}, {0, 0, 1}, 0.0905860737060795},
      {"mostly below the horizon", {{2, 0, -0.4}, 1}, {0, 0, 0}, {0, 0, 1}, 0.027474342102480825},
      {"near", {{0, 0, -1.05}, 1}, {0, 0, 0}, {0, 0, -1}, 2.849517146113191},
      {"inside", {{0.3, -0.2, 0.1}, 1, true}, {0, 0, 0}, {0.2, 0.3, 1}, pi},
      {"far side", {{1, 0, 1.7320508075688772}, 0.5, true}, {0, 0, 0}, {0, 0, 1}, 0.17004369039695794},
      {"far side, cut", {{2, 0, 0.3}, 1, true}, {0, 0, 0}, {0, 0, 1}, 0.15385944604615762},
  };
  return all;
}

double sphere_area(const Sphere& s) {
  return 4 * pi * s.radius * s.radius;
}

TEST(SphereSampler, MeansAreTheClosedForms) {
  test::expect_means(spheres(), make_clear_sphere, [](Density d) { return d == Density::kCosine; });
}

TEST(SphereSampler, SamplesAndInverseFollowTheDensity) {
  // Not the near one: it shows less of itself than the cells of the histogram are wide.
  std::vector<ShapeCase<Sphere>> some(spheres());
  some.erase(some.begin() + 4);
  some.push_back({"close", {{0.2, 0.1, -1.5}, 1}, {0, 0, 0}, {0, 0, -1}, -1});
  test::expect_densities(some, make_clear_sphere, sphere_area);
}

TEST(SphereSampler, BothFitsRejectAPlantedBias) {
  const ShapeCase<Sphere>& c = spheres()[1];
  const SphereSampler by_area(c.shape, c.x, c.n, Density::kArea);
  for (const Density d : {Density::kVisibleArea, Density::kCosine}) {
    const SphereSampler sampler(c.shape, c.x, c.n, d);
    EXPECT_LT(test::fit_of_samples(sampler, by_area, sphere_area(c.shape), c.x, test::kManyDraws, 0.02).odds,
              test::kFalseAlarm);
  }
  const SphereSampler visible(c.shape, c.x, c.n, Density::kVisibleArea);
  EXPECT_LT(test::fit_of_inverse(visible, by_area, sphere_area(c.shape), c.x, test::kManyDraws, 0.04),
            test::kFalseAlarm);
}

TEST(SphereSampler, ClosedFormIsTheSameForAllDensities) {
  for (const ShapeCase<Sphere>& c : spheres())
    for (const Density d : test::kDensities)
      EXPECT_NEAR(make_clear_sphere(c.shape, c.x, c.n.normalized(), d).irradiance() / c.irradiance, 1, 1e-12)
          << c.name;
}

TEST(SphereSampler, FarSpheresKeepTheirDigits) {
  // pi (R/d)^2 cos(theta) at 1e3, 1e6 and 1e9 radii, and cut in the middle by the horizon: 2/3 (R/d)^3 to
  // first order.
  for (const double d : {1e3, 1e6, 1e9}) {
    const Vec3 direction = Vec3(2, -1, 3).normalized();
    const Sphere sphere{d * direction, 1};
    const SphereSampler s(sphere, {0, 0, 0}, {0, 0, 1}, Density::kCosine);
    EXPECT_NEAR(s.irradiance() / (pi / (d * d) * direction.z()), 1, 1e-12);
    const auto stats = test::statistics(s, {0, 0, 0}, {0, 0, 1}, 1000);
    EXPECT_NEAR(stats.mean / s.irradiance(), 1, 1e-12);
    EXPECT_LT(stats.round_trip, 1e-15 * d + 1e-12);

    const Sphere level{{d, 0, 0}, 1};
    const SphereSampler cut(level, {0, 0, 0}, {0, 0, 1}, Density::kCosine);
    EXPECT_NEAR(cut.irradiance() * d * d * d, 2.0 / 3, 1e-6);
    EXPECT_TRUE(test::statistics(cut, {0, 0, 0}, {0, 0, 1}, 1000).finite);
  }
}

TEST(SphereSampler, TheWrongSideAndTheHorizonAreDark) {
  const Vec3 up(0, 0, 1);
  for (const Density d : test::kDensities) {
    EXPECT_FALSE(make_sphere({{0, 0, 0.1}, 1}, {0, 0, 0}, up, d).lights());      // inside an outward one
    EXPECT_FALSE(make_sphere({{0, 0, 3}, 1, true}, {0, 0, 0}, up, d).lights());  // outside an inward one
    EXPECT_FALSE(make_sphere({{0, 0, -1.01}, 1}, {0, 0, 0}, up, d).lights());    // below the horizon
    EXPECT_FALSE(make_sphere({{0, 0, 3}, 0}, {0, 0, 0}, up, d).lights());        // no size
    EXPECT_EQ(make_sphere({{0, 0, -1.01}, 1}, {0, 0, 0}, up, d).sample(0.5, 0.5).irradiance, 0);
  }
}

}  // namespace
}  // namespace reemit

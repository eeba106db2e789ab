#pragma once
#include <vector>

#include <gtest/gtest.h>

#include "tests/solver/sampling/shapes/shape_checks.h"

namespace reemit::test {

/// A shape and a place to look at it from.
template <class Shape>
struct ShapeCase {
  const char* name;
  Shape shape;
  Vec3 x;
  Vec3 n;             ///< Of any length.
  double irradiance;  ///< Per radiance [sr]; < 0: unknown.
};

/// Every density of every case: means within 4 standard errors of the truth (odds of a false alarm 1 in
/// 15,000 each, fixed seeds) or to 1e-9 where no variance is promised; round trips; the two ways to the
/// density; and weights that are cos / pdf. `make(shape, x, n, density)`; `no_variance(density)`.
template <class Shape, class Make, class NoVariance>
void expect_means(const std::vector<ShapeCase<Shape>>& cases, const Make& make,
                  const NoVariance& no_variance) {
  for (const ShapeCase<Shape>& c : cases) {
    const Vec3 n = c.n.normalized();
    for (const Density density : kDensities) {
      const auto sampler = make(c.shape, c.x, n, density);
      SCOPED_TRACE(std::string(c.name) + ", " + name_of(density));
      ASSERT_TRUE(sampler.lights());
      const SampleStatistics s = statistics(sampler, c.x, n, 50'000, 3);
      EXPECT_TRUE(s.finite);
      EXPECT_LT(s.round_trip, 1e-9);
      EXPECT_LT(s.pdf_mismatch, 1e-8);
      EXPECT_LT(s.weight_mismatch, 1e-9);
      if (c.irradiance < 0) continue;
      if (no_variance(sampler.density())) {
        EXPECT_NEAR(s.mean / c.irradiance, 1, 1e-9);
        EXPECT_LT(s.error / c.irradiance, 1e-9);
      } else {
        EXPECT_LT(std::fabs(s.mean - c.irradiance), 4 * s.error + 1e-12 * c.irradiance)
            << s.mean << " +- " << s.error << " against " << c.irradiance;
      }
    }
  }
}

/// Every density of every case by both chi-square tests, and the integral of the density by the midpoint
/// rule, which the edges of the drawn region blur by up to 1 %.
template <class Shape, class Make, class Area>
void expect_densities(const std::vector<ShapeCase<Shape>>& cases, const Make& make, const Area& area) {
  for (const ShapeCase<Shape>& c : cases) {
    const Vec3 n = c.n.normalized();
    const auto by_area = make(c.shape, c.x, n, Density::kArea);
    for (const Density density : kDensities) {
      SCOPED_TRACE(std::string(c.name) + ", " + name_of(density));
      const auto sampler = make(c.shape, c.x, n, density);
      const Fit fit = fit_of_samples(sampler, by_area, area(c.shape), c.x);
      EXPECT_GT(fit.odds, kFalseAlarm);
      EXPECT_NEAR(fit.integral, 1, 1.2e-2);
      EXPECT_GT(fit_of_inverse(sampler, by_area, area(c.shape), c.x), kFalseAlarm);
    }
  }
}

}  // namespace reemit::test

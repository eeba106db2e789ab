#include "solver/sampling/shapes/disk_sampler.h"

#include <cmath>
#include <numbers>

#include "tests/solver/sampling/shapes/shape_cases.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::ShapeCase;

DiskSampler make_disk(const Disk& s, const Vec3& x, const Vec3& n, Density d) {
  return {s, x, n, d};
}

/// Receiver parallel to the disk at height h, offset l: pi/2 [1 - (1 + H^2 - Q^2)/sqrt(Z^2 - 4 Q^2)], H =
/// h/l, Q = r/l, Z = 1 + H^2 + Q^2; on the axis pi r^2/(r^2 + h^2); tilted ones from the light vector, the
/// one that the horizon cuts by quadrature with 15 digits (Howell's catalogue).
const std::vector<ShapeCase<Disk>>& disks() {
  static const std::vector<ShapeCase<Disk>> all{
      {"on the axis", {{0, 0, 2}, {0, 0, -1}, 1}, {0, 0, 0}, {0, 0, 1}, 0.6283185307179586},
      {"beside", {{0, 0, 2}, {0, 0, -1}, 1}, {3, 0, 0}, {0, 0, 1}, 0.08060808692548144},
      {"below the disk", {{0, 0, 0.5}, {0, 0, -1}, 1}, {0.6, 0, 0}, {0, 0, 1}, 2.141537752466247},
      {"wall", {{0, 0, 2}, {0, 0, -1}, 0.5}, {1.5, 0.4, 0}, {-1, 0, 0}, 0.05538814979341622},
      {"tilted", {{0, 0, 2}, {0, 0, -1}, 0.5}, {1, 1, 0}, {-0.3, 0.2, 1}, 0.0859506364788354},
      {"cut by the horizon", {{0, 0, 1}, {0, 0, -1}, 1}, {0.4, 0, 0}, {1, 0, 0}, 0.12395909432783642},
  };
  return all;
}

double disk_area(const Disk& s) {
  return pi * s.radius * s.radius;
}

TEST(DiskSampler, MeansAreTheClosedForms) {
  test::expect_means(disks(), make_disk, [](Density) { return false; });
}

TEST(DiskSampler, SamplesAndInverseFollowTheDensity) {
  test::expect_densities(disks(), make_disk, disk_area);
}

TEST(DiskSampler, BothFitsRejectAPlantedBias) {
  const ShapeCase<Disk>& c = disks()[2];
  const DiskSampler by_area(c.shape, c.x, c.n, Density::kArea);
  const DiskSampler sampler(c.shape, c.x, c.n, Density::kCosine);
  EXPECT_LT(test::fit_of_samples(sampler, by_area, disk_area(c.shape), c.x, test::kManyDraws, 0.02).odds,
            test::kFalseAlarm);
  EXPECT_LT(test::fit_of_inverse(sampler, by_area, disk_area(c.shape), c.x, test::kManyDraws, 0.04),
            test::kFalseAlarm);
}

TEST(DiskSampler, ClosedFormIsTheSameForAllDensities) {
  for (const ShapeCase<Disk>& c : disks())
    for (const Density d : test::kDensities)
      EXPECT_NEAR(make_disk(c.shape, c.x, c.n.normalized(), d).irradiance() / c.irradiance, 1, 1e-12)
          << c.name;
}

TEST(DiskSampler, ClosedFormHoldsFarAwayAndNearTheAxis) {
  // The parallel-receiver formula in a form without cancellation: with s = sqrt((h^2 + (l+r)^2)(h^2 +
  // (l-r)^2)), 1 - (h^2 + l^2 - r^2)/s = 4 r^2 h^2 / (s (s + h^2 + l^2 - r^2)).
  for (const double h : {1e-3, 0.3, 1.0, 40.0, 1e3})
    for (const double l : {0.0, 1e-9, 1e-6, 1e-3, 0.9, 1.1, 30.0, 1e3}) {
      const double s = std::sqrt((h * h + (l + 1) * (l + 1)) * (h * h + (l - 1) * (l - 1)));
      const double k = h * h + l * l - 1;
      const double gap = k > 0 ? 4 * h * h / (s * (s + k)) : 1 - k / s;
      const DiskSampler disk({{0, 0, h}, {0, 0, -1}, 1}, {l, 0, 0}, {0, 0, 1}, Density::kArea);
      EXPECT_NEAR(disk.irradiance() / (pi / 2 * gap), 1, 1e-9) << h << " " << l;
    }
}

TEST(DiskSampler, NearlyProportionalDensitiesHaveLittleVariance) {
  // Relative standard deviation of one sample.
  for (const ShapeCase<Disk>& c : disks()) {
    const DiskSampler s = make_disk(c.shape, c.x, c.n.normalized(), Density::kCosine);
    const auto r = test::statistics(s, c.x, c.n.normalized(), 20'000);
    EXPECT_LT(r.error * std::sqrt(20'000) / c.irradiance, 0.15) << c.name;
  }
}

TEST(DiskSampler, TheBackTheHorizonAndThePlaneAreDark) {
  const Vec3 up(0, 0, 1);
  for (const Density d : test::kDensities) {
    EXPECT_FALSE(make_disk({{0, 0, 1}, {0, 0, 1}, 1}, {0, 0, 0}, up, d).lights());
    EXPECT_FALSE(make_disk({{0, 0, 1}, {0, 0, -1}, 1}, {0, 0, 0}, -up, d).lights());
    EXPECT_FALSE(make_disk({{3, 0, 0}, {0, 0, 1}, 1}, {0, 0, 0}, up, d).lights());
    EXPECT_FALSE(make_disk({{0, 0, 1}, {0, 0, -1}, 0}, {0, 0, 0}, up, d).lights());
  }
}

}  // namespace
}  // namespace reemit

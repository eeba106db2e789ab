#include "solver/sampling/warp.h"

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "solver/sampling/counter_rng.h"
#include "tests/support/chi_square.h"

namespace reemit {
namespace {

constexpr int kSamples = 1'500'000;

/// A mapping [0,1)^2 -> something with two coordinates in [0,1)^2 in which its density is known.
struct Row {
  const char* name;
  std::function<std::array<double, 2>(float, float)> sample;  ///< Coordinates in [0,1]^2.
  std::function<double(double, double)> cell_density;         ///< Density in those coordinates.
};

/// Probability that the samples of a row follow its density on a grid of cells.
double fit(const Row& row, double planted_bias = 0) {
  constexpr int kGrid = 8;
  std::vector<double> counts(kGrid * kGrid);
  std::vector<double> expected(kGrid * kGrid);
  const CounterRng rng(11, RngPurpose::kProbe);
  for (int i = 0; i < kSamples; ++i) {
    const auto u = rng.uniform4(static_cast<std::uint64_t>(i), 0, 0);
    auto c = row.sample(u[0], u[1]);
    c[0] = std::pow(c[0], 1 + planted_bias);
    const int a = std::min(kGrid - 1, static_cast<int>(c[0] * kGrid));
    const int b = std::min(kGrid - 1, static_cast<int>(c[1] * kGrid));
    counts[static_cast<std::size_t>(a * kGrid + b)] += 1;
  }
  constexpr int kSub = 32;  // midpoint rule inside each cell
  double total = 0;
  for (int a = 0; a < kGrid * kSub; ++a)
    for (int b = 0; b < kGrid * kSub; ++b) {
      const double d = row.cell_density((a + 0.5) / (kGrid * kSub), (b + 0.5) / (kGrid * kSub));
      expected[static_cast<std::size_t>(a / kSub * kGrid + b / kSub)] += d / (kGrid * kSub * kGrid * kSub);
      total += d / (kGrid * kSub * kGrid * kSub);
    }
  EXPECT_NEAR(total, 1, 2e-3) << row.name << ": the density does not integrate to 1";
  for (double& e : expected) e *= kSamples / total;
  return test::chi_square_of_counts(counts, expected);
}

double azimuth(const Vec3f& d) {
  const double phi = std::atan2(d.y(), d.x()) / (2 * std::numbers::pi);
  return phi < 0 ? phi + 1 : phi;
}

const std::vector<Row>& rows() {
  static const std::vector<Row> all{
      {"disk in (r^2, phi)",
       [](float u, float v) {
         const Point2 p = sample_disk(u, v);
         return std::array<double, 2>{p.x * p.x + p.y * p.y, azimuth({p.x, p.y, 0})};
       },
       [](double, double) { return 1.0; }},
      {"cosine hemisphere in (cos, phi)",
       [](float u, float v) {
         const Vec3f d = sample_cosine_hemisphere(u, v);
         return std::array<double, 2>{d.z(), azimuth(d)};
       },
       [](double z, double) {
         return 2 * std::numbers::pi * cosine_hemisphere_pdf_per_sr(static_cast<float>(z));
       }},
      {"triangle in (u, v)",
       [](float u, float v) {
         const auto p = sample_triangle(u, v);
         return std::array<double, 2>{p[0], p[1]};
       },
       [](double u, double v) { return u + v < 1 ? 2.0 : (u + v == 1 ? 1.0 : 0.0); }},
      {"sphere in ((1+z)/2, phi)",
       [](float u, float v) {
         const Vec3f d = sample_sphere(u, v);
         return std::array<double, 2>{(1 + d.z()) / 2, azimuth(d)};
       },
       [](double, double) { return 1.0; }},
      {"power of the cosine in (cos, phi)",
       [](float u, float v) {
         const Vec3f d = sample_cosine_power(u, v, 2.5F);
         return std::array<double, 2>{d.z(), azimuth(d)};
       },
       [](double z, double) { return 3.5 * std::pow(z, 2.5); }},
  };
  return all;
}

TEST(Warp, SamplesFollowTheirDensities) {
  for (const Row& row : rows()) EXPECT_GT(fit(row), test::kFalseAlarm) << row.name;
}

TEST(Warp, HarnessRejectsTwoPercentBias) {
  for (const Row& row : rows()) EXPECT_LT(fit(row, 0.02), test::kFalseAlarm) << row.name;
}

TEST(Warp, TheInverseReturnsTheUniformNumbers) {
  const CounterRng rng(3, RngPurpose::kProbe);
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const auto u = rng.uniform4(i, 0, 0);
    const Point2 d = sample_disk(u[0], u[1]);
    EXPECT_NEAR(invert_disk(d)[0], u[0], 1e-5);
    EXPECT_NEAR(invert_disk(d)[1], u[1], 1e-5);
  }
}

TEST(Warp, FramesAreOrthonormalInEveryDirection) {
  const CounterRng rng(5, RngPurpose::kProbe);
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const auto u = rng.uniform4(i, 0, 0);
    const Frame f(i == 0 ? Vec3f(0, 0, -1) : sample_sphere(u[0], u[1]));
    EXPECT_NEAR(f.tangent.norm(), 1, 1e-5);
    EXPECT_NEAR(f.tangent.dot(f.bitangent), 0, 1e-5);
    EXPECT_NEAR(f.tangent.cross(f.bitangent).dot(f.normal), 1, 1e-5);
    const Vec3f d(0.1F, 0.7F, -0.4F);
    EXPECT_LT((f.to_world(f.to_local(d)) - d).norm(), 1e-5);
  }
}

}  // namespace
}  // namespace reemit

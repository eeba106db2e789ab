#include "solver/emit/intensity_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "solver/sampling/counter_rng.h"
#include "tests/solver/emit/luminaire_tables.h"
#include "tests/support/chi_square.h"

namespace reemit {
namespace {

using std::numbers::pi;
constexpr PhotometricType kTypes[] = {PhotometricType::kA, PhotometricType::kB, PhotometricType::kC};

/// Counts of sampled directions in cells of polar angle and azimuth against midpoint integrals of the
/// intensity, each computed without the closed forms.
double fit(const IntensityTable& table, double power_of_u) {
  constexpr std::size_t kPolar = 24;
  constexpr std::size_t kAzimuth = 18;
  constexpr int kFine = 40;
  constexpr std::uint32_t kSamples = 200'000;
  const double first = table.azimuth().front();
  std::vector<double> expected(kPolar * kAzimuth, 0.0);
  for (std::size_t i = 0; i < kPolar * kFine; ++i)
    for (std::size_t j = 0; j < kAzimuth * kFine; ++j) {
      const double theta = pi * (static_cast<double>(i) + 0.5) / (kPolar * kFine);
      const double phi = first + 2 * pi * (static_cast<double>(j) + 0.5) / (kAzimuth * kFine);
      expected[i / kFine * kAzimuth + j / kFine] +=
          table.intensity(table.direction(theta, phi)) * std::sin(theta);
    }
  double total = 0;
  for (const double e : expected) total += e;
  for (double& e : expected) e *= kSamples / total;
  std::vector<double> counts(expected.size(), 0.0);
  const CounterRng rng(77, RngPurpose::kEmission);
  for (std::uint32_t k = 0; k < kSamples; ++k) {
    const auto u = rng.uniform4(k, 0, 0);
    const Vec3 d =
        sample_intensity(table, std::pow(static_cast<double>(u[0]), power_of_u), static_cast<double>(u[1]));
    double theta = 0;
    double phi = 0;
    table.angles(d, theta, phi);
    const auto i = std::min(static_cast<std::size_t>(theta / pi * kPolar), kPolar - 1);
    const auto j = std::min(static_cast<std::size_t>((phi - first) / (2 * pi) * kAzimuth), kAzimuth - 1);
    counts[i * kAzimuth + j] += 1;
  }
  return test::chi_square_of_counts(counts, expected);
}

TEST(IntensitySampler, directions_follow_the_intensities) {
  for (const PhotometricType type : kTypes) EXPECT_GT(fit(*test::lobed_table(type), 1), test::kFalseAlarm);
}

TEST(IntensitySampler, the_test_notices_a_skew_of_five_percent) {
  EXPECT_LT(fit(*test::lobed_table(), 1.05), test::kFalseAlarm);
}

TEST(IntensitySampler, density_integrates_to_one_and_is_the_intensity) {
  for (const PhotometricType type : kTypes) {
    const auto table = test::lobed_table(type);
    double sum = 0;
    constexpr int kSteps = 720;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) {
        const double theta = pi * (i + 0.5) / kSteps;
        const double phi = table->azimuth().front() + 2 * pi * (j + 0.5) / kSteps;
        sum += table->intensity(table->direction(theta, phi)) / table->total_flux() * std::sin(theta) * 2 *
               pi * pi / (kSteps * kSteps);
      }
    EXPECT_NEAR(sum, 1, 2e-4);
  }
}

/// The uniform numbers of a direction that has intensity, from the integrals of the table.
std::array<double, 2> invert_intensity(const IntensityTable& table, const Vec3& direction) {
  double theta = 0;
  double phi = 0;
  table.angles(direction, theta, phi);
  const std::vector<double>& polar = table.polar();
  const std::vector<double>& azimuth = table.azimuth();
  const auto cell_of = [](const std::vector<double>& lines, double x) {
    return static_cast<std::size_t>(std::upper_bound(lines.begin() + 1, lines.end() - 1, x) - lines.begin()) -
           1;
  };
  const std::size_t i = cell_of(polar, theta);
  const std::size_t last = azimuth.size() - 1;
  const double fa = table.azimuth_integral(last, i);
  const double share = std::clamp((theta - polar[i]) / (polar[i + 1] - polar[i]), 0.0, 1.0);
  const auto upto = [&](std::size_t k) {
    return (1 - share) * table.azimuth_integral(k, i) + share * table.azimuth_integral(k, i + 1);
  };
  const auto candela = [&](std::size_t k) {
    return (1 - share) * table.candela(k, i) + share * table.candela(k, i + 1);
  };
  const double flux = table.flux_below()[i] + integral_of_linear_times_sine(polar[i], theta, fa, upto(last));
  const std::size_t j = cell_of(azimuth, phi);
  const double t = std::clamp((phi - azimuth[j]) / (azimuth[j + 1] - azimuth[j]), 0.0, 1.0);
  const double f0 = candela(j);
  const double f1 = candela(j + 1);
  const double below = upto(j) + (azimuth[j + 1] - azimuth[j]) * t * (f0 + 0.5 * t * (f1 - f0));
  return {flux / table.total_flux(), below / upto(last)};
}

TEST(IntensitySampler, inverse_gives_the_numbers_back) {
  for (const PhotometricType type : kTypes) {
    const auto table = test::lobed_table(type);
    for (double u0 = 0.001; u0 < 1; u0 += 0.0373)
      for (double u1 = 0.002; u1 < 1; u1 += 0.0519) {
        const Vec3 d = sample_intensity(*table, u0, u1);
        EXPECT_NEAR(d.norm(), 1, 1e-14);
        EXPECT_GT(table->intensity(d), 0);
        const auto [v0, v1] = invert_intensity(*table, d);
        EXPECT_NEAR(v0, u0, 1e-9);
        EXPECT_NEAR(v1, u1, 1e-9);
      }
  }
}

TEST(IntensitySampler, lanes_do_not_know_of_each_other) {
  const auto table = test::lobed_table();
  const CounterRng rng(5, RngPurpose::kEmission);
  for (std::uint32_t block = 0; block < 100; ++block) {
    SquarePoints16 at;
    for (std::uint32_t lane = 0; lane < 16; ++lane) {
      const auto u = rng.uniform4(16 * block + lane, 0, 0);
      at.u0[lane] = static_cast<double>(u[0]);
      at.u1[lane] = static_cast<double>(u[1]);
    }
    Directions16 to;
    sample_intensity16(*table, at, to);
    for (int lane = 0; lane < 16; ++lane)
      EXPECT_EQ(to.direction(lane), sample_intensity(*table, at.u0[lane], at.u1[lane])) << lane;
  }
}

TEST(IntensitySampler, ends_of_the_unit_interval_give_directions_of_the_table) {
  const IntensityTable narrow(PhotometricType::kC, {0, 1e-3, 90}, {0, 360}, {1e6, 0, 0, 1e6, 0, 0});
  for (const double u : {0.0, 1e-30, 0.5, 1 - 0x1p-24, 1 - 0x1p-53}) {
    const Vec3 d = sample_intensity(narrow, u, u);
    EXPECT_TRUE(d.allFinite());
    EXPECT_LE(std::hypot(d.x(), d.y()), 1e-3 * pi / 180 * (1 + 1e-9));
  }
}

}  // namespace
}  // namespace reemit

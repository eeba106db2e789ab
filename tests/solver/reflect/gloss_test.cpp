// Lobes of rough surfaces against quadrature of their formulas and against themselves.

#include "solver/reflect/gloss.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "solver/sampling/counter_rng.h"
#include "solver/sampling/warp.h"
#include "tests/support/chi_square.h"

namespace reemit {
namespace {

constexpr std::array kLobes{GlossLobe::kGgx, GlossLobe::kWard, GlossLobe::kPhong};
constexpr std::array kRoughness{0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};

Vec3f direction_at(double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return Vec3(std::sin(angle), 0, std::cos(angle)).cast<float>();
}

/// Share of evenly arriving light that goes to `from`, by directions drawn from the lobe.
double albedo(const GlossModel& lobe, const Vec3f& from, int points = 1 << 18) {
  double sum = 0;
  for (int i = 0; i < points; ++i) {
    const double lattice = i * std::numbers::phi;
    Vec3f to;
    if (!lobe.sample(from, (static_cast<float>(i) + 0.5F) / static_cast<float>(points),
                     static_cast<float>(lattice - std::floor(lattice)), to))
      continue;
    const GlossValue v = lobe.value(from, to);
    sum += static_cast<double>(v.brdf_per_sr * to.z() / v.pdf_per_sr);
  }
  return sum / points;
}

TEST(Gloss, AlbedoIsThatOfTheFormulas) {
  // Quadrature about the mirror direction: at the normal and at 60 degrees, by lobe, for kRoughness.
  const double truth[][6] = {
      {0.99730, 0.99272, 0.99750, 0.99369, 1.00000, 0.50000},
      {0.98831, 0.96920, 0.99000, 0.97396, 1.00000, 0.50000},
      {0.94766, 0.89523, 0.96000, 0.89758, 1.00000, 0.50000},
      {0.87737, 0.82171, 0.91000, 0.81859, 1.00000, 0.50049},
      {0.78657, 0.75719, 0.84031, 0.75705, 1.00000, 0.50418},
      {0.68786, 0.69825, 0.75458, 0.70826, 1.00000, 0.51416},
      {0.59153, 0.64267, 0.66239, 0.66729, 1.00000, 0.53222},
      {0.50373, 0.58990, 0.57367, 0.63126, 1.00000, 0.56008},
      {0.42701, 0.54013, 0.49416, 0.59852, 1.00000, 0.60073},
      {0.36168, 0.49367, 0.42569, 0.56817, 1.00000, 0.66005},
      {0.30686, 0.45069, 0.36789, 0.53965, 1.00000, 0.75000},
  };
  for (std::size_t r = 0; r < kRoughness.size(); ++r)
    for (std::size_t k = 0; k < kLobes.size(); ++k) {
      const GlossModel lobe(kLobes[k], kRoughness[r]);
      EXPECT_NEAR(albedo(lobe, direction_at(0)), truth[r][2 * k], 1e-3)
          << "lobe " << k << ", " << kRoughness[r];
      EXPECT_NEAR(albedo(lobe, direction_at(60)), truth[r][2 * k + 1], 1e-3)
          << "lobe " << k << ", " << kRoughness[r];
    }
}

TEST(Gloss, NothingIsGained) {
  for (const GlossLobe l : kLobes)
    for (const double roughness : kRoughness)
      for (double angle = 5; angle < 90; angle += 12)
        EXPECT_LT(albedo(GlossModel(l, roughness), direction_at(angle), 1 << 16), 1.001)
            << roughness << " " << angle;
}

TEST(Gloss, IsTheSameSeenFromEitherEnd) {
  const CounterRng rng(3, RngPurpose::kSpecular);
  for (const GlossLobe l : kLobes)
    for (const double roughness : kRoughness)
      for (std::uint32_t i = 0; i < 200; ++i) {
        const auto u = rng.uniform4(i, 0, 0);
        const Vec3f a = sample_cosine_hemisphere(u[0], u[1]);
        const Vec3f b = sample_cosine_hemisphere(u[2], u[3]);
        const GlossModel lobe(l, roughness);
        const float there = lobe.value(a, b).brdf_per_sr;
        EXPECT_NEAR(there, lobe.value(b, a).brdf_per_sr, 1e-4F * there);
      }
}

/// Probability of directions as far from the density of `lobe` as those that `drawn` gives, in rings about
/// the mirror direction that are finer towards it.
double chi_square(const GlossModel& lobe, const GlossModel& drawn, const Vec3f& from) {
  constexpr std::size_t kRings = 20, kSectors = 16, kFine = 40;
  constexpr std::uint32_t kDraws = 200'000;
  constexpr double kHalfTurn = std::numbers::pi;
  const Frame frame(Vec3f(-from.x(), -from.y(), from.z()));
  std::vector<double> expected(kRings * kSectors + 1, 0.0);
  double seen = 0;
  const double cell = kHalfTurn / static_cast<double>(kRings * kFine);
  for (std::size_t i = 0; i < kRings * kFine; ++i)
    for (std::size_t j = 0; j < kSectors * kFine; ++j) {
      const double s = (static_cast<double>(i) + 0.5) / (kRings * kFine);
      const double theta = kHalfTurn * s * s * s;
      const double phi = 2 * kHalfTurn * (static_cast<double>(j) + 0.5) / (kSectors * kFine);
      const Vec3f to = frame.to_world(
          Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta))
              .cast<float>());
      const double share = static_cast<double>(lobe.value(from, to).pdf_per_sr) * std::sin(theta) * 3 * s *
                           s * cell * 2 * kHalfTurn / (kSectors * kFine);
      expected[i / kFine * kSectors + j / kFine] += kDraws * share;
      seen += share;
    }
  expected.back() = kDraws * std::max(0.0, 1 - seen);  // below the horizon
  std::vector<double> counts(expected.size(), 0.0);
  const CounterRng rng(11, RngPurpose::kSpecular);
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const auto u = rng.uniform4(i, 0, 0);
    Vec3f to;
    if (!drawn.sample(from, u[0], u[1], to)) {
      ++counts.back();
      continue;
    }
    const Vec3f local = frame.to_local(to);
    const auto z = static_cast<double>(std::min(1.0F, std::max(-1.0F, local.z())));
    const double s = std::cbrt(std::acos(z) / kHalfTurn);
    double phi = std::atan2(static_cast<double>(local.y()), static_cast<double>(local.x()));
    if (phi < 0) phi += 2 * kHalfTurn;
    const auto ring = std::min(kRings - 1, static_cast<std::size_t>(s * kRings));
    const auto sector = std::min(kSectors - 1, static_cast<std::size_t>(phi / (2 * kHalfTurn) * kSectors));
    ++counts[ring * kSectors + sector];
  }
  return test::chi_square_of_counts(counts, expected);
}

TEST(Gloss, DirectionsHaveTheStatedDensity) {
  for (const GlossLobe l : kLobes)
    for (const double roughness : kRoughness)
      for (const double angle : {0.0, 40.0, 75.0}) {
        const GlossModel lobe(l, roughness);
        EXPECT_GT(chi_square(lobe, lobe, direction_at(angle)), test::kFalseAlarm)
            << roughness << " " << angle;
      }
}

TEST(Gloss, ARoughnessThatIsOffByTwoPercentIsNoticed) {
  for (const GlossLobe l : kLobes)
    EXPECT_LT(chi_square(GlossModel(l, 0.3), GlossModel(l, 0.306), direction_at(40)), test::kFalseAlarm);
}

}  // namespace
}  // namespace reemit

#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "solver/sampling/counter_rng.h"
#include "solver/sampling/shapes/shape_density.h"
#include "tests/support/chi_square.h"

namespace reemit::test {

inline std::string name_of(Density d) {
  switch (d) {
    case Density::kArea:
      return "area";
    case Density::kVisibleArea:
      return "visible area";
    case Density::kSolidAngle:
      return "solid angle";
    case Density::kCosine:
      return "cosine";
  }
  return "";
}

inline constexpr std::array<Density, 4> kDensities{Density::kArea, Density::kVisibleArea,
                                                   Density::kSolidAngle, Density::kCosine};

/// Pairs in [0,1)^2 with 53 bits.
class Pairs {
 public:
  explicit Pairs(std::uint64_t seed) : rng_(seed, RngPurpose::kProbe) {}
  std::array<double, 2> operator()(std::uint64_t i) const {
    const auto b = rng_.bits4(i, 0, 0);
    const auto unit = [](std::uint32_t high, std::uint32_t low) {
      return static_cast<double>(((std::uint64_t{high} << 32) | low) >> 11) * 0x1p-53;
    };
    return {unit(b[0], b[1]), unit(b[2], b[3])};
  }

 private:
  CounterRng rng_;
};

/// What a number of samples say about a sampler.
struct SampleStatistics {
  double mean = 0;             ///< Of the irradiance.
  double error = 0;            ///< Standard error of the mean.
  double largest = 0;          ///< Largest irradiance.
  double round_trip = 0;       ///< Largest |invert(sample(u)) - u|.
  double pdf_mismatch = 0;     ///< Largest relative difference of the two ways to the density.
  double weight_mismatch = 0;  ///< Largest |irradiance pdf - cos| where something arrives.
  bool finite = true;
};

template <class Sampler>
SampleStatistics statistics(const Sampler& sampler, const Vec3& x, const Vec3& n, int count,
                            std::uint64_t seed = 1) {
  SampleStatistics r;
  const Pairs pairs(seed);
  double squares = 0;
  for (int i = 0; i < count; ++i) {
    const auto u = pairs(static_cast<std::uint64_t>(i));
    const ShapePoint s = sampler.sample(u[0], u[1]);
    r.finite = r.finite && s.point.allFinite() && s.normal.allFinite() && std::isfinite(s.pdf_per_sr) &&
               std::isfinite(s.irradiance) && std::isfinite(s.cos_emit) && s.irradiance >= 0 &&
               s.pdf_per_sr >= 0 && s.cos_emit >= 0;
    const double delta = s.irradiance - r.mean;
    r.mean += delta / (i + 1);
    squares += delta * (s.irradiance - r.mean);
    r.largest = std::max(r.largest, s.irradiance);
    if (!(s.pdf_per_sr > 0)) continue;
    const auto back = sampler.invert(s.point);
    r.round_trip = std::max({r.round_trip, std::fabs(back[0] - u[0]), std::fabs(back[1] - u[1])});
    const double pdf = sampler.pdf_per_sr(s.point);
    r.pdf_mismatch = std::max(r.pdf_mismatch, std::fabs(pdf - s.pdf_per_sr) / s.pdf_per_sr);
    if (s.irradiance > 0)
      r.weight_mismatch = std::max(
          r.weight_mismatch, std::fabs(s.irradiance * s.pdf_per_sr - n.dot((s.point - x).normalized())));
  }
  r.error = std::sqrt(squares / count / (count - 1.0));
  return r;
}

/// Density per area [1/m2] times the area of the shape, at the point u of a sampler that is uniform in area.
template <class Sampler>
double relative_density(const Sampler& sampler, const Sampler& by_area, double area, const Vec3& x,
                        const std::array<double, 2>& u) {
  const ShapePoint s = by_area.sample(u[0], u[1]);
  const double pdf = sampler.pdf_per_sr(s.point);
  return pdf > 0 ? pdf * s.cos_emit / (s.point - x).squaredNorm() * area : 0.0;
}

struct Fit {
  double odds;      ///< Of a deviation as large as the one seen, if the density is right.
  double integral;  ///< Of the density over the shape.
};

inline std::size_t cell_of(const std::array<double, 2>& u, int grid) {
  const int a = std::clamp(static_cast<int>(u[0] * grid), 0, grid - 1);
  const int b = std::clamp(static_cast<int>(u[1] * grid), 0, grid - 1);
  return static_cast<std::size_t>(a * grid + b);
}

/// Points drawn for a fit, and for a fit that has to see a planted bias.
inline constexpr int kDraws = 100'000;
inline constexpr int kManyDraws = 600'000;

/// Do points drawn follow the density? Histogram over the parameters of the area sampler against the midpoint
/// rule. `planted_bias`: first uniform number to the power 1 + bias.
template <class Sampler>
Fit fit_of_samples(const Sampler& sampler, const Sampler& by_area, double area, const Vec3& x,
                   int draws = kDraws, double planted_bias = 0) {
  constexpr int kGrid = 8;
  constexpr int kFine = 32;
  std::vector<double> expected(kGrid * kGrid);
  std::vector<double> counts(kGrid * kGrid);
  constexpr double kStep = 1.0 / (kGrid * kFine);
  double integral = 0;
  for (int i = 0; i < kGrid * kFine; ++i)
    for (int k = 0; k < kGrid * kFine; ++k) {
      const std::array<double, 2> u{(i + 0.5) * kStep, (k + 0.5) * kStep};
      const double share = relative_density(sampler, by_area, area, x, u) * kStep * kStep;
      expected[cell_of(u, kGrid)] += share;
      integral += share;
    }
  const Pairs pairs(7);
  double hits = 0;
  for (int i = 0; i < draws; ++i) {
    auto u = pairs(static_cast<std::uint64_t>(i));
    u[0] = std::pow(u[0], 1 + planted_bias);
    const ShapePoint s = sampler.sample(u[0], u[1]);
    if (!(s.pdf_per_sr > 0)) continue;  // on the far side of a shape drawn by area
    counts[cell_of(by_area.invert(s.point), kGrid)] += 1;
    hits += 1;
  }
  for (double& e : expected) e *= hits / integral;
  double drawn = 0;  // share of the unit square that is given to points with density
  for (int i = 0; i < kGrid * kFine; ++i)
    for (int k = 0; k < kGrid * kFine; ++k)
      if (sampler.sample((i + 0.5) * kStep, (k + 0.5) * kStep).pdf_per_sr > 0) drawn += kStep * kStep;
  return {chi_square_of_counts(counts, expected), integral / drawn};
}

/// Is invert() uniform over points that follow the density? They are area samples, thinned in proportion to
/// the density: no sample() of the density under test is involved, other than to find which of the unit
/// square it gives to points without density, such as those on the far side of a shape drawn by area.
template <class Sampler>
double fit_of_inverse(const Sampler& sampler, const Sampler& by_area, double area, const Vec3& x,
                      int draws = kDraws, double planted_bias = 0) {
  constexpr int kGrid = 8;
  constexpr int kFine = 24;
  std::vector<double> expected(kGrid * kGrid);
  double whole = 0;
  for (int i = 0; i < kGrid * kFine; ++i)
    for (int k = 0; k < kGrid * kFine; ++k) {
      const std::array<double, 2> u{(i + 0.5) / (kGrid * kFine), (k + 0.5) / (kGrid * kFine)};
      if (!(sampler.sample(u[0], u[1]).pdf_per_sr > 0)) continue;
      expected[cell_of(u, kGrid)] += 1;
      whole += 1;
    }
  const Pairs pairs(8);
  const Pairs thinning(9);
  std::vector<double> density(static_cast<std::size_t>(draws));
  for (int i = 0; i < draws; ++i)
    density[static_cast<std::size_t>(i)] =
        relative_density(sampler, by_area, area, x, pairs(static_cast<std::uint64_t>(i)));
  const double highest = *std::max_element(density.begin(), density.end());
  std::vector<double> counts(kGrid * kGrid);
  double kept = 0;
  for (int i = 0; i < draws; ++i) {
    if (thinning(static_cast<std::uint64_t>(i))[0] * highest >= density[static_cast<std::size_t>(i)])
      continue;
    const auto u = pairs(static_cast<std::uint64_t>(i));
    auto v = sampler.invert(by_area.sample(u[0], u[1]).point);
    v[0] = std::pow(v[0], 1 + planted_bias);
    counts[cell_of(v, kGrid)] += 1;
    kept += 1;
  }
  for (double& e : expected) e *= kept / whole;
  return chi_square_of_counts(counts, expected);
}

}  // namespace reemit::test

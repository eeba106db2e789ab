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

}  // namespace reemit::test

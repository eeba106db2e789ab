#pragma once
#include <cstdint>
#include <vector>

#include "solver/gather/direct_light.h"
#include "solver/trace/surface_point.h"

namespace reemit::bench {

/// Direct illuminance [lx] and its standard error at some points.
struct PointValues {
  std::vector<double> value;
  std::vector<double> standard_error;
};

/// The share of the mean that errors are compared with where there is next to no light.
inline constexpr double kErrorFloor = 0.01;

/// Long estimate from kScrambles independently scrambled Sobol' sequences of `samples` points in all; the
/// spread of the sequences is the error.
inline constexpr int kScrambles = 16;
PointValues reference_values(const DirectLight& light, const std::vector<SurfacePoint>& points,
                             const std::vector<float>& weights, int samples, std::uint64_t seed, int threads);

/// Means of independent samples; standard_error from their scatter.
PointValues sampled_values(const DirectLight& light, const std::vector<SurfacePoint>& points,
                           const std::vector<float>& weights, int samples, std::uint64_t seed, int threads);

/// sqrt(mean over points of ((E - R)/(R + f))^2), f = kErrorFloor times the mean of R.
double rms_relative_error(const PointValues& values, const PointValues& reference);
/// The same of the reference's own standard errors.
double rms_relative_error(const PointValues& reference);

/// sum(E - R)/sum(R): 0 but for chance, unless one of the two is biased.
double mean_difference(const PointValues& values, const PointValues& reference);

}  // namespace reemit::bench

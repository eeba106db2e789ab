#include "bench/many_luminaires/irradiance_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "solver/sampling/counter_rng.h"
#include "solver/sampling/sobol.h"

namespace reemit::bench {
namespace {

constexpr std::size_t kGrain = 16;  // points of one task

/// Fills values point by point from fn(index) -> {mean, standard error}.
template <class Fn>
PointValues for_each_point(std::size_t count, int threads, const Fn& fn) {
  PointValues values{std::vector<double>(count), std::vector<double>(count)};
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        const std::array<double, 2> found = fn(i);
        values.value[i] = found[0];
        values.standard_error[i] = found[1];
      }
    });
  });
  return values;
}

std::array<double, 2> mean_and_error(double sum, double sum_of_squares, int count) {
  const double mean = sum / count;
  const double scatter = std::max(0.0, sum_of_squares - count * mean * mean);
  return {mean, std::sqrt(scatter / (static_cast<double>(count) * (count - 1)))};
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

/// sqrt(mean over points of (off/(R + f))^2).
template <class Fn>
double rms_over_points(const PointValues& reference, const Fn& off) {
  const double floor = kErrorFloor * mean_of(reference.value);
  double sum = 0;
  for (std::size_t i = 0; i < reference.value.size(); ++i)
    sum += std::pow(off(i) / (reference.value[i] + floor), 2);
  return std::sqrt(sum / static_cast<double>(reference.value.size()));
}

}  // namespace

PointValues reference_values(const DirectLight& light, const std::vector<SurfacePoint>& points,
                             const std::vector<float>& weights, int samples, std::uint64_t seed,
                             int threads) {
  const CounterRng rng(seed, RngPurpose::kSampledDirect);
  const int each = samples / kScrambles;
  return for_each_point(points.size(), threads, [&](std::size_t p) {
    std::vector<double> irradiance(weights.size());
    double sum = 0;
    double sum_of_squares = 0;
    for (int s = 0; s < kScrambles; ++s) {
      const auto bits = rng.bits4(p, static_cast<std::uint32_t>(s), 0);
      const SobolSequence sequence((std::uint64_t{bits[0]} << 32) | bits[1]);
      std::fill(irradiance.begin(), irradiance.end(), 0.0);
      light.add_samples(points[p], sequence, 0, each, irradiance.data());
      double lux = 0;
      for (std::size_t b = 0; b < weights.size(); ++b)
        lux += static_cast<double>(weights[b]) * irradiance[b] / each;
      sum += lux;
      sum_of_squares += lux * lux;
    }
    return mean_and_error(sum, sum_of_squares, kScrambles);
  });
}

PointValues sampled_values(const DirectLight& light, const std::vector<SurfacePoint>& points,
                           const std::vector<float>& weights, int samples, std::uint64_t seed, int threads) {
  static_assert(DirectLight::kDimensions <= 4);
  const CounterRng rng(seed, RngPurpose::kSampledDirect);
  return for_each_point(points.size(), threads, [&](std::size_t p) {
    std::vector<float> parts(weights.size());
    double sum = 0;
    double sum_of_squares = 0;
    for (int s = 0; s < samples; ++s) {
      const std::array<float, 4> u = rng.uniform4(p, kScrambles, static_cast<std::uint32_t>(s));
      std::array<float, DirectLight::kDimensions> used;
      for (std::size_t k = 0; k < used.size(); ++k) used[k] = u[k];
      std::fill(parts.begin(), parts.end(), 0.0F);
      light.add_sample(points[p], used, weights.data(), parts.data());
      double lux = 0;
      for (const float part : parts) lux += static_cast<double>(part);
      sum += lux;
      sum_of_squares += lux * lux;
    }
    return mean_and_error(sum, sum_of_squares, samples);
  });
}

double rms_relative_error(const PointValues& values, const PointValues& reference) {
  return rms_over_points(reference, [&](std::size_t i) { return values.value[i] - reference.value[i]; });
}

double rms_relative_error(const PointValues& reference) {
  return rms_over_points(reference, [&](std::size_t i) { return reference.standard_error[i]; });
}

double mean_difference(const PointValues& values, const PointValues& reference) {
  return mean_of(values.value) / mean_of(reference.value) - 1;
}

}  // namespace reemit::bench

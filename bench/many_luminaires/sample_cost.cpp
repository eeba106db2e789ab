#include "bench/many_luminaires/sample_cost.h"

#include <array>
#include <cmath>
#include <ctime>
#include <stdexcept>

#include "solver/sampling/counter_rng.h"

namespace reemit::bench {
namespace {

using Uniform = std::array<float, DirectLight::kDimensions>;
constexpr std::size_t kUniforms = 4096;  // used again and again; as many as stay in a cache

std::vector<Uniform> uniform_numbers() {
  static_assert(DirectLight::kDimensions <= 4);
  const CounterRng rng(1, RngPurpose::kProbe);
  std::vector<Uniform> numbers(kUniforms);
  for (std::size_t i = 0; i < kUniforms; ++i) {
    const std::array<float, 4> u = rng.uniform4(i, 0, 0);
    for (std::size_t k = 0; k < numbers[i].size(); ++k) numbers[i][k] = u[k];
  }
  return numbers;
}

double thread_seconds() {
  std::timespec now{};
  if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now) != 0) throw std::runtime_error("no clock of the thread");
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double nanoseconds_per_sample(const Candidate& c, const std::vector<Uniform>& numbers) {
  const std::vector<float> weight(c.light->band_count(), 1.0F);
  std::vector<float> sum(c.light->band_count(), 0.0F);
  std::size_t next = 0;
  const double start = thread_seconds();
  for (const SurfacePoint& x : *c.points)
    for (int i = 0; i < c.samples; ++i)
      c.light->add_sample(x, numbers[next++ % kUniforms], weight.data(), sum.data());
  const double seconds = thread_seconds() - start;
  if (!std::isfinite(sum[0])) throw std::runtime_error("irradiance is not finite");
  return 1e9 * seconds / static_cast<double>(next);
}

}  // namespace

std::vector<std::vector<double>> sample_times_ns(const std::vector<Candidate>& candidates, int rounds) {
  const std::vector<Uniform> numbers = uniform_numbers();
  std::vector<std::vector<double>> times(candidates.size());
  for (int round = -1; round < rounds; ++round)  // the first one warms up
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const double ns = nanoseconds_per_sample(candidates[i], numbers);
      if (round >= 0) times[i].push_back(ns);
    }
  return times;
}

std::vector<double> ratios(const std::vector<double>& upper, const std::vector<double>& lower) {
  std::vector<double> quotients;
  for (std::size_t i = 0; i < upper.size(); ++i) quotients.push_back(upper[i] / lower[i]);
  return quotients;
}

}  // namespace reemit::bench

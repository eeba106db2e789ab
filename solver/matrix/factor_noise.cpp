#include "solver/matrix/factor_noise.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <tbb/parallel_for.h>

#include "solver/matrix/zone_points.h"

namespace reemit {
namespace {

/// Normal deviates of one pair [BM58], two from each two numbers.
void normal_deviates(const CounterRng& rng, std::uint64_t pair, std::vector<double>& deviates) {
  constexpr double kUnit = 0x1p-32;
  for (std::size_t k = 0; k < deviates.size(); k += 4) {
    const auto bits =
        rng.bits4(pair, static_cast<std::uint32_t>(MatrixNumbers::kNoise), static_cast<std::uint32_t>(k));
    for (std::size_t half = 0; half < 2; ++half) {
      const double radius = std::sqrt(-2 * std::log(kUnit * (bits[2 * half] + 0.5)));
      const double angle = 2 * std::numbers::pi * kUnit * bits[2 * half + 1];
      const std::size_t at = k + 2 * half;
      if (at < deviates.size()) deviates[at] = radius * std::cos(angle);
      if (at + 1 < deviates.size()) deviates[at + 1] = radius * std::sin(angle);
    }
  }
}

}  // namespace

RowMatrix factor_noise(const FormFactors& factors, const RowMatrix& radiosity, std::size_t replicates,
                       double spread, std::uint64_t seed) {
  constexpr std::size_t kParts = 16;
  const std::size_t zones = factors.zones();
  const auto n = static_cast<Eigen::Index>(zones);
  const auto copies = static_cast<Eigen::Index>(replicates);
  const SymmetricTable<float>& variance = factors.relative_variance();
  const CounterRng rng(seed, RngPurpose::kFormFactor);
  std::array<RowMatrix, kParts> sums;
  // Parts take every sixteenth row and are added in order: the same bits on any number of threads.
  tbb::parallel_for(std::size_t{0}, kParts, [&](std::size_t part) {
    RowMatrix& sum = sums[part];
    sum = RowMatrix::Zero(n, radiosity.cols() * copies);
    std::vector<double> deviates(replicates);
    for (std::size_t i = part; i + 1 < zones; i += kParts) {
      const float* row = variance.row(i);
      for (std::size_t k = 0; k < variance.row_length(i); ++k) {
        if (!(row[k] > 0)) continue;
        const std::size_t j = i + 1 + k;
        const double area_i = factors.zone_area(i);
        const double area_j = factors.zone_area(j);
        const double error = spread * std::sqrt(static_cast<double>(row[k]) * area_i * area_j);
        normal_deviates(rng, i * zones + j, deviates);
        const Eigen::Map<const Eigen::RowVectorXd> deviate(deviates.data(), copies);
        for (Eigen::Index b = 0; b < radiosity.cols(); ++b) {
          const auto a = static_cast<Eigen::Index>(i);
          const auto c = static_cast<Eigen::Index>(j);
          sum.row(a).segment(b * copies, copies) += error / area_i * radiosity(c, b) * deviate;
          sum.row(c).segment(b * copies, copies) += error / area_j * radiosity(a, b) * deviate;
        }
      }
    }
  });
  for (std::size_t part = 1; part < kParts; ++part) sums[0] += sums[part];
  return std::move(sums[0]);
}

}  // namespace reemit

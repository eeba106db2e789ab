#include "bench/convergence/curve.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace reemit::bench {
namespace {

constexpr double kBelievedShare = 0.5;
/// Exponent of the work below which the last two points fall like noise that nothing stays of.
constexpr double kOfNoise = -0.45;

bool still_falls_like_noise(const std::vector<CurvePoint>& curve) {
  const CurvePoint& before = curve[curve.size() - 2];
  const CurvePoint& last = curve.back();
  return std::log(last.error / before.error) < kOfNoise * std::log(last.work / before.work);
}

double log_log_time(const CurvePoint& before, const CurvePoint& after, double error) {
  const double share = std::log(before.error / error) / std::log(before.error / after.error);
  return before.seconds * std::pow(after.seconds / before.seconds, share);
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  if (values.empty()) throw std::invalid_argument("no values to take a median of");
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
  return {median, values.front(), values.back()};
}

double remaining_error(const std::vector<CurvePoint>& curve) {
  // Least squares of (left^2 + c/work)/e^2 = 1 over the points.
  double aa = 0;
  double ab = 0;
  double bb = 0;
  double a1 = 0;
  double b1 = 0;
  for (const CurvePoint& p : curve) {
    const double a = 1 / (p.error * p.error);
    const double b = a / p.work;
    aa += a * a;
    ab += a * b;
    bb += b * b;
    a1 += a;
    b1 += b;
  }
  const double determinant = aa * bb - ab * ab;
  if (curve.size() < 2 || determinant <= 1e-12 * aa * bb || still_falls_like_noise(curve)) return 0;
  const double left2 = (a1 * bb - b1 * ab) / determinant;
  const double left = std::sqrt(std::max(0.0, left2));
  // No more can stay than was left at the best point; a little may be the chance of a few runs.
  const auto best = std::min_element(curve.begin(), curve.end(),
                                     [](const auto& a, const auto& b) { return a.error < b.error; });
  return left > kBelievedShare * best->error ? std::min(left, best->error) : 0;
}

TimeToError time_to_error(const std::vector<CurvePoint>& curve, double error) {
  if (curve.empty()) throw std::invalid_argument("no points on the curve");
  if (curve.front().error <= error) return {Reach::kAtMost, curve.front().seconds};
  for (std::size_t i = 1; i < curve.size(); ++i)
    if (curve[i].error <= error) return {Reach::kMeasured, log_log_time(curve[i - 1], curve[i], error)};
  const double left2 = std::pow(remaining_error(curve), 2);
  const CurvePoint& last = curve.back();
  const double noise2 = last.error * last.error - left2;
  const double allowed2 = error * error - left2;
  if (allowed2 <= 0 || noise2 <= 0) return {};
  return {Reach::kExtrapolated, last.seconds * noise2 / allowed2};
}

std::optional<double> convergence_rate(const std::vector<CurvePoint>& curve) {
  double x_mean = 0;
  double y_mean = 0;
  const auto n = static_cast<double>(curve.size());
  for (const CurvePoint& p : curve) {
    x_mean += std::log(p.work) / n;
    y_mean += std::log(p.error) / n;
  }
  double xx = 0;
  double xy = 0;
  for (const CurvePoint& p : curve) {
    const double x = std::log(p.work) - x_mean;
    xx += x * x;
    xy += x * (std::log(p.error) - y_mean);
  }
  if (curve.size() < 2 || xx <= 1e-12) return std::nullopt;
  return xy / xx;
}

std::optional<double> without_reference(double measured, double reference) {
  if (!(measured > 0) || 2 * reference > measured) return std::nullopt;
  return std::sqrt(measured * measured - reference * reference);
}

}  // namespace reemit::bench

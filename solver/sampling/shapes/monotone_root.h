#pragma once
#include <algorithm>
#include <cmath>

namespace reemit {

struct ValueAndSlope {
  double value, slope;
};

/// t in [0, end] where an increasing function f with f(0) = 0, given with its derivative, takes the value
/// `target`: Newton steps, halving of the bracket where a step leaves it. Stops where a step is below 1e-13
/// of `end`. The first guess takes the derivative for linear between its values at the ends.
template <class F>
double monotone_root(const F& f, double target, double total, double end, double slope0, double slope1) {
  if (!(target > 0)) return 0;
  if (!(target < total)) return end;
  // slope0 t + (slope1 - slope0) t^2 / 2 for t in units of `end`, scaled to end at 1.
  const double sum = slope0 + slope1;
  const double s0 = sum > 0 ? std::max(0.0, slope0) / sum : 0.5;
  const double share = target / total;
  double t = end * share / (s0 + std::sqrt(std::max(0.0, s0 * s0 + (1 - 2 * s0) * share)));
  double low = 0;
  double high = end;
  constexpr int kMostSteps = 80;
  for (int step = 0; step < kMostSteps; ++step) {
    if (!(t > low && t < high)) t = 0.5 * (low + high);
    const ValueAndSlope v = f(t);
    const double miss = v.value - target;
    (miss > 0 ? high : low) = t;
    const double newton = v.slope > 0 ? t - miss / v.slope : low;
    const bool inside = newton > low && newton < high;
    const double moved = std::fabs(newton - t);
    t = inside ? newton : 0.5 * (low + high);
    if (inside ? !(moved > 1e-7 * end) : !(high - low > 1e-14 * end)) break;
  }
  return t;
}

}  // namespace reemit

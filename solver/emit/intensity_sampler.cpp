#include "solver/emit/intensity_sampler.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/sampling/small_angle.h"

namespace reemit {
namespace {

/// A linear function times the sine over a cell of polar angles.
struct PolarCell {
  double width;         ///< [rad]
  double sine, cosine;  ///< Where it begins.
  double end_sine;
  double f, end_f;  ///< The linear function where it begins and ends.
};

/// The share of the width below which `share` of the integral lies, about: the integrand is taken as linear
/// between the ends of the cell, which costs one root.
double guess_polar(const PolarCell& c, double share) {
  const double begin = c.f * c.sine;
  const double end = c.end_f * c.end_sine;
  const double root = std::sqrt(std::max(0.0, begin * begin + share * (end * end - begin * begin)));
  return begin + root > 0 ? share * (begin + end) / (begin + root) : share;
}

/// Angle from where the cell begins [rad] at which the integral reaches `wanted` of `whole`. Newton steps
/// that leave the bracket are replaced by its middle; each squares the error, so the last one leaves some
/// 1e-8 of the width or less.
double invert_polar(const PolarCell& c, double wanted, double whole) {
  constexpr int kMostSteps = 60;
  constexpr double kEnough = 1e-4;
  const double slope = (c.end_f - c.f) / c.width;
  double low = 0;
  double high = c.width;
  double x = c.width * guess_polar(c, whole > 0 ? std::clamp(wanted / whole, 0.0, 1.0) : 0.5);
  for (int step = 0; step < kMostSteps; ++step) {
    const auto [s, versine] = sine_and_versine(x);
    const double cos_x = 1 - versine;
    // The integrals of sin(a + x) and of x sin(a + x), about a.
    const double constant = c.cosine * versine + c.sine * s;
    const double linear = c.cosine * (s - x * cos_x) + c.sine * (x * s - versine);
    const double excess = c.f * constant + slope * linear - wanted;
    (excess > 0 ? high : low) = x;
    const double density = (c.f + slope * x) * (c.sine * cos_x + c.cosine * s);
    double next = density > 0 ? x - excess / density : low;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double moved = std::fabs(next - x);
    x = next;
    if (moved <= kEnough * c.width) break;
  }
  return x;
}

/// The azimuth line integrals at a polar angle between two grid lines.
struct Ring {
  const IntensityTable& table;
  std::size_t cell;
  double share;

  double upto(std::size_t j) const {
    return (1 - share) * table.azimuth_integral(j, cell) + share * table.azimuth_integral(j, cell + 1);
  }
  double candela(std::size_t j) const {
    return (1 - share) * table.candela(j, cell) + share * table.candela(j, cell + 1);
  }
};

double sample_azimuth(const Ring& ring, double u) {
  const std::vector<double>& lines = ring.table.azimuth();
  const std::size_t last = lines.size() - 1;
  const double wanted = u * ring.upto(last);
  std::size_t low = 0;
  std::size_t high = last;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    const bool is_below = ring.upto(middle) <= wanted;
    low = is_below ? middle : low;
    high = is_below ? high : middle;
  }
  const double width = lines[low + 1] - lines[low];
  const double f0 = ring.candela(low);
  const double f1 = ring.candela(low + 1);
  // Solves f0 t + (f1 - f0) t^2 / 2 = rest for t in [0,1]; the form that does not cancel.
  const double rest = std::max(0.0, (wanted - ring.upto(low)) / width);
  const double root = std::sqrt(std::max(0.0, f0 * f0 + 2 * (f1 - f0) * rest));
  const double t = f0 + root > 0 ? 2 * rest / (f0 + root) : 0.5;
  return lines[low] + std::clamp(t, 0.0, 1.0) * width;
}

}  // namespace

Vec3 sample_intensity(const IntensityTable& table, double u0, double u1) {
  const std::vector<double>& lines = table.polar();
  const std::size_t last_azimuth = table.azimuth().size() - 1;
  const double wanted = u0 * table.total_flux();
  std::size_t low = 0;
  std::size_t high = lines.size() - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    // Which half it is nothing could predict: written so that it becomes no branch.
    const bool is_below = table.flux_below(middle) <= wanted;
    low = is_below ? middle : low;
    high = is_below ? high : middle;
  }
  const double width = lines[low + 1] - lines[low];
  const PolarCell cell{width,
                       table.polar_sine(low),
                       table.polar_cosine(low),
                       table.polar_sine(low + 1),
                       table.azimuth_integral(last_azimuth, low),
                       table.azimuth_integral(last_azimuth, low + 1)};
  const double below = table.flux_below(low);
  const double angle = invert_polar(cell, wanted - below, table.flux_below(low + 1) - below);
  const double share = std::clamp(angle / width, 0.0, 1.0);
  const auto [s, versine] = sine_and_versine(angle);
  const double cos_x = 1 - versine;
  return table.direction(cell.sine * cos_x + cell.cosine * s, cell.cosine * cos_x - cell.sine * s,
                         sample_azimuth({table, low, share}, u1));
}

}  // namespace reemit

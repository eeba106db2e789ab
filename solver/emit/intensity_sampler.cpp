#include "solver/emit/intensity_sampler.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace reemit {
namespace {

/// Where in [a,b] the integral of a linear function times the sine reaches `wanted`. Newton steps that leave
/// the bracket are replaced by its middle.
double invert_polar(double a, double b, double fa, double fb, double wanted) {
  constexpr int kMostSteps = 60;
  constexpr double kEnough = 4e-16;
  const double slope = (fb - fa) / (b - a);
  double low = a;
  double high = b;
  double x = 0.5 * (a + b);
  for (int step = 0; step < kMostSteps; ++step) {
    const double fx = fa + slope * (x - a);
    const double excess = integral_of_linear_times_sine(a, x, fa, fx) - wanted;
    (excess > 0 ? high : low) = x;
    const double density = fx * std::sin(x);
    double next = density > 0 ? x - excess / density : low;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double moved = std::fabs(next - x);
    x = next;
    if (moved <= kEnough * b) break;
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
    (ring.upto(middle) <= wanted ? low : high) = middle;
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
    (table.flux_below(middle) <= wanted ? low : high) = middle;
  }
  const double theta =
      invert_polar(lines[low], lines[low + 1], table.azimuth_integral(last_azimuth, low),
                   table.azimuth_integral(last_azimuth, low + 1), wanted - table.flux_below(low));
  const double share = std::clamp((theta - lines[low]) / (lines[low + 1] - lines[low]), 0.0, 1.0);
  return table.direction(theta, sample_azimuth({table, low, share}, u1));
}

double intensity_pdf_per_sr(const IntensityTable& table, const Vec3& direction) {
  return table.intensity(direction) / table.total_flux();
}

std::array<double, 2> invert_intensity(const IntensityTable& table, const Vec3& direction) {
  double theta = 0;
  double phi = 0;
  table.angles(direction, theta, phi);
  const std::vector<double>& polar = table.polar();
  const std::vector<double>& azimuth = table.azimuth();
  const auto cell_of = [](const std::vector<double>& lines, double x) {
    return static_cast<std::size_t>(std::upper_bound(lines.begin() + 1, lines.end() - 1, x) - lines.begin()) -
           1;
  };
  const std::size_t i = cell_of(polar, theta);
  const std::size_t last = azimuth.size() - 1;
  const double fa = table.azimuth_integral(last, i);
  const double share = std::clamp((theta - polar[i]) / (polar[i + 1] - polar[i]), 0.0, 1.0);
  const Ring ring{table, i, share};
  const double flux =
      table.flux_below(i) + integral_of_linear_times_sine(polar[i], theta, fa, ring.upto(last));
  const std::size_t j = cell_of(azimuth, phi);
  const double t = std::clamp((phi - azimuth[j]) / (azimuth[j + 1] - azimuth[j]), 0.0, 1.0);
  const double f0 = ring.candela(j);
  const double f1 = ring.candela(j + 1);
  const double below = ring.upto(j) + (azimuth[j + 1] - azimuth[j]) * t * (f0 + 0.5 * t * (f1 - f0));
  return {flux / table.total_flux(), below / ring.upto(last)};
}

}  // namespace reemit

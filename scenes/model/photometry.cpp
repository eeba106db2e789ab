#include "scenes/model/photometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace reemit {
namespace {

using std::numbers::pi;

/// Directions that rounding puts beyond the grid by less than this are on its edge [rad].
constexpr double kAngleSlack = 1e-9;

std::vector<double> radians(const std::vector<double>& degrees) {
  std::vector<double> result(degrees.size());
  std::transform(degrees.begin(), degrees.end(), result.begin(), [](double d) { return d * (pi / 180); });
  return result;
}

void demand(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

void check_grid(const std::vector<double>& lines) {
  demand(lines.size() >= 2, "an intensity table needs two angles or more");
  for (std::size_t i = 0; i < lines.size(); ++i)
    demand(std::isfinite(lines[i]) && (i == 0 || lines[i] > lines[i - 1]),
           "the angles of an intensity table must increase");
}

/// Interval of the grid that holds `angle`, and how far into it [0,1]; false beyond the grid.
bool locate(const std::vector<double>& lines, double angle, std::size_t& cell, double& share) {
  if (!(angle >= lines.front() - kAngleSlack && angle <= lines.back() + kAngleSlack)) return false;
  const auto above = std::upper_bound(lines.begin() + 1, lines.end() - 1, angle);
  cell = static_cast<std::size_t>(above - lines.begin()) - 1;
  share = std::clamp((angle - lines[cell]) / (lines[cell + 1] - lines[cell]), 0.0, 1.0);
  return true;
}

using PlanePoint = std::array<double, 2>;

/// The octahedron |x| + |y| + |z| = 1 as a square: the upper half in the middle, each lower face folded out
/// over its edge [PBRT4 3.8.3].
PlanePoint unfolded(const Vec3& direction) {
  const Vec3 p = direction / direction.lpNorm<1>();
  if (p.z() >= 0) return {p.x(), p.y()};
  return {std::copysign(1 - std::fabs(p.y()), p.x()), std::copysign(1 - std::fabs(p.x()), p.y())};
}

Vec3 folded(const PlanePoint& p) {
  const auto [x, y] = p;
  const double z = 1 - std::fabs(x) - std::fabs(y);
  if (z >= 0) return {x, y, z};
  return {std::copysign(1 - std::fabs(y), x), std::copysign(1 - std::fabs(x), y), z};
}

}  // namespace

GoniometerAxes goniometer_axes(PhotometricType type) {
  const Vec3 nadir = -Vec3::UnitZ();
  switch (type) {
    case PhotometricType::kA:
      return {nadir, Vec3::UnitX(), -Vec3::UnitY()};
    case PhotometricType::kB:
      return {Vec3::UnitY(), nadir, Vec3::UnitX()};
    case PhotometricType::kC:
      break;
  }
  return {nadir, Vec3::UnitX(), Vec3::UnitY()};
}

double integral_of_linear_times_sine(double a, double b, double fa, double fb) {
  const double middle = 0.5 * (a + b);
  const double half = 0.5 * (b - a);
  if (!(half > 0)) return 0;
  // About the middle: the even part of f meets 2 sin(m) sin(h), the odd part 2 cos(m) (sin(h) - h cos(h)),
  // whose difference would cancel for small h.
  constexpr double kSeries = 0.05;
  const double h2 = half * half;
  const double odd = half < kSeries ? half * h2 * (1.0 / 3 - h2 * (1.0 / 30 - h2 * (1.0 / 840 - h2 / 45360)))
                                    : std::sin(half) - half * std::cos(half);
  return (fa + fb) * std::sin(middle) * std::sin(half) + (fb - fa) / half * std::cos(middle) * odd;
}

IntensityTable::IntensityTable(PhotometricType type, const std::vector<double>& polar_deg,
                               const std::vector<double>& azimuth_deg, std::vector<double> candela)
    : type_(type),
      axes_(goniometer_axes(type)),
      polar_(radians(polar_deg)),
      azimuth_(radians(azimuth_deg)),
      candela_(std::move(candela)) {
  check_grid(polar_deg);
  check_grid(azimuth_deg);
  demand(polar_deg.front() >= 0 && polar_deg.back() <= 180, "polar angles must lie in [0, 180] degrees");
  const double turn = azimuth_deg.back() - azimuth_deg.front();
  demand(turn <= 360, "azimuths must lie in one turn");
  const std::size_t lines = polar_.size();
  demand(candela_.size() == lines * azimuth_.size(), "one intensity per pair of angles is needed");
  for (const double value : candela_) {
    demand(std::isfinite(value) && value >= 0, "intensities must be finite and not negative");
    greatest_ = std::max(greatest_, value);
  }
  for (const double polar : polar_) {
    polar_sine_.push_back(std::sin(polar));
    polar_cosine_.push_back(std::cos(polar));
  }
  azimuth_integral_.assign(candela_.size(), 0);
  for (std::size_t j = 1; j < azimuth_.size(); ++j)
    for (std::size_t i = 0; i < lines; ++i)
      azimuth_integral_[j * lines + i] =
          azimuth_integral_[(j - 1) * lines + i] +
          0.5 * (azimuth_[j] - azimuth_[j - 1]) * (this->candela(j - 1, i) + this->candela(j, i));
  flux_below_.assign(lines, 0);
  const std::size_t last = azimuth_.size() - 1;
  for (std::size_t i = 1; i < lines; ++i)
    flux_below_[i] = flux_below_[i - 1] + integral_of_linear_times_sine(polar_[i - 1], polar_[i],
                                                                        azimuth_integral(last, i - 1),
                                                                        azimuth_integral(last, i));
  demand(total_flux() > 0 && std::isfinite(total_flux()), "an intensity table must have some flux");
  fill_rough_cells();
}

std::size_t IntensityTable::rough_cell(const Vec3& direction) {
  const auto [x, y] = unfolded(direction);
  const auto cell = [](double at) {
    return static_cast<std::size_t>(std::clamp(0.5 * (at + 1) * kRoughCells, 0.0, kRoughCells - 1.0));
  };
  return cell(y) * kRoughCells + cell(x);
}

void IntensityTable::fill_rough_cells() {
  constexpr int kPoints = 4;  // of a cell, along each side
  constexpr int kSteps = kRoughCells * kPoints;
  rough_.assign(std::size_t{kRoughCells} * kRoughCells, 0.0F);
  for (int j = 0; j < kSteps; ++j)
    for (int i = 0; i < kSteps; ++i) {
      const auto at = [](int step) { return 2 * (step + 0.5) / kSteps - 1; };
      const Vec3 direction = folded({at(i), at(j)});
      rough_[rough_cell(direction)] += static_cast<float>(intensity(direction) / (kPoints * kPoints));
    }
}

void IntensityTable::angles(const Vec3& direction, double& polar, double& azimuth) const {
  const double along = direction.dot(axes_.pole);
  const double x = direction.dot(axes_.zero);
  const double y = direction.dot(axes_.ninety);
  polar = std::atan2(std::sqrt(x * x + y * y), along);
  azimuth = std::atan2(y, x);
  while (azimuth < azimuth_.front() - kAngleSlack) azimuth += 2 * pi;
  while (azimuth >= azimuth_.front() - kAngleSlack + 2 * pi) azimuth -= 2 * pi;
}

double IntensityTable::intensity(const Vec3& direction) const {
  double theta = 0;
  double phi = 0;
  angles(direction, theta, phi);
  std::size_t i = 0;
  std::size_t j = 0;
  double s = 0;
  double t = 0;
  if (!locate(polar_, theta, i, s) || !locate(azimuth_, phi, j, t)) return 0;
  const double before = (1 - s) * candela(j, i) + s * candela(j, i + 1);
  const double after = (1 - s) * candela(j + 1, i) + s * candela(j + 1, i + 1);
  return (1 - t) * before + t * after;
}

}  // namespace reemit

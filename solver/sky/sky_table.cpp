#include "solver/sky/sky_table.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace reemit {
namespace {

using std::numbers::pi;
constexpr std::size_t kRows = 180;
constexpr std::size_t kColumns = 360;
/// Where radiance does not depend on azimuth.
constexpr std::size_t kFewColumns = 8;
constexpr std::size_t kMostImageRows = 512;
/// Means over a cell are taken at these shares of its height and width: Gauss' points.
constexpr double kGauss[2] = {0.2113248654051871, 0.7886751345948129};
/// Relative difference of spectra below which a sky has one colour.
constexpr double kSameColour = 1e-5;

std::size_t rows_of(const Sky& sky) {
  if (sky.kind != SkyKind::kImage) return kRows;
  std::size_t factor = 1;
  while (sky.image->rows / factor > kMostImageRows) ++factor;
  return sky.image->rows / factor;
}

std::size_t columns_of(const Sky& sky) {
  if (sky.kind == SkyKind::kImage) return 2 * rows_of(sky);
  return sky.kind == SkyKind::kGeneral && sky.gradation.depends_on_sun() ? kColumns : kFewColumns;
}

Vec3 direction(double altitude, double azimuth) {
  return {std::cos(altitude) * std::cos(azimuth), std::cos(altitude) * std::sin(azimuth), std::sin(altitude)};
}

double relative_radiance(const Sky& sky, const Vec3& towards_sun, const Vec3& local) {
  switch (sky.kind) {
    case SkyKind::kUniform:
      return 1;
    case SkyKind::kOvercast:
      return (1 + 2 * local.z()) / 3;
    case SkyKind::kGeneral:
      return sky.gradation.relative_luminance(local.z(),
                                              std::acos(std::clamp(local.dot(towards_sun), -1.0, 1.0)));
    default:
      return 0;
  }
}

std::array<double, 9> harmonics(const Vec3& d) {
  return {0.282095,
          0.488603 * d.y(),
          0.488603 * d.z(),
          0.488603 * d.x(),
          1.092548 * d.x() * d.y(),
          1.092548 * d.y() * d.z(),
          0.315392 * (3 * d.z() * d.z() - 1),
          1.092548 * d.x() * d.z(),
          0.546274 * (d.x() * d.x() - d.y() * d.y())};
}

}  // namespace

SkyTable::SkyTable(const Sky& sky, const BandSet& bands)
    : rows_(rows_of(sky)), columns_(columns_of(sky)), bands_(bands.count()) {
  to_local_.row(0) = sky.north.transpose();
  to_local_.row(1) = sky.north.cross(sky.up).transpose();
  to_local_.row(2) = sky.up.transpose();
  for (std::size_t r = 0; r <= rows_; ++r)
    altitude_.push_back(pi / 2 - pi * static_cast<double>(r) / static_cast<double>(rows_));
  if (rows_ % 2 == 0) altitude_[rows_ / 2] = 0;
  radiance_.assign(rows_ * columns_ * bands_, 0.0F);
  if (sky.kind == SkyKind::kImage)
    fill_with_image(*sky.image);
  else
    fill(sky, bands);
  if (sky.ground_reflectance.size() > 0) {
    const Spectrum ground = ground_radiance(sky, bands);
    // A row across the horizon has its share of both.
    for (std::size_t r = 0; r < rows_; ++r) {
      const double share = std::clamp(-altitude_[r + 1] / (altitude_[r] - altitude_[r + 1]), 0.0, 1.0);
      for (std::size_t i = r * columns_ * bands_; share > 0 && i < (r + 1) * columns_ * bands_; ++i)
        radiance_[i] = static_cast<float>((1 - share) * static_cast<double>(radiance_[i]) +
                                          share * ground[static_cast<Eigen::Index>(i % bands_)]);
    }
  }
  sum_up();
}

double SkyTable::azimuth(std::size_t column) const {
  return pi + 2 * pi * static_cast<double>(column) / static_cast<double>(columns_);
}

void SkyTable::fill(const Sky& sky, const BandSet& bands) {
  if (sky.kind == SkyKind::kNone) return;
  const Vec3 sun = sky.sun ? direction(sky.sun->altitude, sky.sun->azimuth) : Vec3(0, 0, 1);
  std::vector<double> mean(rows_ / 2 * columns_, 0.0);
  double horizontal = 0;
  for (std::size_t r = 0; r < rows_ / 2; ++r) {
    const double height = altitude_[r] - altitude_[r + 1];
    const double top = std::sin(altitude_[r]);
    const double bottom = std::sin(altitude_[r + 1]);
    for (std::size_t c = 0; c < columns_; ++c) {
      const double width = azimuth(c + 1) - azimuth(c);
      double weight = 0;
      for (const double v : kGauss)
        for (const double u : kGauss) {
          const double altitude = altitude_[r + 1] + v * height;
          const double solid = std::cos(altitude);
          weight += solid;
          mean[r * columns_ + c] +=
              solid * relative_radiance(sky, sun, direction(altitude, azimuth(c) + u * width));
        }
      mean[r * columns_ + c] /= weight;
      horizontal += mean[r * columns_ + c] * 0.5 * (top * top - bottom * bottom) * width;
    }
  }
  if (!(horizontal > 0)) return;
  const Spectrum per_unit = horizontal_sky_irradiance(sky, bands) / horizontal;
  for (std::size_t cell = 0; cell < mean.size(); ++cell)
    for (std::size_t b = 0; b < bands_; ++b)
      radiance_[cell * bands_ + b] = static_cast<float>(mean[cell] * per_unit[static_cast<Eigen::Index>(b)]);
}

void SkyTable::fill_with_image(const SkyImage& image) {
  const std::size_t factor = image.rows / rows_;
  const std::size_t across = image.columns / columns_;
  std::vector<double> sum(bands_);
  for (std::size_t r = 0; r < rows_; ++r)
    for (std::size_t c = 0; c < columns_; ++c) {
      std::fill(sum.begin(), sum.end(), 0.0);
      double weight = 0;
      // The last cells have what does not divide.
      const std::size_t row_end = r + 1 == rows_ ? image.rows : (r + 1) * factor;
      const std::size_t column_end = c + 1 == columns_ ? image.columns : (c + 1) * across;
      for (std::size_t row = r * factor; row < row_end; ++row) {
        const double solid =
            std::cos(pi * ((static_cast<double>(row) + 0.5) / static_cast<double>(image.rows) - 0.5));
        for (std::size_t column = c * across; column < column_end; ++column) {
          weight += solid;
          for (std::size_t b = 0; b < bands_; ++b)
            sum[b] += solid * static_cast<double>(image.pixel(row, column, bands_)[b]);
        }
      }
      for (std::size_t b = 0; b < bands_; ++b)
        radiance_[(r * columns_ + c) * bands_ + b] = static_cast<float>(sum[b] / weight);
    }
}

void SkyTable::sum_up() {
  brightness_.assign(rows_ * columns_, 0.0F);
  spectrum_ = Spectrum::Zero(static_cast<Eigen::Index>(bands_));
  rows_until_.assign(rows_ + 1, 0.0);
  columns_until_.assign(rows_ * (columns_ + 1), 0.0F);
  constexpr double kConvolved[9] = {pi,     2 * pi / 3, 2 * pi / 3, 2 * pi / 3, pi / 4,
                                    pi / 4, pi / 4,     pi / 4,     pi / 4};
  for (std::size_t r = 0; r < rows_; ++r) {
    const double solid =
        (std::sin(altitude_[r]) - std::sin(altitude_[r + 1])) * 2 * pi / static_cast<double>(columns_);
    double row = 0;
    std::vector<double> until(columns_ + 1, 0.0);
    for (std::size_t c = 0; c < columns_; ++c) {
      const float* values = radiance({r, c});
      double sum = 0;
      for (std::size_t b = 0; b < bands_; ++b) {
        sum += static_cast<double>(values[b]);
        spectrum_[static_cast<Eigen::Index>(b)] += solid * static_cast<double>(values[b]);
      }
      brightness_[r * columns_ + c] = static_cast<float>(sum);
      row += sum * solid;
      until[c + 1] = row;
      const std::array<double, 9> y =
          harmonics(direction(0.5 * (altitude_[r] + altitude_[r + 1]), 0.5 * (azimuth(c) + azimuth(c + 1))));
      for (std::size_t k = 0; k < 9; ++k) harmonics_[k] += kConvolved[k] * y[k] * sum * solid;
    }
    for (std::size_t c = 0; c <= columns_; ++c)
      columns_until_[r * (columns_ + 1) + c] = static_cast<float>(
          row > 0 ? until[c] / row : static_cast<double>(c) / static_cast<double>(columns_));
    total_ += row;
    rows_until_[r + 1] = total_;
  }
  if (!(total_ > 0)) return;
  for (double& until : rows_until_) until /= total_;
  spectrum_ /= total_;
  for (std::size_t cell = 0; cell < brightness_.size() && !is_coloured_; ++cell)
    for (std::size_t b = 0; b < bands_; ++b) {
      const auto all = static_cast<double>(brightness_[cell]);
      const double expected = all * spectrum_[static_cast<Eigen::Index>(b)];
      if (std::abs(static_cast<double>(radiance_[cell * bands_ + b]) - expected) > kSameColour * all)
        is_coloured_ = true;
    }
}

SkyTable::Cell SkyTable::cell_of(const Vec3& local) const {
  const double altitude = std::asin(std::clamp(local.z(), -1.0, 1.0));
  const double azimuth = std::atan2(local.y(), local.x());
  const auto below = [](double x, std::size_t count) {
    const double scaled = std::floor(x * static_cast<double>(count));
    return std::min(static_cast<std::size_t>(std::max(0.0, scaled)), count - 1);
  };
  std::size_t row = below(0.5 - altitude / pi, rows_);
  // Rounding must not lift what lies below the horizon.
  if (rows_ % 2 == 0) row = local.z() < 0 ? std::max(row, rows_ / 2) : std::min(row, rows_ / 2 - 1);
  return {row, below((azimuth + pi) / (2 * pi), columns_)};
}

Vec3 SkyTable::sample(double u0, double u1) const {
  double across = 0;
  double along = 0;
  const std::size_t row = find_interval(rows_until_.data(), rows_, u0, across);
  const std::size_t column = find_interval(&columns_until_[row * (columns_ + 1)], columns_, u1, along);
  const double top = std::sin(altitude_[row]);
  const double bottom = std::sin(altitude_[row + 1]);
  const double z = top + across * (bottom - top);
  const double azimuth_at = azimuth(column) + along * (azimuth(column + 1) - azimuth(column));
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(azimuth_at), r * std::sin(azimuth_at), z};
}

double SkyTable::irradiance(const Vec3& local_normal) const {
  const std::array<double, 9> y = harmonics(local_normal);
  double sum = 0;
  for (std::size_t k = 0; k < 9; ++k) sum += harmonics_[k] * y[k];
  return std::max(sum, 0.01 * total_ / 4);
}

}  // namespace reemit

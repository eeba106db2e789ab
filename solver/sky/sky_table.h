#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "scenes/model/sky.h"

namespace reemit {

/// Sky and ground, without the sun, as cells of constant radiance: rows of equal height from zenith to nadir,
/// columns of equal width from azimuth 180 degrees (from north towards east) on. Packets, shadow rays and
/// rays that leave the room all see this table, so that they agree to rounding; cells of analytic skies are
/// one degree high and hold the mean over the cell. Directions are in the frame of the sky: north, east, up.
class SkyTable {
 public:
  /// Pre: the sky is placed (place_sky).
  SkyTable(const Sky& sky, const BandSet& bands);

  /// True if no light comes from anywhere.
  bool empty() const { return !(total_ > 0); }
  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  std::size_t band_count() const { return bands_; }
  /// Altitude of the upper edge of a row [rad]; of row rows() the nadir.
  double altitude(std::size_t row) const { return altitude_[row]; }
  /// Azimuth of the first edge of a column [rad], in [pi, 3 pi].
  double azimuth(std::size_t column) const;

  struct Cell {
    std::size_t row, column;
  };
  Cell cell_of(const Vec3& local) const;
  std::size_t index(const Cell& cell) const { return cell.row * columns_ + cell.column; }
  /// Radiance of a cell, one value per band [W/(m2 sr)].
  const float* radiance(const Cell& cell) const { return &radiance_[index(cell) * bands_]; }
  /// Sum of it over bands.
  float brightness(const Cell& cell) const { return brightness_[index(cell)]; }

  /// Whether the colour depends on the direction.
  bool is_coloured() const { return is_coloured_; }
  /// Of all its light together: adds up to 1.
  const Spectrum& spectrum() const { return spectrum_; }

  /// A direction with density proportional to brightness.
  Vec3 sample(double u0, double u1) const;
  /// Its density [1/sr].
  double pdf_per_sr(const Cell& cell) const { return static_cast<double>(brightness(cell)) / total_; }

  /// Irradiance, summed over bands, of an unobstructed plane [W/m2]; about: spherical harmonics of degree two
  /// [RH01], and never below a hundredth of the mean.
  double irradiance(const Vec3& local_normal) const;

  /// North, east and up in the room, as rows.
  const Eigen::Matrix3d& to_local() const { return to_local_; }

 private:
  void fill(const Sky& sky, const BandSet& bands);
  void fill_with_image(const SkyImage& image);
  void sum_up();

  std::size_t rows_, columns_, bands_;
  Eigen::Matrix3d to_local_;
  std::vector<double> altitude_;
  std::vector<float> radiance_;    // [cell * bands + band]
  std::vector<float> brightness_;  // [cell]
  bool is_coloured_ = false;
  Spectrum spectrum_;
  double total_ = 0;  // brightness over the sphere [W/m2]
  std::vector<double> rows_until_;
  std::vector<float> columns_until_;  // [row * (columns + 1) + column]
  std::array<double, 9> harmonics_{};
};

/// First interval of a rising table of `count` + 1 values from 0 to 1 that holds u, and where in it u lies
/// [0,1).
template <class Number>
std::size_t find_interval(const Number* until, std::size_t count, double u, double& inside) {
  const Number* end = until + count + 1;
  const Number* above = std::upper_bound(until, end, static_cast<Number>(u));
  std::size_t i = above == until ? 0 : static_cast<std::size_t>(above - until) - 1;
  i = std::min(i, count - 1);
  while (i > 0 && !(until[i + 1] > until[i])) --i;  // rounding may lead into an empty one at the end
  const auto low = static_cast<double>(until[i]);
  const double width = static_cast<double>(until[i + 1]) - low;
  inside = width > 0 ? std::clamp((u - low) / width, 0.0, 1.0) : 0.5;
  return i;
}

}  // namespace reemit

#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scenes/model/vec.h"

namespace reemit {

// Luminaire coordinates, the same for all kinds of photometry: x is the horizontal direction C = 0 (in LM-63
// terms the photometric horizontal), y is C = 90, z is up; the nadir (gamma = 0) is -z. Seen from above, C
// grows counter-clockwise.

/// Goniometer by whose angles a table was measured [LM63].
enum class PhotometricType : std::uint8_t {
  kA,  ///< Vertical pole; horizontal angles clockwise seen from above, vertical ones from -90 (nadir) to 90.
  kB,  ///< Horizontal pole along y; vertical angles about it from the nadir (0) to x (90).
  kC,  ///< Vertical pole; polar angle gamma from the nadir, azimuth C.
};

/// Pole (polar angle 0) and azimuths 0 and 90 of a goniometer in luminaire coordinates; unit and orthogonal.
struct GoniometerAxes {
  Vec3 pole, zero, ninety;
};
/// As the angles of each type are defined above [LM63].
GoniometerAxes goniometer_axes(PhotometricType type);

/// Integral over [a,b] of f(t) sin(t) dt, f linear from f(a) = fa to f(b) = fb; angles in radians. Closed
/// form that stays accurate for short intervals.
double integral_of_linear_times_sine(double a, double b, double fa, double fb);

/// Luminous intensities of a luminaire on a grid of polar angle and azimuth of its goniometer, linear in both
/// angles between the grid lines (bilinear) and 0 outside the grid. Does not change once made.
class IntensityTable {
 public:
  /// `polar_deg`: at least 2 values, strictly increasing, in [0,180]. `azimuth_deg`: at least 2 values,
  /// strictly increasing, over 360 degrees at most; symmetries are already unfolded. `candela` [cd]: finite,
  /// >= 0, not all 0, candela[azimuth * polar_deg.size() + polar]. Throws std::invalid_argument otherwise.
  IntensityTable(PhotometricType type, const std::vector<double>& polar_deg,
                 const std::vector<double>& azimuth_deg, std::vector<double> candela);

  PhotometricType type() const { return type_; }
  const GoniometerAxes& axes() const { return axes_; }
  const std::vector<double>& polar() const { return polar_; }      ///< [rad], increasing.
  const std::vector<double>& azimuth() const { return azimuth_; }  ///< [rad], increasing.
  const std::vector<double>& candela() const { return candela_; }  ///< As given to the constructor.
  double candela(std::size_t azimuth, std::size_t polar) const {
    return candela_[azimuth * polar_.size() + polar];
  }

  /// Intensity [cd] in a direction of any length above 0, in luminaire coordinates.
  double intensity(const Vec3& direction) const;
  /// About the same, and several times faster: the mean over the cell of some 6 degrees that holds the
  /// direction, by points 1.5 degrees apart.
  double rough_intensity(const Vec3& direction) const {
    return static_cast<double>(rough_[rough_cell(direction)]);
  }
  /// Polar angle and azimuth [rad] of a direction; the azimuth lies in the turn that begins at azimuth()[0].
  void angles(const Vec3& direction, double& polar, double& azimuth) const;
  /// Unit direction in luminaire coordinates, of angles [rad].
  Vec3 direction(double polar, double azimuth) const {
    return std::cos(polar) * axes_.pole +
           std::sin(polar) * (std::cos(azimuth) * axes_.zero + std::sin(azimuth) * axes_.ninety);
  }

  /// Integral of the bilinear interpolant over all directions [lm], in closed form.
  double total_flux() const { return flux_below_.back(); }
  double greatest_intensity() const { return greatest_; }  ///< [cd]

  // For sampling.

  const std::vector<double>& polar_sines() const { return polar_sine_; }      ///< At grid lines.
  const std::vector<double>& polar_cosines() const { return polar_cosine_; }  ///< At grid lines.
  /// Flux [lm] at polar angles below each grid line.
  const std::vector<double>& flux_below() const { return flux_below_; }
  /// azimuth_integral of all, [azimuth * polar().size() + polar].
  const std::vector<double>& azimuth_integrals() const { return azimuth_integral_; }
  /// Flux [lm] at polar angles below grid line `polar`.
  double flux_below(std::size_t polar) const { return flux_below_[polar]; }
  /// Integral over the azimuths up to grid line `azimuth` at the grid line `polar` [cd rad].
  double azimuth_integral(std::size_t azimuth, std::size_t polar) const {
    return azimuth_integral_[azimuth * polar_.size() + polar];
  }

 private:
  // Directions in cells of an octahedron unfolded to a square.
  static constexpr int kRoughCells = 32;
  static std::size_t rough_cell(const Vec3& direction);
  void fill_rough_cells();

  PhotometricType type_;
  GoniometerAxes axes_;
  std::vector<double> polar_, azimuth_, candela_;
  std::vector<float> rough_;
  std::vector<double> polar_sine_, polar_cosine_;
  std::vector<double> flux_below_, azimuth_integral_;
  double greatest_ = 0;
};

/// The part of a luminaire that shines, centred on its position.
struct LuminousOpening {
  enum class Shape : std::uint8_t { kPoint, kBox, kCylinder, kEllipsoid };
  enum class Axis : std::uint8_t { kLength, kWidth, kHeight };
  Shape shape = Shape::kPoint;
  double length = 0;          ///< Along C = 0 [m], >= 0; 0 for flat shapes. Full size, not half.
  double width = 0;           ///< Along C = 90 [m].
  double height = 0;          ///< Along the vertical of the luminaire [m].
  Axis axis = Axis::kHeight;  ///< Of a cylinder; its cross-section is an ellipse. Of length 0 it is flat.

  Vec3 size() const { return {length, width, height}; }
};

}  // namespace reemit

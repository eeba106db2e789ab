#pragma once
#include <cstddef>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "scenes/model/bands.h"
#include "scenes/model/vec.h"

namespace reemit {

/// Sunlight from a disk of even radiance.
struct Sun {
  /// Half the angle of the disk as seen from the Earth [rad]: 0.2665 degrees on average.
  static constexpr double kHalfAngle = 0.2665 * std::numbers::pi / 180;

  double altitude = 0;  ///< Above the horizon [rad], > 0.
  double azimuth = 0;   ///< From north towards east [rad].
  /// [W/m2] per band on a plane across the beam; empty: the sun stands there, but only the sky sends light.
  Spectrum irradiance;
  double half_angle = kHalfAngle;  ///< [rad], > 0.

  bool shines() const { return irradiance.size() > 0 && (irradiance > 0).any(); }
};

enum class SkyKind {
  kNone,      ///< Black, for a sun alone.
  kUniform,   ///< The same radiance everywhere.
  kOvercast,  ///< (1 + 2 sin altitude) / 3 of the zenith [CIE110, Moon and Spencer].
  kGeneral,   ///< A SkyGradation.
  kImage,
};

/// Relative luminance phi(Z) f(chi) of a general sky [CIE11, eq. 1-8]: phi = 1 + a exp(b / cos Z),
/// f = 1 + c (exp(d chi) - exp(d pi/2)) + e cos^2 chi; Z from the zenith, chi from the sun. The all-weather
/// sky [PER93, eq. 1] has the same form but for the second exponential, which is 0.
struct SkyGradation {
  double a = 0, b = -1, c = 0, d = -1, e = 0;
  bool is_all_weather = false;

  /// One of the 15 standard skies [CIE11, table 1]. Pre: 1 <= type <= 15.
  static SkyGradation of_cie_type(int type);
  /// All-weather sky of [PER93, table 1] for direct normal and diffuse horizontal irradiance [W/m2] and the
  /// altitude of the sun [rad]. Pre: diffuse > 0, direct >= 0.
  static SkyGradation of_weather(double direct_normal, double diffuse_horizontal, double sun_altitude);

  bool depends_on_sun() const { return c != 0 || e != 0; }
  /// Never negative.
  double relative_luminance(double cos_zenith, double angle_to_sun) const;
};

/// Radiance of all directions: rows from zenith to nadir of equal height, columns of equal width from
/// azimuth 180 degrees (behind) over 360 (north, in the middle) on to 540.
struct SkyImage {
  std::size_t rows = 0, columns = 0;
  std::vector<float> radiance;  ///< [(row * columns + column) * bands + band] [W/(m2 sr)].

  const float* pixel(std::size_t row, std::size_t column, std::size_t bands) const {
    return &radiance[(row * columns + column) * bands];
  }
};

/// What stands around the room, infinitely far away: sky, sun, and ground below the horizon.
struct Sky {
  SkyKind kind = SkyKind::kUniform;
  std::string description;  ///< As users name it: "CIE overcast".
  /// Unit; 0 until place_sky has set what the room does not say.
  Vec3 up{0, 0, 0};
  Vec3 north{0, 0, 0};  ///< Unit, across `up`.
  /// Irradiance of the sky, without the sun, on a horizontal plane [W/m2] per band; not of images.
  Spectrum irradiance;
  SkyGradation gradation;                 ///< Of kGeneral.
  std::shared_ptr<const SkyImage> image;  ///< Of kImage.
  /// Radiance below the horizon is this times the horizontal irradiance of sky and sun over pi; empty: the
  /// lower half of the image.
  Spectrum ground_reflectance;
  std::optional<Sun> sun;

  bool sun_shines() const { return sun && sun->shines(); }
  /// Unit, in the room. Pre: placed.
  Vec3 towards(double altitude, double azimuth) const;
  Vec3 towards_sun() const { return towards(sun->altitude, sun->azimuth); }
};

/// What falls on a horizontal plane outside from the sky alone [W/m2] per band; of an image, the integral of
/// its upper half.
Spectrum horizontal_sky_irradiance(const Sky& sky, const BandSet& bands);
/// What comes there from the sun: its irradiance across the beam times the sine of its altitude [W/m2] per
/// band; 0 if no sun shines.
Spectrum horizontal_sun_irradiance(const Sky& sky, const BandSet& bands);
/// Radiance of the ground below the horizon [W/(m2 sr)]. Pre: it has a reflectance.
Spectrum ground_radiance(const Sky& sky, const BandSet& bands);

/// Gives the sky the directions that it does not say: `up` by default, north where maps have it: +y where z
/// is up, else -z, so that x runs east.
void place_sky(Sky& sky, const Vec3& up);

}  // namespace reemit

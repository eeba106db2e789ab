#include "scenes/model/sky.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "scenes/model/measures.h"

namespace reemit {
namespace {

using std::numbers::pi;

constexpr std::array<SkyGradation, 15> kCieSkies = {{{4.0, -0.70, 0, -1.0, 0},
                                                     {4.0, -0.70, 2, -1.5, 0.15},
                                                     {1.1, -0.8, 0, -1.0, 0},
                                                     {1.1, -0.8, 2, -1.5, 0.15},
                                                     {0, -1.0, 0, -1.0, 0},
                                                     {0, -1.0, 2, -1.5, 0.15},
                                                     {0, -1.0, 5, -2.5, 0.30},
                                                     {0, -1.0, 10, -3.0, 0.45},
                                                     {-1.0, -0.55, 2, -1.5, 0.15},
                                                     {-1.0, -0.55, 5, -2.5, 0.30},
                                                     {-1.0, -0.55, 10, -3.0, 0.45},
                                                     {-1.0, -0.32, 10, -3.0, 0.45},
                                                     {-1.0, -0.32, 16, -3.0, 0.30},
                                                     {-1.0, -0.15, 16, -3.0, 0.30},
                                                     {-1.0, -0.15, 24, -2.8, 0.15}}};

/// By clearness: x1 ... x4 of a, b, c, d and e.
constexpr double kWeather[8][5][4] = {{{1.3525, -0.2576, -0.2690, -1.4366},
                                       {-0.7670, 0.0007, 1.2734, -0.1233},
                                       {2.8000, 0.6004, 1.2375, 1.0000},
                                       {1.8734, 0.6297, 0.9738, 0.2809},
                                       {0.0356, -0.1246, -0.5718, 0.9938}},
                                      {{-1.2219, -0.7730, 1.4148, 1.1016},
                                       {-0.2054, 0.0367, -3.9128, 0.9156},
                                       {6.9750, 0.1774, 6.4477, -0.1239},
                                       {-1.5798, -0.5081, -1.7812, 0.1080},
                                       {0.2624, 0.0672, -0.2190, -0.4285}},
                                      {{-1.1000, -0.2515, 0.8952, 0.0156},
                                       {0.2782, -0.1812, -4.5000, 1.1766},
                                       {24.7219, -13.0812, -37.7000, 34.8438},
                                       {-5.0000, 1.5218, 3.9229, -2.6204},
                                       {-0.0156, 0.1597, 0.4199, -0.5562}},
                                      {{-0.5484, -0.6654, -0.2672, 0.7117},
                                       {0.7234, -0.6219, -5.6812, 2.6297},
                                       {33.3389, -18.3000, -62.2500, 52.0781},
                                       {-3.5000, 0.0016, 1.1477, 0.1062},
                                       {0.4659, -0.3296, -0.0876, -0.0329}},
                                      {{-0.6000, -0.3566, -2.5000, 2.3250},
                                       {0.2937, 0.0496, -5.6812, 1.8415},
                                       {21.0000, -4.7656, -21.5906, 7.2492},
                                       {-3.5000, -0.1554, 1.4062, 0.3988},
                                       {0.0032, 0.0766, -0.0656, -0.1294}},
                                      {{-1.0156, -0.3670, 1.0078, 1.4051},
                                       {0.2875, -0.5328, -3.8500, 3.3750},
                                       {14.0000, -0.9999, -7.1406, 7.5469},
                                       {-3.4000, -0.1078, -1.0750, 1.5702},
                                       {-0.0672, 0.4016, 0.3017, -0.4844}},
                                      {{-1.0000, 0.0211, 0.5025, -0.5119},
                                       {-0.3000, 0.1922, 0.7023, -1.6317},
                                       {19.0000, -5.0000, 1.2438, -1.9094},
                                       {-4.0000, 0.0250, 0.3844, 0.2656},
                                       {1.0468, -0.3788, -2.4517, 1.4656}},
                                      {{-1.0500, 0.0289, 0.4260, 0.3590},
                                       {-0.3250, 0.1156, 0.7781, 0.0025},
                                       {31.0625, -14.5000, -46.1148, 55.3750},
                                       {-7.2312, 0.4050, 13.3500, 0.6234},
                                       {1.5000, -0.6426, 1.8564, 0.5636}}};
constexpr double kClearness[7] = {1.065, 1.230, 1.500, 1.950, 2.800, 4.500, 6.200};

/// Relative optical air mass [KY89, eq. 3].
double air_mass(double altitude) {
  const double degrees = altitude / kRadiansPerDegree;
  return 1 / (std::sin(altitude) + 0.50572 * std::pow(degrees + 6.07995, -1.6364));
}

Spectrum zeros(const BandSet& bands) {
  return Spectrum::Zero(static_cast<Eigen::Index>(bands.count()));
}

/// Of the upper half of an image; each pixel counts by sin(altitude) over its solid angle.
Spectrum horizontal_irradiance(const SkyImage& image, const BandSet& bands) {
  Spectrum sum = zeros(bands);
  const double width = 2 * pi / static_cast<double>(image.columns);
  for (std::size_t row = 0; row < image.rows; ++row) {
    const auto altitude = [&](std::size_t r) {
      return std::max(0.0, pi / 2 - pi * static_cast<double>(r) / static_cast<double>(image.rows));
    };
    const double top = std::sin(altitude(row));
    const double bottom = std::sin(altitude(row + 1));
    const double share = 0.5 * (top * top - bottom * bottom) * width;
    if (!(share > 0)) break;
    for (std::size_t column = 0; column < image.columns; ++column)
      for (std::size_t b = 0; b < bands.count(); ++b)
        sum[static_cast<Eigen::Index>(b)] +=
            share * static_cast<double>(image.pixel(row, column, bands.count())[b]);
  }
  return sum;
}

}  // namespace

SkyGradation SkyGradation::of_cie_type(int type) {
  return kCieSkies[static_cast<std::size_t>(type - 1)];
}

SkyGradation SkyGradation::of_weather(double direct_normal, double diffuse_horizontal, double sun_altitude) {
  const double zenith = pi / 2 - sun_altitude;
  constexpr double kKappa = 1.041;  // [PER93, eq. 1]
  const double cube = kKappa * zenith * zenith * zenith;
  const double clearness = ((diffuse_horizontal + direct_normal) / diffuse_horizontal + cube) / (1 + cube);
  constexpr double kSolarConstant = 1367;  // [W/m2]
  const double brightness = diffuse_horizontal * air_mass(sun_altitude) / kSolarConstant;
  const auto bin = static_cast<std::size_t>(
      std::upper_bound(std::begin(kClearness), std::end(kClearness), clearness) - std::begin(kClearness));
  double value[5];
  for (std::size_t k = 0; k < 5; ++k) {
    const double* x = kWeather[bin][k];
    value[k] = x[0] + x[1] * zenith + brightness * (x[2] + x[3] * zenith);
  }
  if (bin == 0) {  // [PER93, eq. 7 and 8]
    const double* c = kWeather[0][2];
    const double* d = kWeather[0][3];
    value[2] = std::exp(std::pow(brightness * (c[0] + c[1] * zenith), c[2])) - c[3];
    value[3] = -std::exp(brightness * (d[0] + d[1] * zenith)) + d[2] + brightness * d[3];
  }
  return {value[0], value[1], value[2], value[3], value[4], true};
}

double SkyGradation::relative_luminance(double cos_zenith, double angle_to_sun) const {
  // At the horizon exp(b / cos Z) vanishes for the usual b < 0; a fitted b may be above 0.
  constexpr double kLeastCosine = 0.01;
  const double phi = 1 + a * std::exp(b / std::max(kLeastCosine, cos_zenith));
  const double cosine = std::cos(angle_to_sun);
  const double across = is_all_weather ? 0 : std::exp(d * pi / 2);
  const double f = 1 + c * (std::exp(d * angle_to_sun) - across) + e * cosine * cosine;
  return std::max(0.0, phi) * std::max(0.0, f);
}

Vec3 Sky::towards(double altitude, double azimuth) const {
  const Vec3 east = north.cross(up);
  return std::cos(altitude) * (std::cos(azimuth) * north + std::sin(azimuth) * east) +
         std::sin(altitude) * up;
}

Spectrum horizontal_sky_irradiance(const Sky& sky, const BandSet& bands) {
  if (sky.kind == SkyKind::kImage) return horizontal_irradiance(*sky.image, bands);
  return sky.kind == SkyKind::kNone ? zeros(bands) : sky.irradiance;
}

Spectrum horizontal_sun_irradiance(const Sky& sky, const BandSet& bands) {
  if (!sky.sun_shines()) return zeros(bands);
  return std::sin(sky.sun->altitude) * sky.sun->irradiance;
}

Spectrum ground_radiance(const Sky& sky, const BandSet& bands) {
  return sky.ground_reflectance *
         (horizontal_sky_irradiance(sky, bands) + horizontal_sun_irradiance(sky, bands)) / pi;
}

void place_sky(Sky& sky, const Vec3& up) {
  if (sky.up.isZero()) sky.up = up;
  if (sky.north.isZero()) {
    const Vec3 plain =
        std::abs(sky.up.z()) > std::abs(sky.up.y()) ? Vec3(Vec3::UnitY()) : Vec3(-Vec3::UnitZ());
    sky.north = plain;
  }
  sky.north = (sky.north - sky.north.dot(sky.up) * sky.up).normalized();
}

}  // namespace reemit

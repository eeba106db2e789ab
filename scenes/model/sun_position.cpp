#include "scenes/model/sun_position.h"

#include <cmath>

#include "scenes/model/measures.h"

namespace reemit {
namespace {

constexpr double kJ2000 = 2451545.0;         // [d]
constexpr double kDaysPerCentury = 36525.0;  // [d]

double sin_deg(double x) {
  return std::sin(x * kRadiansPerDegree);
}
double cos_deg(double x) {
  return std::cos(x * kRadiansPerDegree);
}

/// Between the clocks of the heavens and of the Earth [s], roughly: within a minute or so from 1950 to 2100,
/// which moves the sun by 0.0007 degrees.
double seconds_of_delta_t(double centuries) {
  const double t = 100 * centuries;
  return 63.86 + 0.3345 * t + 0.0031 * t * t;
}

/// Apparent right ascension and declination [deg].
struct Equatorial {
  double right_ascension, declination;
};

/// `t`: dynamical time in centuries since 2000.
Equatorial apparent_sun(double t) {
  const double mean_longitude = 280.46646 + 36000.76983 * t + 0.0003032 * t * t;
  const double anomaly = 357.52911 + 35999.05029 * t - 0.0001537 * t * t;
  const double centre = (1.914602 - 0.004817 * t - 0.000014 * t * t) * sin_deg(anomaly) +
                        (0.019993 - 0.000101 * t) * sin_deg(2 * anomaly) + 0.000289 * sin_deg(3 * anomaly);
  const double q = t + 1;  // the terms of [MEE79] count from 1900
  const double perturbations =
      0.00134 * cos_deg(153.23 + 22518.7541 * q) + 0.00154 * cos_deg(216.57 + 45037.5082 * q) +
      0.00200 * cos_deg(312.69 + 32964.3577 * q) +
      0.00179 * sin_deg(350.74 + 445267.1142 * q - 0.00144 * q * q) + 0.00178 * sin_deg(231.19 + 20.20 * q);
  const double node = 125.04 - 1934.136 * t;  // of the Moon's orbit
  const double aberration = -0.00569;
  const double longitude = mean_longitude + centre + perturbations + aberration - 0.00478 * sin_deg(node) -
                           0.00037 * sin_deg(2 * mean_longitude);
  const double obliquity = 23.4392911 - 0.0130042 * t - 1.64e-7 * t * t + 0.00256 * cos_deg(node) +
                           0.00016 * cos_deg(2 * mean_longitude);
  return {std::atan2(cos_deg(obliquity) * sin_deg(longitude), cos_deg(longitude)) / kRadiansPerDegree,
          std::asin(sin_deg(obliquity) * sin_deg(longitude)) / kRadiansPerDegree};
}

/// [MEE98, eq. 12.4] with the larger term of nutation [deg].
double apparent_sidereal_time(double julian) {
  const double days = julian - kJ2000;
  const double t = days / kDaysPerCentury;
  const double node = 125.04 - 1934.136 * t;
  return 280.46061837 + 360.98564736629 * days + 0.000387933 * t * t - 0.00478 * sin_deg(node) * 0.9175;
}

/// [MEE98, eq. 16.4], altitude without air [deg].
double refraction(double altitude, const Air& air) {
  constexpr double kLowest = -1;
  if (altitude < kLowest) return 0;
  const double minutes = 1.02 / std::tan((altitude + 10.3 / (altitude + 5.11)) * kRadiansPerDegree);
  return minutes / 60 * air.pressure_hpa / 1010 * 283 / (273 + air.temperature_c);
}

}  // namespace

double julian_day(const CivilTime& time) {
  const int year = time.month > 2 ? time.year : time.year - 1;
  const int month = time.month > 2 ? time.month : time.month + 12;
  const double century = std::floor(year / 100.0);
  return std::floor(365.25 * (year + 4716)) + std::floor(30.6001 * (month + 1)) + time.day + 2 - century +
         std::floor(century / 4) - 1524.5 + (time.hours - time.utc_offset_h) / 24;
}

SunPosition sun_position(const Place& place, const CivilTime& time, const Air& air) {
  const double julian = julian_day(time);
  const double universal = (julian - kJ2000) / kDaysPerCentury;
  const Equatorial sun = apparent_sun(universal + seconds_of_delta_t(universal) / (86400 * kDaysPerCentury));
  const double hour_angle = apparent_sidereal_time(julian) + place.longitude_deg - sun.right_ascension;
  const double sine = sin_deg(place.latitude_deg) * sin_deg(sun.declination) +
                      cos_deg(place.latitude_deg) * cos_deg(sun.declination) * cos_deg(hour_angle);
  double altitude = std::asin(std::fmin(1, std::fmax(-1, sine))) / kRadiansPerDegree;
  constexpr double kParallax = 8.794 / 3600;
  altitude -= kParallax * cos_deg(altitude);
  const double from_south =
      std::atan2(sin_deg(hour_angle),
                 cos_deg(hour_angle) * sin_deg(place.latitude_deg) -
                     std::tan(sun.declination * kRadiansPerDegree) * cos_deg(place.latitude_deg)) /
      kRadiansPerDegree;
  return {altitude + refraction(altitude, air), std::fmod(from_south + 540, 360)};
}

}  // namespace reemit

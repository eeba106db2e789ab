#pragma once

namespace reemit {

/// Where on the Earth; north and east count as positive.
struct Place {
  double latitude_deg = 0;   ///< [-90, 90].
  double longitude_deg = 0;  ///< [-180, 180].
};

/// A moment of the Gregorian calendar as clocks show it `utc_offset_h` hours east of Greenwich.
struct CivilTime {
  int year = 2000;  ///< [1900, 2100]: within these the series below hold.
  int month = 1;
  int day = 1;
  double hours = 12;  ///< Since midnight.
  double utc_offset_h = 0;
};

/// What bends the light of a low sun.
struct Air {
  double pressure_hpa = 1013.25;
  double temperature_c = 15;
};

struct SunPosition {
  double altitude_deg = 0;  ///< Above the horizon as it is seen: with refraction while above -1 degree.
  double azimuth_deg = 0;   ///< From north towards east, [0, 360).
};

/// Days since 1 January 4713 BC 12:00 UT [MEE98, eq. 7.1].
double julian_day(const CivilTime& time);

/// Position of the middle of the sun's disk. Apparent ecliptic longitude by [MEE98, ch. 25] with the largest
/// perturbations by planets and the Moon [MEE79, ch. 18], topocentric, refraction by [MEE98, eq. 16.4].
/// Within 0.005 degrees of VSOP87 from 1950 to 2100.
SunPosition sun_position(const Place& place, const CivilTime& time, const Air& air = {});

}  // namespace reemit

#include "scenes/model/sun_position.h"

#include <gtest/gtest.h>

namespace reemit {
namespace {

// 0.01 degrees.
constexpr double kClose = 0.01;

TEST(SunPosition, published_example_of_nrel) {
  // [RA08, sec. 3 and table A5.1]: topocentric zenith 50.11162, azimuth 194.34024 degrees.
  const SunPosition sun =
      sun_position({39.742476, -105.1786}, {2003, 10, 17, 12 + 30 / 60.0 + 30 / 3600.0, -7}, {820, 11});
  EXPECT_NEAR(90 - sun.altitude_deg, 50.11162, kClose);
  EXPECT_NEAR(sun.azimuth_deg, 194.34024, kClose);
}

TEST(SunPosition, julian_days_of_the_book) {
  EXPECT_DOUBLE_EQ(julian_day({2000, 1, 1, 12, 0}), 2451545.0);  // [MEE98, ch. 7]
  EXPECT_DOUBLE_EQ(julian_day({1987, 6, 19, 12, 0}), 2446966.0);
  EXPECT_DOUBLE_EQ(julian_day({1900, 1, 1, 0, 0}), 2415020.5);
  EXPECT_DOUBLE_EQ(julian_day({2024, 2, 29, 1, 1}), julian_day({2024, 2, 29, 0, 0}));
}

TEST(SunPosition, agrees_with_vsop87) {
  // The full series of VSOP87 and IAU 1980 nutation, reduced to the place without air.
  struct Case {
    Place place;
    CivilTime time;
    double altitude, azimuth;
  };
  const Case cases[] = {{{48.2082, 16.3738}, {2024, 6, 21, 10, 0}, 62.8171, 150.6993},
                        {{-33.8688, 151.2093}, {2031, 12, 1, 22.5, 0}, 45.8539, 87.2895},
                        {{69.65, 18.96}, {1975, 5, 20, 22, 0}, -0.0648, 350.4606},
                        {{0, 0}, {2000, 3, 20, 15.75, 0}, 35.5811, 270.1652},
                        {{35.68, 139.69}, {2090, 10, 9, 3.25, 0}, 46.4970, 196.9220}};
  for (const Case& c : cases) {
    const SunPosition sun = sun_position(c.place, c.time, {0, 15});
    EXPECT_NEAR(sun.altitude_deg, c.altitude, kClose) << c.time.year;
    EXPECT_NEAR(sun.azimuth_deg, c.azimuth, kClose) << c.time.year;
  }
}

TEST(SunPosition, air_lifts_the_sun_at_the_horizon_by_half_a_degree) {
  const Place place{69.65, 18.96};
  const CivilTime midnight{1975, 5, 20, 22, 0};
  const double lift =
      sun_position(place, midnight).altitude_deg - sun_position(place, midnight, {0, 15}).altitude_deg;
  EXPECT_GT(lift, 0.4);
  EXPECT_LT(lift, 0.6);
}

}  // namespace
}  // namespace reemit

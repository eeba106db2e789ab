#include "solver/sampling/small_angle.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace reemit {
namespace {

TEST(SmallAngle, SineAndVersineAreRightToTwoUnitsInTheLastPlace) {
  constexpr double kTwoUnits = 2 * std::numeric_limits<double>::epsilon();
  for (double x = 1e-12; x < kSmallAngle; x = std::fmin(1.01 * x, x + 1e-5)) {
    const auto [sine, versine] = sine_and_versine(x);
    const long double angle = x;
    const long double half = std::sin(angle / 2);
    EXPECT_LE(std::fabs(sine / std::sin(angle) - 1), kTwoUnits) << x;
    EXPECT_LE(std::fabs(versine / (2 * half * half) - 1), kTwoUnits) << x;
  }
}

TEST(SmallAngle, WiderAnglesAreThoseOfTheLibrary) {
  for (const double x : {0.0, kSmallAngle, 0.2000001, 1.0, 2.0, 3.1}) {
    const auto [sine, versine] = sine_and_versine(x);
    EXPECT_NEAR(sine, std::sin(x), 1e-15);
    EXPECT_NEAR(1 - versine, std::cos(x), 1e-15);
  }
}

}  // namespace
}  // namespace reemit

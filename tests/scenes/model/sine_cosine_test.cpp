#include "scenes/model/sine_cosine.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace reemit {
namespace {

constexpr double kUnit = std::numeric_limits<double>::epsilon();

TEST(SineCosine, SineAndVersineOfSmallAnglesAreRightToTwoUnitsInTheLastPlace) {
  for (double x = 1e-12; x < 0.785; x = std::fmin(1.01 * x, x + 1e-5)) {
    const SineCosine of = sine_and_cosine(x);
    const long double angle = x;
    const long double half = std::sin(angle / 2);
    EXPECT_LE(std::fabs(of.sine / std::sin(angle) - 1), 2 * kUnit) << x;
    EXPECT_LE(std::fabs(of.versine / (2 * half * half) - 1), 2 * kUnit) << x;
    EXPECT_EQ(sine_and_cosine(-x).sine, -of.sine);
    EXPECT_EQ(sine_and_cosine(-x).versine, of.versine);
  }
}

TEST(SineCosine, AnglesOfAllTurnsAreThoseOfTheLibrary) {
  for (double x = -1000; x < 1000; x += 0.00917) {
    const SineCosine of = sine_and_cosine(x);
    EXPECT_NEAR(of.sine, std::sin(x), kUnit) << x;
    EXPECT_NEAR(of.cosine, std::cos(x), kUnit) << x;
    EXPECT_NEAR(of.versine, 1 - std::cos(x), 2 * kUnit) << x;
  }
  for (const double x : {0.0, 0.7853981633974483, 1.5707963267948966, 3.141592653589793, 6.283185307179586}) {
    EXPECT_NEAR(sine_and_cosine(x).sine, std::sin(x), kUnit);
    EXPECT_NEAR(sine_and_cosine(x).cosine, std::cos(x), kUnit);
  }
}

}  // namespace
}  // namespace reemit

#include "bench/convergence/curve.h"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace reemit::bench {
namespace {

/// error^2 = left^2 + c^2/time, work in proportion to time.
std::vector<CurvePoint> curve_of(double c, double left, const std::vector<double>& times) {
  std::vector<CurvePoint> curve;
  for (const double t : times) curve.push_back({t, 1e6 * t, std::sqrt(left * left + c * c / t)});
  return curve;
}

TEST(SpreadOf, GivesMedianAndRange) {
  const Spread odd = spread_of({5, 1, 3});
  EXPECT_EQ(odd.median, 3);
  EXPECT_EQ(odd.least, 1);
  EXPECT_EQ(odd.most, 5);
  EXPECT_EQ(spread_of({4, 1, 2, 10}).median, 3);
  EXPECT_EQ(spread_of({7}).most, 7);
  EXPECT_THROW(spread_of({}), std::invalid_argument);
}

TEST(TimeToError, IsExactBetweenPointsOfAPowerLaw) {
  const auto curve = curve_of(0.1, 0, {0.1, 1, 10});
  const TimeToError found = time_to_error(curve, 0.05);
  EXPECT_EQ(found.reach, Reach::kMeasured);
  EXPECT_NEAR(found.seconds, 4, 1e-9);
  const TimeToError at_a_point = time_to_error(curve, 0.1);
  EXPECT_EQ(at_a_point.reach, Reach::kMeasured);
  EXPECT_NEAR(at_a_point.seconds, 1, 1e-9);
}

TEST(TimeToError, TakesTheFirstCrossing) {
  const TimeToError found = time_to_error({{1, 1, 0.4}, {2, 2, 0.1}, {4, 4, 0.3}, {8, 8, 0.05}}, 0.2);
  EXPECT_EQ(found.reach, Reach::kMeasured);
  EXPECT_NEAR(found.seconds, std::sqrt(2.0), 1e-9);
}

TEST(TimeToError, BeforeTheFirstPointIsOnlyABound) {
  const TimeToError found = time_to_error(curve_of(0.1, 0, {1, 10}), 0.2);
  EXPECT_EQ(found.reach, Reach::kAtMost);
  EXPECT_EQ(found.seconds, 1);
}

TEST(TimeToError, ExtrapolatesNoiseWithSlopeOneHalf) {
  const TimeToError found = time_to_error(curve_of(0.1, 0, {0.1, 1, 10}), 0.01);
  EXPECT_EQ(found.reach, Reach::kExtrapolated);
  EXPECT_NEAR(found.seconds, 100, 1e-6);
}

TEST(TimeToError, ExtrapolatesPastAPartThatStays) {
  const auto curve = curve_of(0.1, 0.01, {1, 4, 16, 64});
  EXPECT_NEAR(remaining_error(curve), 0.01, 1e-6);
  const TimeToError found = time_to_error(curve, 0.0125);
  EXPECT_EQ(found.reach, Reach::kExtrapolated);
  EXPECT_NEAR(found.seconds, 0.01 / (0.0125 * 0.0125 - 0.0001), 0.1);
  EXPECT_EQ(time_to_error(curve, 0.009).reach, Reach::kNever);
  // What stays is a small part of these errors: it could be chance.
  EXPECT_EQ(remaining_error(curve_of(0.1, 0.01, {1, 4, 16})), 0);
}

TEST(TimeToError, ACurveSteeperThanOneHalfIsExtrapolatedWithOneHalf) {
  const TimeToError found = time_to_error({{1, 1, 0.4}, {4, 4, 0.1}, {16, 16, 0.025}}, 0.0125);
  EXPECT_EQ(found.reach, Reach::kExtrapolated);
  EXPECT_NEAR(found.seconds, 64, 1e-6);
}

TEST(TimeToError, NothingStaysOfACurveThatFellSlowlyAtFirstOnly) {
  const std::vector<CurvePoint> curve{{0.6, 8, 0.147}, {2.3, 32, 0.091}, {9, 128, 0.0463}};
  EXPECT_EQ(remaining_error(curve), 0);
  EXPECT_NEAR(time_to_error(curve, 0.03).seconds, 9 * (0.0463 * 0.0463) / (0.03 * 0.03), 1e-6);
}

TEST(TimeToError, OnePointIsExtrapolatedToo) {
  const TimeToError found = time_to_error({{2, 1, 0.1}}, 0.05);
  EXPECT_EQ(found.reach, Reach::kExtrapolated);
  EXPECT_NEAR(found.seconds, 8, 1e-9);
  EXPECT_THROW(time_to_error({}, 0.05), std::invalid_argument);
}

TEST(ConvergenceRate, IsTheSlopeOfAPowerLaw) {
  const auto rate = convergence_rate(curve_of(0.3, 0, {0.1, 1, 7, 100}));
  ASSERT_TRUE(rate);
  EXPECT_NEAR(*rate, -0.5, 1e-12);
  EXPECT_NEAR(*convergence_rate({{1, 1, 1}, {1, 10, 0.1}}), -1, 1e-12);
  EXPECT_FALSE(convergence_rate({{1, 5, 0.1}, {1, 5, 0.2}}));
  EXPECT_FALSE(convergence_rate({{1, 5, 0.1}}));
  EXPECT_FALSE(convergence_rate({}));
}

TEST(WithoutReference, TakesTheReferenceOutInSquares) {
  ASSERT_TRUE(without_reference(0.05, 0.02));
  EXPECT_NEAR(*without_reference(0.05, 0.02), std::sqrt(0.0021), 1e-12);
  EXPECT_EQ(without_reference(0.05, 0), 0.05);
  EXPECT_FALSE(without_reference(0.05, 0.026));
  EXPECT_FALSE(without_reference(0, 0));
}

}  // namespace
}  // namespace reemit::bench

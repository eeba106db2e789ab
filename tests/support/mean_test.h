#pragma once
#include <cmath>
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

namespace reemit::test {

/// Mean and standard error of independent estimates of one quantity, e.g. one per randomisation of a Sobol'
/// sequence.
class MeanTest {
 public:
  void add(double estimate) {
    ++count_;
    const double deviation = estimate - mean_;
    mean_ += deviation / static_cast<double>(count_);
    squares_ += deviation * (estimate - mean_);
  }
  std::size_t count() const { return count_; }
  double mean() const { return mean_; }
  double standard_error() const {
    const auto n = static_cast<double>(count_);
    return std::sqrt(squares_ / (n * (n - 1)));
  }

  /// Do the estimates have this mean? The limit is kErrors standard errors plus what float arithmetic may
  /// lose. A right program fails with odds below 2 Q(t) of Student's t with count-1 degrees of freedom:
  /// 5 standard errors of 32 estimates or more: below 1 in 46,000 per quantity tested.
  static constexpr double kErrors = 5;
  static constexpr double kRounding = 2e-5;  ///< Relative.
  ::testing::AssertionResult agrees_with(double truth) const {
    const double limit = kErrors * standard_error() + kRounding * std::fabs(truth);
    const double difference = std::fabs(mean_ - truth);
    const std::string numbers = std::to_string(count_) + " estimates with mean " + std::to_string(mean_) +
                                " +- " + std::to_string(standard_error()) + ", truth " +
                                std::to_string(truth);
    if (count_ >= 32 && difference <= limit) return ::testing::AssertionSuccess() << numbers;
    return ::testing::AssertionFailure() << numbers << ": off by " << difference << ", limit " << limit;
  }

  /// Could this test have noticed a relative bias of that size? True if the limit is below half of it, so
  /// that a biased program passes with odds below those of a right one failing.
  bool would_notice(double relative_bias, double truth) const {
    return 2 * (kErrors * standard_error() + kRounding * std::fabs(truth)) < relative_bias * std::fabs(truth);
  }

 private:
  std::size_t count_ = 0;
  double mean_ = 0;
  double squares_ = 0;
};

/// Do two independent estimates of the same quantity agree? 5 standard errors of the difference; odds as
/// above with the smaller of the two counts.
inline ::testing::AssertionResult agree(const MeanTest& a, const MeanTest& b) {
  const double error = std::hypot(a.standard_error(), b.standard_error());
  const double difference = std::fabs(a.mean() - b.mean());
  const double limit = MeanTest::kErrors * error + MeanTest::kRounding * std::fabs(a.mean());
  if (a.count() >= 32 && b.count() >= 32 && difference <= limit) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure()
         << a.mean() << " +- " << a.standard_error() << " against " << b.mean() << " +- "
         << b.standard_error() << ": off by " << difference << ", limit " << limit;
}

}  // namespace reemit::test

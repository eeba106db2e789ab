#include "bench/validation/validation_row.h"

#include <cmath>
#include <limits>

#include <boost/math/distributions/students_t.hpp>

namespace reemit::validation {

double ValidationRow::uncertainty() const {
  return std::hypot(standard_error, numerical_bound, expected_abs_err);
}

double ValidationRow::deviation() const {
  const double difference = measured - expected;
  if (difference == 0) return 0;
  const double scale = uncertainty();
  return scale > 0 ? difference / scale : std::copysign(std::numeric_limits<double>::infinity(), difference);
}

double ValidationRow::relative_error() const {
  if (expected != 0) return standard_error / std::fabs(expected);
  return standard_error > 0 ? std::numeric_limits<double>::infinity() : 0;
}

bool ValidationRow::is_noisy() const {
  return freedom > 0 && standard_error > 3 * std::hypot(numerical_bound, expected_abs_err);
}

double ValidationRow::odds_beyond(double limit) const {
  if (!is_noisy()) return 0;
  return 2 * boost::math::cdf(boost::math::complement(boost::math::students_t(freedom), limit));
}

double student_density(double t, int freedom) {
  return boost::math::pdf(boost::math::students_t(freedom), t);
}

ValidationRow make_row(const ReferenceCase& c, const ReferenceValue& v, const std::string& method,
                       const Estimates& estimates, double relative_bound) {
  ValidationRow row;
  row.id = v.id;
  row.kind = c.kind;
  row.method = method;
  row.expected = v.value;
  row.expected_abs_err = v.abs_err;
  row.numerical_bound = relative_bound * std::fabs(v.value);
  const auto n = static_cast<double>(estimates.size());
  double squares = 0;
  double count = 0;
  for (const double x : estimates) {
    count += 1;
    const double deviation = x - row.measured;
    row.measured += deviation / count;
    squares += deviation * (x - row.measured);
  }
  if (estimates.size() < 2) return row;
  row.standard_error = std::sqrt(squares / (n * (n - 1)));
  row.freedom = static_cast<int>(estimates.size()) - 1;
  return row;
}

std::uint64_t seed_of(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325U;  // FNV-1a
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

}  // namespace reemit::validation

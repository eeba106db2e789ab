#pragma once
#include <cstddef>
#include <limits>

namespace reemit {

/// Mean of equally weighted replicates and the square of its standard error.
struct ReplicateMean {
  double mean = 0;
  double squared_error = 0;  ///< Infinite with one replicate.
};

/// Mean of `count` replicates, replicate r = value(r). Replicates r and r + parts have read the same part of
/// the zone solution and so share its noise: with two parts or more the spread of the parts' means is the
/// error, which then holds all noise, of the replicates and of the zones; an estimate that is unbiased also
/// when the parts are of unequal quality. With one part (a zone solution that is exact or whose error nobody
/// knows) it is the spread of the replicates alone. Pre: count >= 1 is a multiple of parts >= 1.
/// The error has (parts > 1 ? parts : count) - 1 degrees of freedom.
template <class Value>
ReplicateMean mean_of_replicates(std::size_t count, std::size_t parts, Value&& value) {
  const std::size_t groups = parts > 1 ? parts : count;
  ReplicateMean result;
  double squares = 0;
  for (std::size_t g = 0; g < groups; ++g) {
    double sum = 0;
    for (std::size_t r = g; r < count; r += groups) sum += value(r);
    const double x = sum * static_cast<double>(groups) / static_cast<double>(count);
    const double deviation = x - result.mean;
    result.mean += deviation / static_cast<double>(g + 1);
    squares += deviation * (x - result.mean);
  }
  const auto n = static_cast<double>(groups);
  result.squared_error = groups > 1 ? squares / (n * (n - 1)) : std::numeric_limits<double>::infinity();
  return result;
}

}  // namespace reemit

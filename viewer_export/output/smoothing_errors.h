#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace reemit {

/// What smoothing made of the values of items (pixels, vertices), and what is known of their errors: index
/// item * bands + band.
struct SmoothedValues {
  explicit SmoothedValues(std::size_t count)
      : value(count), variance(count), halves_apart(count), covariance(count) {}

  std::vector<float> value;
  std::vector<float> variance;      ///< Of noise that items do not share.
  std::vector<float> halves_apart;  ///< Half the difference of the values by either half of the replicates.
  std::vector<float> covariance;    ///< With the value as it was before.
};

/// Completes the variances of smoothed values, by what averages hide: noise that neighbours share (of the
/// zone solution) does not average out, that of sequences whose points fill each other's gaps averages out
/// better than any of its own, and values that differ by more than noise have means that are off. One object
/// for a band.
class SmoothingErrors {
 public:
  /// `before`, `stderrs`: the values before smoothing and their standard errors. scale[item]: errors are
  /// taken relative to its reciprocal; 0 leaves an item out. Variances and covariances become what the halves
  /// say of them, all those together that averaging is to have lessened alike.
  SmoothingErrors(SmoothedValues& smoothed, const std::vector<float>& before,
                  const std::vector<float>& stderrs, std::size_t bands, std::size_t band,
                  const std::vector<double>& scale);

  /// Completes the variances of a group of items, among which means are off alike.
  void complete(std::span<const std::size_t> group);

 private:
  SmoothedValues& smoothed_;
  const std::vector<float>& before_;
  const std::vector<float>& stderrs_;
  std::size_t bands_;
  std::size_t band_;
  const std::vector<double>& scale_;
};

}  // namespace reemit

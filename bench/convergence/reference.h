#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/convergence/measurement.h"

namespace reemit::bench {

/// Values that others are measured against, and how sure they are: index item * bands + band.
struct Reference {
  std::size_t bands = 1;
  std::vector<float> value;
  std::vector<float> stderr_of_value;
};

/// How deviations count.
struct ErrorNorm {
  /// One per item. rms = sqrt(sum w d^2 / sum w v^2) over items of weight w, truth v and deviation d. Empty:
  /// rms = sqrt(mean of (d/(v + floor))^2).
  std::vector<double> weight;
  double floor_share = 0;  ///< Only without weights: floor as a share of the mean truth.
};

/// Relative deviation of values from the reference, worst band: rms as the norm says, and the median of |d|/v
/// over all items with v > 0.
ErrorPair deviation(const std::vector<float>& values, const Reference& reference, const ErrorNorm& norm);

/// The reference's own share in these deviations: rms from its standard errors, median from the median
/// standard error times the median 0.6745 of |N(0,1)|.
ErrorPair own_error(const Reference& reference, const ErrorNorm& norm);

/// Keeps references on disk, so that a second run need not make them again.
class ReferenceCache {
 public:
  /// Nothing is kept if the folder is empty; else it is made.
  explicit ReferenceCache(std::filesystem::path folder);

  /// The reference of this name, from disk if it is there. The name must say everything that the values
  /// depend on and be fit for a file name.
  Reference get(const std::string& name, const std::function<Reference()>& make) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace reemit::bench

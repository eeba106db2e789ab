#pragma once
#include <limits>

namespace reemit {

/// A part of a picture or of an export whose samples are added together: a tile of pixels, a chunk of
/// vertices. It decides by all its values, which keeps the choice from favouring those that happen to look
/// quiet.
class RefinedPart {
 public:
  /// What is aimed at for an error target: parts stop when their estimate happens to be low, so the true
  /// error is a few per cent above it.
  static constexpr double aim(double error_target) { return kMargin * error_target; }

  bool is_active() const { return is_active_; }  ///< Gets more samples.
  /// More samples did not help: what is left is the noise of the zone solution.
  bool is_stalled() const { return stalls_ >= kMostStalls; }

  /// `excess`: squared error of the part over what is aimed at, `excess_of_all` likewise of the whole, which
  /// may be good enough before all its parts are. `has_doubled`: the samples, since this was true before or
  /// since they began, and nothing tells that the noise is theirs. A part that has stopped does not begin
  /// again.
  void look(double excess, double excess_of_all, bool has_doubled) {
    if (!is_active_) return;
    if (has_doubled) {
      stalls_ = excess > kStalledShare * excess_before_ ? stalls_ + 1 : 0;
      excess_before_ = excess;
    }
    is_active_ = excess_of_all > 1 && excess > 1 && !is_stalled();
  }

 private:
  static constexpr double kMargin = 0.95;
  /// Doubling the samples halves the variance, unless what is left is the noise of the zone solution. A part
  /// whose variance stays above this share of the one before, twice in a row, is given up.
  static constexpr double kStalledShare = 0.8;
  static constexpr int kMostStalls = 2;

  bool is_active_ = true;
  int stalls_ = 0;
  double excess_before_ = std::numeric_limits<double>::infinity();  // at half the samples
};

}  // namespace reemit

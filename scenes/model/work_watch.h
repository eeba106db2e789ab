#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>

#include "scenes/model/interrupted.h"
#include "scenes/model/stop_token.h"

namespace reemit {

/// Who watches long work without partial results: told how far it is, and may end it. Without either by
/// default.
class WorkWatch {
 public:
  using Callback = std::function<void(double done)>;  ///< `done` in [0,1] and rising.

  WorkWatch() = default;
  explicit WorkWatch(Callback progress, std::optional<StopToken> stop = {})
      : progress_(std::move(progress)), stop_(stop) {}

  /// The watch of a part of the work, from one share of the whole to another.
  WorkWatch part(double from, double to) const {
    WorkWatch watch;
    watch.stop_ = stop_;
    if (progress_)
      watch.progress_ = [whole = progress_, from, to](double done) { whole(from + (to - from) * done); };
    return watch;
  }

  /// The work is done to this share. Throws Interrupted if it is to stop.
  void at(double done) const {
    if (stop_ && stop_->requested()) throw Interrupted("interrupted before the solve began");
    if (progress_) progress_(done);
  }

 private:
  Callback progress_;
  std::optional<StopToken> stop_;
};

/// One of several steps of such work, from one share of the whole to another.
class WorkStep {
 public:
  WorkStep(const WorkWatch& watch, double from, double to) : watch_(watch), from_(from), to_(to) {}

  /// Item `i` of `count` comes next. May be called for every item: asks the watch now and then.
  void at(std::size_t i, std::size_t count) const {
    constexpr std::size_t kNowAndThen = 256;
    if (i % kNowAndThen == 0)
      watch_.at(from_ + (to_ - from_) * static_cast<double>(i) / static_cast<double>(count));
  }

 private:
  const WorkWatch& watch_;
  double from_;
  double to_;
};

}  // namespace reemit

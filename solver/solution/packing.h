#pragma once
#include <atomic>
#include <chrono>
#include <optional>

namespace reemit {

/// Whether what is saved is still packed (deflated), which takes most of the time of a save. When somebody
/// waits for its end it goes on for a moment, in which most files are finished; what is left then is stored
/// as it is.
class Packing {
 public:
  using Clock = std::chrono::steady_clock;

  /// `hurry` becomes true when somebody waits; nobody ever does if it is null.
  explicit Packing(const std::atomic<bool>* hurry, Clock::duration moment = std::chrono::milliseconds(100))
      : hurry_(hurry), moment_(moment) {}

  /// To be asked often: the moment begins when this first sees the hurry.
  bool goes_on() const {
    if (hurry_ == nullptr || !*hurry_) return true;
    if (!end_) end_ = Clock::now() + moment_;
    return Clock::now() < *end_;
  }

 private:
  const std::atomic<bool>* hurry_;
  Clock::duration moment_;
  mutable std::optional<Clock::time_point> end_;
};

}  // namespace reemit

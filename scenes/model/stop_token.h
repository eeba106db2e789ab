#pragma once
#include <atomic>
#include <chrono>

namespace reemit {

/// Tells long work that it should end: somebody asked for it (Ctrl-C), or its time is up. Asking costs about
/// as much as reading a clock (30 ns), so loops may ask whenever they have done a microsecond of work or
/// more. Once it is requested it stays so. The flag must outlive the token.
class StopToken {
 public:
  using Clock = std::chrono::steady_clock;

  /// Without a deadline.
  explicit StopToken(const std::atomic<bool>& interrupt) : interrupt_(&interrupt) {}
  StopToken(const std::atomic<bool>& interrupt, Clock::time_point deadline)
      : interrupt_(&interrupt), deadline_(deadline) {}
  explicit StopToken(std::atomic<bool>&&) = delete;
  StopToken(std::atomic<bool>&&, Clock::time_point) = delete;

  /// The same for work that may become needless before the rest: requested also once `needless` is true,
  /// which must outlive the token too.
  StopToken or_when(const std::atomic<bool>& needless) const {
    StopToken token = *this;
    token.needless_ = &needless;
    return token;
  }

  bool interrupted() const { return interrupt_->load(std::memory_order_relaxed); }
  bool out_of_time() const { return deadline_ != Clock::time_point::max() && Clock::now() >= deadline_; }
  bool requested() const {
    return interrupted() || (needless_ != nullptr && needless_->load(std::memory_order_relaxed)) ||
           out_of_time();
  }

 private:
  const std::atomic<bool>* interrupt_;
  const std::atomic<bool>* needless_ = nullptr;
  Clock::time_point deadline_ = Clock::time_point::max();
};

}  // namespace reemit

#pragma once
#include <atomic>

namespace reemit::cli {

/// From here on SIGINT, SIGTERM and SIGHUP end the program at once with a line on stderr and the exit code of
/// an interrupted run, unless one of the classes below says otherwise. So loading and meshing, whose results
/// are worth nothing in part, need not ask. A SIGHUP that the caller ignores (nohup) stays ignored.
void end_on_signals();

/// While it lives, the first of these signals asks long work to stop and the second one ends the program at
/// once. At most one may live at a time: signals belong to the process.
class InterruptGuard {
 public:
  InterruptGuard() { begin(); }
  /// Of work that begins later: until begin(), signals end the program as if there were no guard.
  enum Later { kLater };
  explicit InterruptGuard(Later /*later*/) {}
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// From here on signals are its own.
  void begin();
  /// Becomes true at the first signal.
  const std::atomic<bool>& requested() const;
};

/// While it lives, a signal that would end the program waits until the file in work is complete or removed,
/// so that no half-written file stays behind.
class FinishWriting {
 public:
  FinishWriting();
  ~FinishWriting();
  FinishWriting(const FinishWriting&) = delete;
  FinishWriting& operator=(const FinishWriting&) = delete;
};

/// Becomes true at the first of these signals, whatever it does: somebody waits for the end.
const std::atomic<bool>& signal_arrived();

}  // namespace reemit::cli

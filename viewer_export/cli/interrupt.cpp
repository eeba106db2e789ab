#include "viewer_export/cli/interrupt.h"

#include <csignal>

#include <unistd.h>

namespace reemit::cli {
namespace {

// A signal handler has no argument of ours to find its state by, so this is the one place that keeps it per
// process.
std::atomic<bool> stop_requested{false};
std::atomic<int> quit_signal{0};
std::atomic<bool> writing{false};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void quit(int signal) {
  ::_exit(128 + signal);
}

extern "C" void handle_signal(int signal) {
  if (!stop_requested.exchange(true)) return;
  if (writing) {
    quit_signal = signal;
  } else {
    quit(signal);
  }
}

}  // namespace

InterruptGuard::InterruptGuard() {
  stop_requested = false;
  quit_signal = 0;
  std::signal(SIGINT, handle_signal);
  std::signal(SIGTERM, handle_signal);
}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

const std::atomic<bool>& InterruptGuard::requested() const {
  return stop_requested;
}

FinishWriting::FinishWriting() {
  writing = true;
}

FinishWriting::~FinishWriting() {
  writing = false;
  if (const int signal = quit_signal) quit(signal);
}

}  // namespace reemit::cli

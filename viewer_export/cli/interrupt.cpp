#include "viewer_export/cli/interrupt.h"

#include <csignal>
#include <string_view>

#include <unistd.h>

#include "viewer_export/cli/exit_code.h"

namespace reemit::cli {
namespace {

// A signal handler has no argument of ours to find its state by, so this is the one place that keeps it per
// process.
std::atomic<bool> stops_by_asking{false};
std::atomic<bool> stop_requested{false};
std::atomic<int> quit_signal{0};
std::atomic<bool> writing{false};
std::atomic<bool> any_signal{false};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

/// Calls nothing that a handler may not.
[[noreturn]] void quit(int signal) {
  if (stops_by_asking) ::_exit(128 + signal);  // the second one, from somebody who is in a hurry
  constexpr std::string_view kMessage = "reemit: error: interrupted before there was a result\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kMessage.data(), kMessage.size());
  ::_exit(static_cast<int>(ExitCode::kInterrupted));
}

extern "C" void handle_signal(int signal) {
  any_signal = true;
  if (stops_by_asking && !stop_requested.exchange(true)) return;
  if (writing) {
    quit_signal = signal;
  } else {
    quit(signal);
  }
}

}  // namespace

void end_on_signals() {
  std::signal(SIGINT, handle_signal);
  std::signal(SIGTERM, handle_signal);
  if (std::signal(SIGHUP, handle_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

void InterruptGuard::begin() {
  stop_requested = false;
  stops_by_asking = true;
}

InterruptGuard::~InterruptGuard() {
  stops_by_asking = false;
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

const std::atomic<bool>& signal_arrived() {
  return any_signal;
}

}  // namespace reemit::cli

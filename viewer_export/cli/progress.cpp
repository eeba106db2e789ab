#include "viewer_export/cli/progress.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "viewer_export/cli/messages.h"

namespace reemit::cli {

ProgressStyle progress_style(bool quiet, bool verbose) {
  if (quiet) return ProgressStyle::kSilent;
  if (::isatty(STDERR_FILENO) == 1) return ProgressStyle::kLine;
  return verbose ? ProgressStyle::kLines : ProgressStyle::kSilent;
}

namespace {

/// From one drawing to the next.
std::chrono::milliseconds pause_of(ProgressStyle style) {
  return std::chrono::milliseconds(style == ProgressStyle::kLine ? 200 : 5000);
}

/// Draws over what is there or writes a new line; returns the columns that are there now.
std::size_t draw(const std::string& line, ProgressStyle style, std::size_t drawn) {
  if (style == ProgressStyle::kLines) {
    print_error_text(line + '\n');
    return 0;
  }
  print_error_text(fmt::format("\r{:<{}}", line, drawn));
  return line.size();
}

void wipe(std::size_t drawn) {
  if (drawn > 0) print_error_text(fmt::format("\r{:<{}}\r", "", drawn));
}

}  // namespace

Progress::Progress(std::string what, ProgressStyle style, double quiet_seconds)
    : what_(std::move(what)),
      style_(style),
      next_(start_ +
            std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(quiet_seconds))) {}

Progress::~Progress() {
  finish();
}

void Progress::update(double done, const std::string& detail) {
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  constexpr double kLeastDone = 1e-3;  // less says nothing about the rest
  update(done, detail, done > kLeastDone && seconds > 1 ? seconds * (1 - done) / done : -1);
}

void Progress::update(double done, const std::string& detail, double seconds_left) {
  if (style_ == ProgressStyle::kSilent) return;
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + pause_of(style_);

  std::string line = fmt::format("{} {:3.0f} %", what_, 100 * std::clamp(done, 0.0, 1.0));
  if (!detail.empty()) line += ", " + detail;
  if (std::isfinite(seconds_left) && seconds_left >= 0) {
    line += fmt::format(", {} left", duration_text(seconds_left));
  }
  drawn_ = draw(line, style_, drawn_);
}

void Progress::begin_step(double done, const std::string& detail) {
  {
    const std::lock_guard lock(mutex_);
    next_ = Clock::now();
  }
  update(done, detail, -1);
}

void Progress::finish() {
  const std::lock_guard lock(mutex_);
  wipe(std::exchange(drawn_, 0));
}

WaitingLine::WaitingLine(std::string what, ProgressStyle style) : what_(std::move(what)), style_(style) {
  if (style_ == ProgressStyle::kSilent) return;
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error&) {
    // Without a thread to spare there is no line.
  }
}

WaitingLine::~WaitingLine() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  ends_.notify_one();
  thread_.join();
}

void WaitingLine::run() {
  const auto start = std::chrono::steady_clock::now();
  auto next = start + std::chrono::seconds(1);
  std::size_t drawn = 0;
  std::unique_lock lock(mutex_);
  while (!ends_.wait_until(lock, next, [this] { return over_; })) {
    const double seconds = std::chrono::duration<double>(next - start).count();
    drawn = draw(fmt::format("{}, {}", what_, duration_text(seconds)), style_, drawn);
    next += std::max<std::chrono::milliseconds>(pause_of(style_), std::chrono::seconds(1));
  }
  wipe(drawn);
}

std::string duration_text(double seconds) {
  const double whole = std::round(std::max(0.0, seconds));
  if (whole < 60) return fmt::format("{:.0f} s", whole);
  if (whole < 3600) return fmt::format("{:.0f} min {:02.0f} s", std::floor(whole / 60), std::fmod(whole, 60));
  return fmt::format("{:.0f} h {:02.0f} min", std::floor(whole / 3600),
                     std::floor(std::fmod(whole, 3600) / 60));
}

}  // namespace reemit::cli

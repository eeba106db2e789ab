#include "viewer_export/cli/progress.h"

#include <algorithm>
#include <cmath>
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

Progress::Progress(std::string what, ProgressStyle style) : what_(std::move(what)), style_(style) {}

Progress::~Progress() {
  finish();
}

void Progress::update(double done, const std::string& detail) {
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  update(done, detail, done > 0 && seconds > 1 ? seconds * (1 - done) / done : -1);
}

void Progress::update(double done, const std::string& detail, double seconds_left) {
  if (style_ == ProgressStyle::kSilent) return;
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + (style_ == ProgressStyle::kLine ? std::chrono::milliseconds(200) : std::chrono::seconds(5));

  std::string line = fmt::format("{} {:3.0f} %", what_, 100 * std::clamp(done, 0.0, 1.0));
  if (!detail.empty()) line += ", " + detail;
  if (std::isfinite(seconds_left) && seconds_left >= 0) {
    line += fmt::format(", {} left", duration_text(seconds_left));
  }
  if (style_ == ProgressStyle::kLines) {
    print_error_text(line + '\n');
  } else {
    print_error_text(fmt::format("\r{:<{}}", line, drawn_));
    drawn_ = line.size();
  }
}

void Progress::finish() {
  const std::lock_guard lock(mutex_);
  if (drawn_ == 0) return;
  print_error_text(fmt::format("\r{:<{}}\r", "", drawn_));
  drawn_ = 0;
}

std::string duration_text(double seconds) {
  const double whole = std::round(std::max(0.0, seconds));
  if (whole < 60) return fmt::format("{:.0f} s", whole);
  if (whole < 3600) return fmt::format("{:.0f} min {:02.0f} s", std::floor(whole / 60), std::fmod(whole, 60));
  return fmt::format("{:.0f} h {:02.0f} min", std::floor(whole / 3600),
                     std::floor(std::fmod(whole, 3600) / 60));
}

}  // namespace reemit::cli

#pragma once
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <thread>

namespace reemit::cli {

enum class ProgressStyle {
  kSilent,
  kLine,   ///< One line, rewritten in place: stderr is a terminal.
  kLines,  ///< A new line now and then, for logs.
};

/// A line on a terminal; lines for logs only when asked for (`verbose`); nothing when `quiet`.
ProgressStyle progress_style(bool quiet, bool verbose);

/// Progress of long work on stderr. update() may be called from any thread and as often as is convenient.
class Progress {
 public:
  /// Nothing is drawn in the first `quiet_seconds`: most rooms are read in less than a second.
  Progress(std::string what, ProgressStyle style, double quiet_seconds = 0);
  ~Progress();  ///< Wipes the line.
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` in [0,1]; `detail` such as "error 1.3 %, 12.1 Mrays/s"; `seconds_left` < 0 or not finite: not
  /// known yet.
  void update(double done, const std::string& detail, double seconds_left);
  /// The same with the time left estimated from the time since construction and `done`.
  void update(double done, const std::string& detail = {});
  /// Draws at once, however short ago the last one was: a new step begins.
  void begin_step(double done, const std::string& detail);
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  std::string what_;
  ProgressStyle style_;
  std::mutex mutex_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_ = start_;
  std::size_t drawn_ = 0;  // columns of the line on the terminal
};

/// Says on stderr, once it has taken a second, that work goes on of which nobody can tell how far it is, and
/// for how long: "reading hall.obj, 4 s". From a thread of its own, while it lives.
class WaitingLine {
 public:
  WaitingLine(std::string what, ProgressStyle style);
  ~WaitingLine();  ///< Wipes the line.
  WaitingLine(const WaitingLine&) = delete;
  WaitingLine& operator=(const WaitingLine&) = delete;

 private:
  void run();

  std::string what_;
  ProgressStyle style_;
  std::mutex mutex_;
  std::condition_variable ends_;
  bool over_ = false;
  std::thread thread_;
};

/// "35 s", "4 min 05 s" or "2 h 10 min".
std::string duration_text(double seconds);

}  // namespace reemit::cli

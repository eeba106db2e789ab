#pragma once
#include <chrono>
#include <exception>
#include <string>

#include "viewer_export/cli/command_options.h"

namespace reemit::cli {

/// With --verbose: a note at the end of a step, how long it took and how much memory the program has taken at
/// most by then. A step that throws ends without one.
class StepNote {
 public:
  StepNote(std::string step, const OutputStyle& style);
  ~StepNote();
  StepNote(const StepNote&) = delete;
  StepNote& operator=(const StepNote&) = delete;

 private:
  std::string step_;
  bool verbose_;
  int exceptions_ = std::uncaught_exceptions();
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace reemit::cli

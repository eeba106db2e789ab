#include "viewer_export/cli/step_note.h"

#include <utility>

#include <fmt/format.h>

#include "scenes/model/memory.h"
#include "scenes/model/stopwatch.h"
#include "viewer_export/cli/messages.h"

namespace reemit::cli {

StepNote::StepNote(std::string step, const OutputStyle& style)
    : step_(std::move(step)), verbose_(style.verbose && !style.quiet) {}

StepNote::~StepNote() {
  if (!verbose_ || std::uncaught_exceptions() > exceptions_) return;
  constexpr double kMegabyte = 1e6;
  const double seconds = seconds_since(start_);
  print_note(fmt::format("{} took {:.2f} s; memory so far at most {:.0f} MB", step_, seconds,
                         static_cast<double>(peak_memory()) / kMegabyte));
}

}  // namespace reemit::cli

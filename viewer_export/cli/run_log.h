#pragma once
#include <cstdio>
#include <filesystem>
#include <memory>

#include <nlohmann/json_fwd.hpp>

#include "solver/progressive_solver.h"

namespace reemit::cli {

/// The course of a solve as JSON lines (docs/command_line.md): one object at its start, one per batch, one at
/// its end. Every line is in the file when the call returns, so a run that is killed leaves a log that can be
/// read. A disk that fills up later costs the rest of the log and a warning, never the run.
class RunLog {
 public:
  /// What the first line says about the run.
  struct Run {
    std::filesystem::path room, solution;
    SolverSettings settings;
    std::size_t zones = 0;
    BandSet bands = BandSet::grey();
    bool goes_on = false;  ///< A run that was broken off: a log that is there is gone on with.
  };

  /// Throws InputError or OutputError unless a log can be created or replaced at `file`; of existing files
  /// only logs are replaced. Call it before long work; touches nothing.
  static void check(const std::filesystem::path& file, const std::filesystem::path& room,
                    const std::filesystem::path& solution);

  /// Replaces the file, unless the run goes on, and writes the first line. Throws OutputError when that
  /// cannot be done.
  RunLog(const std::filesystem::path& file, const Run& run);

  /// A batch, or for the matrix method a further hundredth of the work.
  void add(const SolveProgress& now);
  /// The last line.
  void finish(const Solution& solution);

 private:
  void write(const nlohmann::ordered_json& line);

  std::filesystem::path file_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_;
  bool matrix_;
  int hundredths_ = -1;  // of the work that the log has a line for
};

}  // namespace reemit::cli

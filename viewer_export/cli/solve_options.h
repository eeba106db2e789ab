#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include <CLI/CLI.hpp>

#include "mesh/model/mesh_settings.h"
#include "scenes/io/scene_reader.h"
#include "solver/progressive_solver.h"
#include "viewer_export/cli/command_options.h"

namespace reemit::cli {

/// What `reemit solve` was asked for.
struct SolveOptions {
  std::vector<std::filesystem::path>
      room;                      ///< Of a run that goes on: where its room is now, if it was moved.
  std::filesystem::path resume;  ///< Solution to go on from; empty: a new run.
  std::filesystem::path output;
  double checkpoint_s = SolveWatch{}.checkpoint_s;  ///< 0: none.
  ReadOptions read;
  MeshSettings mesh;
  std::optional<int> zones;  ///< Wanted in all; unset: as the method has it.
  SolverSettings solver;
  std::filesystem::path log;  ///< Empty: none.
  OutputStyle style;
};

/// Adds all options, with their groups and help, to the command; they set `options`, which must outlive it.
void add_solve_options(CLI::App& solve, SolveOptions& options);

/// Throws CLI::ValidationError where an option was given that the method has no use for.
void refuse_idle_options(const CLI::App& solve, SolveMethod method);

}  // namespace reemit::cli

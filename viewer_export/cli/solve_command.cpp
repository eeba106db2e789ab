#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/io/common/text_parse.h"
#include "scenes/model/error.h"
#include "scenes/model/interrupted.h"
#include "solver/progressive_solver.h"
#include "solver/solution/file_seal.h"
#include "solver/solution/solution_file.h"
#include "viewer_export/cli/command_options.h"
#include "viewer_export/cli/commands.h"
#include "viewer_export/cli/error_text.h"
#include "viewer_export/cli/interrupt.h"
#include "viewer_export/cli/loading.h"
#include "viewer_export/cli/messages.h"
#include "viewer_export/cli/output_path.h"
#include "viewer_export/cli/progress.h"
#include "viewer_export/cli/run_log.h"
#include "viewer_export/cli/solution_report.h"
#include "viewer_export/cli/solve_options.h"
#include "viewer_export/cli/step_note.h"
#include "viewer_export/cli/text_table.h"
#include "viewer_export/cli/thread_limit.h"

namespace reemit::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kDefaultErrorTarget = 0.02;
/// Zones aimed at without --zones: the time of the matrix grows with their square.
constexpr int kMatrixZoneCount = 2000;

bool has_stopping_rule(const SolverSettings& settings) {
  return settings.error_target > 0 || settings.time_limit_s > 0 || settings.packets > 0;
}

/// The matrix has an end of its own.
void refuse_stopping_rules(const SolverSettings& settings) {
  const char* given = settings.error_target > 0   ? "--error"
                      : settings.time_limit_s > 0 ? "--time"
                                                  : "--packets";
  throw InputError(given,
                   "is a stopping rule, and --method matrix has none: it ends when the system is solved",
                   "Leave it out.");
}

ProgressCallback progress_callback(Progress& progress, SolveMethod method) {
  if (method == SolveMethod::kMatrix)
    return [&progress](const SolveProgress& now) {
      progress.update(now.fraction, "form factors", now.seconds_left);
    };
  return [&progress](const SolveProgress& now) {
    if (now.examines) {
      progress.begin_step(1, "looking at how good it is");
      return;
    }
    progress.update(
        now.fraction,
        fmt::format("error {}, {:.3g} Mrays/s", percent_text(now.error), now.rays_per_second * 1e-6),
        now.seconds_left);
  };
}

/// A slip of the hand (the room twice, a table of measurements) must not cost a file that is not ours.
void check_solution_output(const std::filesystem::path& output, const std::filesystem::path& room) {
  check_output_file(output, room);
  const std::string extension = lower_case_extension(output);
  if (extension != ".h5" && extension != ".hdf5")
    throw InputError(output.string(), "a solution file ends in .h5 or .hdf5",
                     "write -o " + fs::path(output).replace_extension(".h5").string());
  if (fs::exists(output) && !fs::is_empty(output) && !ends_in_seal(output))
    throw InputError(output.string(), "exists and is not a solution, so it is not replaced",
                     "choose another output with -o, or remove the file if it is a solution cut short");
}

/// Where a run starts, and the room it is about.
struct Start {
  Scene scene;
  Solution solution;
};

/// The file as it is stored in a solution.
std::string stored_path(const fs::path& file) {
  return fs::absolute(file).lexically_normal().string();
}

/// Notes where the files of the room are.
void keep_room_paths(const std::vector<fs::path>& room, Solution& solution) {
  solution.room_path = stored_path(room.front());
  solution.more_room_paths.clear();
  for (std::size_t i = 1; i < room.size(); ++i) solution.more_room_paths.push_back(stored_path(room[i]));
}

Start new_run(const SolveOptions& options) {
  for (const fs::path& file : options.room)
    if (is_solution_file(file))
      throw InputError(file.string(), "it is a solution, and a new run begins with a room",
                       "Give the room, or go on with the solution: reemit solve --resume " + file.string());
  const bool matrix = options.solver.method == SolveMethod::kMatrix;
  if (matrix && has_stopping_rule(options.solver)) refuse_stopping_rules(options.solver);
  Start start{load_room(options.room, options.read, options.style), {}};
  if (!options.style.quiet) {
    print_warnings(start.scene.warnings);
    for (const std::string& note : start.scene.notes) print_note(note);
  }
  MeshSettings mesh_settings = options.mesh;
  if (options.zones) mesh_settings.default_zone_count = *options.zones;
  if (matrix) {
    if (!options.zones) mesh_settings.default_zone_count = kMatrixZoneCount;
    mesh_settings.exact_shapes = false;  // form factors are those of flat zones ...
    mesh_settings.share_zones = false;   // ... of one piece
  }
  MeshResult meshed = mesh_room(start.scene, mesh_settings, options.style);
  if (!options.style.quiet) print_warnings(meshed.report.warnings);

  SolverSettings settings = options.solver;
  if (matrix) settings.reemission = Reemission::kFromZones;  // what the linear system is of
  if (!matrix && !has_stopping_rule(settings)) {
    settings.error_target = kDefaultErrorTarget;
    if (!options.style.quiet)
      print_note(fmt::format("no stopping rule given; solving to --error {:g}%", 100 * kDefaultErrorTarget));
  }
  start.solution = new_solution(start.scene, std::move(meshed), settings);
  keep_room_paths(options.room, start.solution);
  start.solution.read_options = options.read;
  start.solution.mesh_settings = mesh_settings;
  return start;
}

/// A run that goes on by the rules given now, or else by its own.
Start resumed_run(const SolveOptions& options) {
  Start start;
  start.solution = load_solution(options.resume, options.style);
  SolverSettings& settings = start.solution.settings;
  if (settings.method == SolveMethod::kMatrix)
    throw InputError(options.resume.string(),
                     "was solved by the matrix method, which leaves nothing to go on with",
                     "Solve the room by --method shooting or walk.");
  start.scene = load_room_of(start.solution, options.resume, options.room, options.style);
  if (has_stopping_rule(options.solver)) {
    settings.error_target = options.solver.error_target;
    settings.time_limit_s = options.solver.time_limit_s;
    if (settings.time_limit_s > 0) settings.time_limit_s += start.solution.record.seconds;
    settings.packets = options.solver.packets;
  }
  settings.threads = options.solver.threads;
  if (!options.room.empty()) keep_room_paths(options.room, start.solution);
  return start;
}

/// Whether a run came to its end, with all that follows the last batch.
bool has_ended(const SolveRecord& record) {
  return record.stopped != StopReason::kUnderWay && record.stopped != StopReason::kInterrupted;
}

/// Whether a run that goes on would have nothing to do.
bool is_done(const SolveOptions& options, const Start& start) {
  if (!has_ended(start.solution.record)) return false;
  return !has_stopping_rule(options.solver) || rule_that_holds(start.scene, start.solution);
}

/// Saves a solution in one piece, with a line about it if that takes long.
void save(const Solution& solution, const SolveOptions& options) {
  const StepNote note("saving " + options.output.filename().string(), options.style);
  const WaitingLine saving("saving " + options.output.filename().string(),
                           progress_style(options.style.quiet, options.style.verbose));
  write_output([&] { save_solution(solution, options.output, Packing(&signal_arrived())); });
}

void report(const Scene& scene, const Solution& solution, const SolveOptions& options) {
  if (!options.style.quiet) {
    print_warnings(solution.light_warnings);
    if (solution.record.stopped == StopReason::kInterrupted)
      print_note(
          fmt::format("interrupted; the solution so far is in {}; go on with: reemit solve --resume {}",
                      options.output.string(), options.output.string()));
    print_warnings(solve_warnings(solution));
    const std::uint64_t asked = solution.settings.packets;
    // A run that goes on may have had more before it was asked for fewer.
    if (options.resume.empty() && asked > 0 && solution.record.packets > asked + asked / 2)
      print_note(fmt::format(
          "{} packets were sent, not {}: every zone or cell that emits sends one at least in each batch",
          solution.record.packets, asked));
    const std::string missed =
        missed_by_zones("gathered light", solution.settings.error_target, solution.record.gather_bias);
    if (!missed.empty()) print_note(missed);
  }
  if (options.style.json)
    print_json(solve_json(scene, solution, options.output));
  else
    print_result(solve_line(solution) + '\n');
}

/// The run at its start, with outputs that will not harm a file of the room.
Start begin_run(const SolveOptions& options) {
  const auto check_outputs = [&](const fs::path& room) {
    check_solution_output(options.output, room);
    if (!options.log.empty()) RunLog::check(options.log, room, options.output);
  };
  for (const fs::path& file : options.room) check_outputs(file);
  if (options.resume.empty()) return new_run(options);
  Start start = resumed_run(options);
  for (const std::string& file : room_files(start.solution)) check_outputs(file);
  return start;
}

void note_done(const Solution& solution, const SolveOptions& options) {
  if (options.style.quiet) return;
  print_note(
      fmt::format("{} is solved as far as its stopping rules ask for ({}); ask for more with --error, "
                  "--time or --packets",
                  options.resume.string(), to_string(solution.record.stopped)));
}

/// Solves, with lines that tell how far it is, the log and checkpoints.
Solution solve_with_progress(Start& start, const SolveOptions& options, std::optional<RunLog>& log,
                             InterruptGuard& interrupt) {
  const SolveMethod method = start.solution.settings.method;
  const ProgressStyle style = progress_style(options.style.quiet, options.style.verbose);
  std::optional<WaitingLine> preparation;
  Progress progress("solving", style);
  SolveWatch watch;
  watch.preparing = WorkWatch([&](double done) {
    if (done < 1) {
      preparation.emplace("building the tree for rays", style);
      return;
    }
    preparation.reset();
    interrupt.begin();
    progress.begin_step(0, method == SolveMethod::kMatrix ? "form factors" : "first batch");
  });
  const ProgressCallback show = progress_callback(progress, method);
  watch.progress = [&](const SolveProgress& now) {
    show(now);
    if (log) log->add(now);
  };
  if (options.checkpoint_s > 0) {
    watch.checkpoint_s = options.checkpoint_s;
    watch.checkpoint = [&](const Solution& solution) {
      progress.begin_step(0, "saving a checkpoint");
      try {
        write_output([&] { save_solution(solution, options.output, Packing(&signal_arrived())); });
      } catch (const OutputError& problem) {
        print_warnings({fmt::format("{}\n  The run goes on; the next checkpoint is tried in {:g} s.",
                                    problem.what(), options.checkpoint_s)});
      }
    };
  }
  const StepNote note(fmt::format("solving {} zones", start.solution.mesh.zone_count()), options.style);
  Solution solved = solve(start.scene, std::move(start.solution), watch, interrupt.requested());
  preparation.reset();
  progress.finish();
  return solved;
}

/// Ends a run that had nothing to add to the solution it was to go on from; `stopped`: why.
ExitCode leave_as_it_was(const Scene& scene, Solution solution, const SolveOptions& options,
                         StopReason stopped) {
  if (options.output != options.resume) save(solution, options);
  solution.record.stopped = stopped;
  report(scene, solution, options);
  return ExitCode::kDone;
}

ExitCode run_solve(const SolveOptions& options) {
  const ThreadLimit limit(options.solver.threads);
  Start start = begin_run(options);
  if (!options.resume.empty() && is_done(options, start)) {
    note_done(start.solution, options);
    const StopReason stopped = start.solution.record.stopped;
    return leave_as_it_was(start.scene, std::move(start.solution), options, stopped);
  }
  std::optional<RunLog> log;
  if (!options.log.empty())
    log.emplace(options.log,
                RunLog::Run{start.solution.room_path, options.output, start.solution.settings,
                            start.solution.mesh.zone_count(), start.scene.bands, !options.resume.empty()});
  // Before the first batch there is nothing to keep.
  InterruptGuard interrupt(InterruptGuard::kLater);
  const SolveRecord before = start.solution.record;
  Solution solution = solve_with_progress(start, options, log, interrupt);
  if (log) log->finish(solution);
  // A part of a batch, of unknown error, is better than nothing, but not than what is there.
  std::error_code code;
  if (solution.record.stopped == StopReason::kInterrupted && solution.record.cut_off &&
      (solution.record.rays == 0 || fs::exists(options.output, code)))
    throw Interrupted("interrupted in the first batch");
  if (!options.resume.empty() && has_ended(before) && !before.cut_off &&
      solution.record.packets == before.packets) {
    if (solution.record.stopped == StopReason::kInterrupted)
      throw Interrupted("interrupted before a further batch was done");
    // What follows the last batch was taken out to go on, and there was no time to do it again.
    const StopReason stopped = solution.record.stopped;
    solution = load_solution(options.resume, options.style);
    if (!options.room.empty()) keep_room_paths(options.room, solution);
    if (!options.style.quiet)
      print_note(
          "there was no time for another batch of packets; the solution stays as it was (give it more "
          "--time)");
    return leave_as_it_was(start.scene, std::move(solution), options, stopped);
  }
  save(solution, options);
  report(start.scene, solution, options);
  return ExitCode::kDone;
}

}  // namespace

void add_solve_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<SolveOptions>();
  CLI::App& solve =
      *program.add_subcommand("solve", "Solve the light in a room and keep it in a solution file");
  add_solve_options(solve, *options);
  solve.callback([options, &solve, &action] {
    if (options->resume.empty()) refuse_idle_options(solve, options->solver.method);
    if (options->resume.empty() && options->room.empty()) throw CLI::RequiredError("ROOM or --resume");
    if (options->output.empty()) options->output = options->resume;
    if (options->output.empty()) throw CLI::RequiredError("--output");
    action = [options] { return run_solve(*options); };
  });
}

}  // namespace reemit::cli

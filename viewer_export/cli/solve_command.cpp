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
#include "solver/progressive_solver.h"
#include "solver/solution/file_seal.h"
#include "solver/solution/solution_file.h"
#include "viewer_export/cli/command_options.h"
#include "viewer_export/cli/commands.h"
#include "viewer_export/cli/error_text.h"
#include "viewer_export/cli/interrupt.h"
#include "viewer_export/cli/loading.h"
#include "viewer_export/cli/messages.h"
#include "viewer_export/cli/option_values.h"
#include "viewer_export/cli/output_path.h"
#include "viewer_export/cli/progress.h"
#include "viewer_export/cli/run_log.h"
#include "viewer_export/cli/solution_report.h"
#include "viewer_export/cli/step_note.h"
#include "viewer_export/cli/text_table.h"
#include "viewer_export/cli/thread_limit.h"

namespace reemit::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kDefaultErrorTarget = 0.02;
/// Zones aimed at without --zones: the time of the matrix grows with their square.
constexpr int kMatrixZoneCount = 2000;

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

double parse_checkpoint(const std::string& text) {
  return text == "0" ? 0 : parse_seconds(text);
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
bool is_done(const SolveOptions& options, Start& start) {
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
    if (asked > 0 && solution.record.packets > asked + asked / 2)
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
      write_output([&] { save_solution(solution, options.output, Packing(&signal_arrived())); });
    };
  }
  const StepNote note(fmt::format("solving {} zones", start.solution.mesh.zone_count()), options.style);
  Solution solved = solve(start.scene, std::move(start.solution), watch, interrupt.requested());
  preparation.reset();
  progress.finish();
  return solved;
}

/// Ends a run that had nothing to add to the solution it was to go on from.
ExitCode leave_as_it_was(const Scene& scene, const Solution& solution, const SolveOptions& options) {
  if (options.output != options.resume) save(solution, options);
  report(scene, solution, options);
  return ExitCode::kDone;
}

ExitCode run_solve(const SolveOptions& options) {
  const ThreadLimit limit(options.solver.threads);
  Start start = begin_run(options);
  if (!options.resume.empty() && is_done(options, start)) {
    note_done(start.solution, options);
    return leave_as_it_was(start.scene, start.solution, options);
  }
  std::optional<RunLog> log;
  if (!options.log.empty())
    log.emplace(options.log, RunLog::Run{start.solution.room_path, options.output, start.solution.settings,
                                         start.solution.mesh.zone_count(), start.scene.bands});
  // Before the first batch there is nothing to keep.
  InterruptGuard interrupt(InterruptGuard::kLater);
  const SolveRecord before = start.solution.record;
  Solution solution = solve_with_progress(start, options, log, interrupt);
  if (log) log->finish(solution);
  if (!options.resume.empty() && has_ended(before) && !before.cut_off &&
      solution.record.packets == before.packets) {
    // What follows the last batch was taken out to go on, and there was no time to do it again.
    solution = load_solution(options.resume, options.style);
    if (!options.room.empty()) keep_room_paths(options.room, solution);
    if (!options.style.quiet)
      print_note(
          "there was no time for another batch of packets; the solution stays as it was (give it more "
          "--time)");
    return leave_as_it_was(start.scene, solution, options);
  }
  save(solution, options);
  report(start.scene, solution, options);
  return ExitCode::kDone;
}

constexpr const char* kSolveFooter =
    "The run ends when the first stopping rule holds; without any it is --error 2%. Ctrl-C ends it "
    "cleanly\n"
    "and keeps the solution so far (--method matrix has none before its end); a second Ctrl-C ends it\n"
    "at once.\n"
    "Examples:\n"
    "  reemit solve room.json -o room.h5 --error 1% --time 2min\n"
    "  reemit solve materials.mgf room.mgf lamps.mgf -o office.h5\n"
    "  reemit solve office.gltf -o office.h5 --emissive-units W/sr/m2 --packets 1e7 --seed 7\n"
    "  reemit solve --resume office.h5 --error 0.5%\n"
    "How to write a room: docs/room_format.md; what the solution holds: docs/solution_file.md";

void add_file_options(CLI::App& solve, SolveOptions& options) {
  solve
      .add_option("room", options.room,
                  "Room file: .json .obj .gltf .glb .mgf; several .mgf files are read in order\n"
                  "as one room. With --resume only if the room is no longer where it was")
      ->type_name("ROOM");
  solve
      .add_option("-o,--output", options.output,
                  "Solution file to write (HDF5): .h5 or .hdf5; replaces a solution, nothing else\n"
                  "(default with --resume: the same file)")
      ->type_name("SOLUTION");
  solve
      .add_option("--resume", options.resume,
                  "Go on with a solution that is finished, was interrupted or was killed after a\n"
                  "checkpoint, by the stopping rules given now or else by its own (--time given\n"
                  "now counts from what stands, else for all sittings). The result is that of one run\n"
                  "without a break; batches keep the size that --packets of the first sitting gave them")
      ->type_name("SOLUTION");
  add_parsed_option(solve, "--checkpoint", options.checkpoint_s, parse_checkpoint, "TIME",
                    "Save what stands at these intervals, for --resume: 30s, 10min; 0 = never")
      ->default_str("10min");
}

void add_stopping_rules(CLI::App& solve, SolverSettings& settings) {
  solve.option_defaults()->group("Stopping rules");
  add_parsed_option(solve, "--error", settings.error_target, parse_share, "SHARE",
                    "Stop at this relative standard error of radiosity (area-weighted rms over zones,\n"
                    "worst band): 1% or 0.01");
  add_parsed_option(solve, "--time", settings.time_limit_s, parse_seconds, "TIME",
                    "Stop after this wall time: 60, 60s, 2min, 1h");
  add_parsed_option(
      solve, "--packets", settings.packets, parse_count, "N",
      "Stop after this many packets, equal parts of the power of all luminaires: 250000 or 1e6;\n"
      "more where every zone that emits sends its one in each of 16 batches");
}

void add_method_options(CLI::App& solve, SolverSettings& settings) {
  solve.option_defaults()->group("Method");
  add_choice_option<SolveMethod>(
      solve, "--method", settings.method,
      {{"shooting", SolveMethod::kShooting}, {"walk", SolveMethod::kWalk}, {"matrix", SolveMethod::kMatrix}},
      "shooting (absorb and re-emit) or walk (Russian roulette); matrix: exact form\n"
      "factors and a linear system, a reference for up to 16384 zones, without\n"
      "stopping rules");
  add_choice_option<SamplingKind>(solve, "--sampling", settings.sampling,
                                  {{"sobol", SamplingKind::kSobol}, {"random", SamplingKind::kRandom}},
                                  "Points and directions of packets: low-discrepancy or random");
  add_choice_option<Reemission>(
      solve, "--reemit", settings.reemission,
      {{"hits", Reemission::kFromHits}, {"zones", Reemission::kFromZones}},
      "Where zones send on the light they reflect: from where it met them, or evenly\n"
      "over each zone, which is what --method matrix solves (to compare with it)");
  add_choice_option<DirectSource>(
      solve, "--direct", settings.direct,
      {{"best", DirectSource::kBest}, {"packets", DirectSource::kPackets}},
      "How --method shooting finds the direct light of zones: by shadow rays where a look\n"
      "at the room says that this pays, or by packets in any case (to compare with them)");
  add_seed_and_threads(solve, settings.seed, settings.threads);
}

void add_room_group(CLI::App& solve, SolveOptions& options) {
  solve.option_defaults()->group("Room");
  const auto zone_count = [](const std::string& text) {
    return static_cast<int>(parse_integer(text, 1, 100'000'000));
  };
  CLI::Option* zones = add_parsed_option(
      solve, "--zones", options.zones, zone_count, "N",
      "About how many zones the room is cut into (default: 8000, 2000 for --method matrix)");
  add_parsed_option(solve, "--zone-area", options.mesh.zone_area, parse_positive, "M2",
                    "Cut large faces into zones of at most this area [m2] instead")
      ->excludes(zones);
  solve.add_flag("--two-sided", options.read.force_two_sided,
                 "Let every face reflect on both sides (rooms with mixed winding)");
  add_read_options(solve, options.read);
  add_sky_options(solve, options.read);
}

void add_output_group(CLI::App& solve, SolveOptions& options) {
  solve.option_defaults()->group("Output");
  solve
      .add_option("--log", options.log,
                  "Log of error over time: one JSON object per line and batch, written as the run goes")
      ->type_name("FILE");
  add_json_option(solve, options.style);
  add_progress_options(solve, options.style);
}

/// Refuses with --resume what is settled by the run that goes on.
void exclude_from_resume(CLI::App& solve) {
  CLI::Option* resume = solve.get_option("--resume");
  // A run has one of each from its first batch to its last.
  for (const char* settled :
       {"--method", "--sampling", "--reemit", "--direct", "--seed", "--zones", "--zone-area", "--two-sided",
        "--bands", "--emissive-units", "--gltf-light-efficacy", "--sky", "--sun"})
    resume->excludes(solve.get_option(settled));
}

}  // namespace

void add_solve_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<SolveOptions>();
  CLI::App& solve =
      *program.add_subcommand("solve", "Solve the light in a room and keep it in a solution file");
  solve.footer(kSolveFooter);
  add_file_options(solve, *options);
  add_stopping_rules(solve, options->solver);
  add_method_options(solve, options->solver);
  add_room_group(solve, *options);
  add_output_group(solve, *options);
  exclude_from_resume(solve);
  solve.callback([options, &action] {
    if (options->resume.empty() && options->room.empty()) throw CLI::RequiredError("ROOM or --resume");
    if (options->output.empty()) options->output = options->resume;
    if (options->output.empty()) throw CLI::RequiredError("--output");
    action = [options] { return run_solve(*options); };
  });
}

}  // namespace reemit::cli

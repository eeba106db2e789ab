#include "viewer_export/cli/solve_options.h"

#include <string>

#include <fmt/format.h>

#include "scenes/io/common/text_parse.h"
#include "viewer_export/cli/option_values.h"

namespace reemit::cli {
namespace {

double parse_checkpoint(const std::string& text) {
  return text == "0" ? 0 : parse_seconds(text);
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

void add_solve_options(CLI::App& solve, SolveOptions& options) {
  solve.footer(kSolveFooter);
  add_file_options(solve, options);
  add_stopping_rules(solve, options.solver);
  add_method_options(solve, options.solver);
  add_room_group(solve, options);
  add_output_group(solve, options);
  exclude_from_resume(solve);
}

void refuse_idle_options(const CLI::App& solve, SolveMethod method) {
  std::vector<const char*> idle;
  if (method == SolveMethod::kMatrix) idle = {"--sampling", "--reemit", "--direct", "--checkpoint"};
  if (method == SolveMethod::kWalk) idle = {"--direct"};
  for (const char* option : idle)
    if (solve.count(option) > 0)
      throw CLI::ValidationError(
          option, fmt::format("has no effect on --method {}; leave it out", to_string(method)));
}

}  // namespace reemit::cli

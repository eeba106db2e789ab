#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/io/common/text_parse.h"
#include "scenes/io/common/up_direction.h"
#include "scenes/model/error.h"
#include "scenes/model/stopwatch.h"
#include "solver/losses/open_room.h"
#include "viewer_export/cli/command_options.h"
#include "viewer_export/cli/commands.h"
#include "viewer_export/cli/error_text.h"
#include "viewer_export/cli/interrupt.h"
#include "viewer_export/cli/loading.h"
#include "viewer_export/cli/messages.h"
#include "viewer_export/cli/option_values.h"
#include "viewer_export/cli/output_path.h"
#include "viewer_export/cli/progress.h"
#include "viewer_export/cli/solution_report.h"
#include "viewer_export/cli/text_table.h"
#include "viewer_export/cli/thread_limit.h"
#include "viewer_export/points/measured_light.h"
#include "viewer_export/points/points_csv.h"

namespace reemit::cli {
namespace {

/// The four words of --grid.
using GridWords = std::tuple<std::string, std::string, std::string, std::string>;

struct MeasureOptions {
  std::filesystem::path solution;
  std::vector<std::filesystem::path> room;
  std::vector<std::filesystem::path> points;
  std::vector<GridWords> grids;
  std::optional<std::filesystem::path> output;
  MeasureSettings settings;
  OutputStyle style;
};

/// NxM. Throws std::invalid_argument.
std::array<int, 2> parse_fields(const std::string& text) {
  try {
    const PixelSize fields = parse_size(text);
    return {fields.width, fields.height};
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument(fmt::format("'{}' is not two numbers of fields NxM, as in 8x10", text));
  }
}

/// Throws std::invalid_argument.
PointGrid grid_of(const GridWords& words) {
  const auto& [corner, along, across, fields] = words;
  const auto [fields_along, fields_across] = parse_fields(fields);
  return {parse_point(corner), parse_point(along), parse_point(across), fields_along, fields_across};
}

/// The grids, then the files, each in the order they were given.
std::vector<PointSet> point_sets(const MeasureOptions& options, const Vec3& up) {
  std::vector<PointSet> sets;
  for (const GridWords& words : options.grids) {
    const std::string name = options.grids.size() == 1 ? "grid" : fmt::format("grid {}", sets.size() + 1);
    try {
      sets.push_back(grid_points(name, grid_of(words), up));
    } catch (const std::invalid_argument& problem) {
      throw InputError("--grid", problem.what(),
                       "Give a corner [m], two sides from there and the number of fields along each, as\n"
                       "  --grid 0.5,0.85,0.5 4,0,0 0,0,5 8x10");
    }
  }
  for (const std::filesystem::path& file : options.points) {
    PointSet set = read_points(file);
    const auto has_name = [&](const PointSet& other) { return other.name == set.name; };
    if (std::any_of(sets.begin(), sets.end(), has_name)) set.name = file.string();
    sets.push_back(std::move(set));
  }
  return sets;
}

void check_output(const MeasureOptions& options) {
  if (!options.output) return;
  if (lower_case_extension(*options.output) != ".csv")
    throw InputError(options.output->string(), "points are written as .csv alone",
                     "Give a name that ends in .csv.");
  check_output_file(*options.output, options.solution);
  for (const std::filesystem::path& file : options.points) check_output_file(*options.output, file);
}

std::string dark_points_text(const MeasuredLight& light) {
  std::size_t dark = 0;
  std::optional<Vec3> first;
  for (std::size_t s = 0; s < light.sets.size(); ++s) {
    const std::vector<std::size_t>& of_set = light.summaries[s].dark_points;
    dark += of_set.size();
    if (!first && !of_set.empty()) first = light.sets[s].places[of_set.front()];
  }
  if (!first) return "";
  return fmt::format(
      "no ray found light at {} of the points, the first at ({:.6g}, {:.6g}, {:.6g}) m: do they lie inside "
      "of something, or face a wall that they lie on? Light through a small opening takes more --samples. "
      "Means and least values count them",
      dark, first->x(), first->y(), first->z());
}

void print_notes(const MeasuredLight& light, double error_target) {
  if (const std::string dark = dark_points_text(light); !dark.empty()) print_note(dark);
  if (light.limited_by_zones)
    print_note(light.has_photons ? kPhotonsTooNoisy : kZonesTooNoisy);
  else if (error_target > 0 && light.info.error > error_target)
    print_note("the error is above the target after the most rays that a point can get");
  if (const std::string missed = missed_by_zones("the points", error_target, light.info.zones);
      !missed.empty())
    print_note(missed);
}

std::string text_of(const MeasuredLight& light) {
  TextTable table;
  table.row({"points", "number", "mean E [lx]", "+-", "least", "most", "least/mean", "noise"});
  for (std::size_t s = 0; s < light.sets.size(); ++s) {
    const SetSummary& of_set = light.summaries[s];
    const auto [mean, error] = estimate_texts(of_set.mean, of_set.standard_error);
    table.row({light.sets[s].name, std::to_string(light.sets[s].size()), mean, error,
               number_text(of_set.least), number_text(of_set.most),
               fmt::format("{:.3f}", of_set.uniformity()), percent_text(of_set.error)});
  }
  return table.text();
}

nlohmann::ordered_json json_of(const MeasuredLight& light, const std::vector<std::string>& warnings) {
  auto sets = nlohmann::ordered_json::array();
  for (std::size_t s = 0; s < light.sets.size(); ++s) {
    const SetSummary& of_set = light.summaries[s];
    sets.push_back({{"name", light.sets[s].name},
                    {"points", light.sets[s].size()},
                    {"mean_illuminance", of_set.mean},
                    {"stderr_of_mean", of_set.standard_error},
                    {"least_illuminance", of_set.least},
                    {"most_illuminance", of_set.most},
                    {"uniformity", of_set.uniformity()},
                    {"dark_points", of_set.dark_points},
                    {"error", of_set.error}});
  }
  nlohmann::ordered_json json{{"sets", sets}, {"error", known_error(light.info)}, {"warnings", warnings}};
  add_zones(json, light.info.zones);
  return json;
}

ExitCode run_measure(const MeasureOptions& options) {
  const ThreadLimit limit(options.settings.threads);
  if (options.grids.empty() && options.points.empty())
    throw InputError("measure", "no points", "Give a --grid or a file of --points.");
  check_output(options);
  const Solution solution = load_solution(options.solution, options.style);
  const Scene scene = load_room_of(solution, options.solution, options.room, options.style);
  if (options.output) check_keeps_room(*options.output, scene);
  const std::vector<std::string> warnings = state_warnings(solution, options.solution);
  if (!options.style.quiet) print_warnings(warnings);
  std::vector<PointSet> sets = point_sets(options, up_direction(scene));
  Room room = build_room(scene, solution.mesh, options.style);
  if (is_open(solution.audit)) room.believe_misses();

  const auto start = std::chrono::steady_clock::now();
  const InterruptGuard interrupt;
  Progress progress("measuring", progress_style(options.style.quiet, options.style.verbose));
  const MeasuredLight light = measure_light(
      room, solution, std::move(sets), options.settings, [&progress](double done) { progress.update(done); },
      interrupt.requested());
  progress.finish();
  if (options.output) write_output([&] { write_points_csv(light, *options.output); });
  if (!options.style.quiet) print_notes(light, options.settings.error_target);
  const double seconds = seconds_since(start);
  if (options.style.json) {
    nlohmann::ordered_json json = json_of(light, warnings);
    if (options.output) json["file"] = options.output->string();
    json["seconds"] = seconds;
    print_json(json);
  } else {
    print_result(text_of(light));
    print_result(fmt::format("{}noise {}, zones {}, {:.2f} s\n",
                             options.output ? options.output->string() + ": " : "",
                             percent_text(known_error(light.info)), zones_text(light.info.zones), seconds));
  }
  return ExitCode::kDone;
}

void add_point_options(CLI::App& command, MeasureOptions& options) {
  command.option_defaults()->group("Points");
  command
      .add_option("--grid", options.grids,
                  "Middles of the fields of a parallelogram: a corner [m], its two sides from there [m],\n"
                  "and how many fields along each; may be given again. Points face upwards, those of\n"
                  "an upright grid along side x side")
      ->type_name("X,Y,Z X,Y,Z X,Y,Z NxM")
      ->allow_extra_args(false);
  command
      .add_option("--points", options.points,
                  "Points of a text file, one in a line: x y z [m] and the direction it faces; may be\n"
                  "given again")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command.option_defaults()->group("Values");
  auto* error = add_parsed_option(
      command, "--error", options.settings.error_target, parse_share, "SHARE",
      "Refine until the relative error (rms over points, worst band) is below; 0.5% unless a\n"
      "number of rays is given");
  add_integer_option(command, "--samples", options.settings.gather_rays, 1, 1048576,
                     "Gather rays per point, rounded up")
      ->excludes(error);
  add_integer_option(command, "--light-samples", options.settings.light_samples, 1, 65536,
                     "Shadow rays per point, rounded up; of up to 64 luminaires each gets so many")
      ->excludes(error);
  add_seed_and_threads(command, options.settings.seed, options.settings.threads);
}

}  // namespace

void add_measure_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<MeasureOptions>();
  CLI::App& command = *program.add_subcommand(
      "measure", "Say how much light falls on points of a working plane, or anywhere else in the air");
  command.footer(
      "Points are no part of the room and stand in nobody's light. On a surface they lie just before it.\n"
      "Examples:\n"
      "  reemit measure room.h5 --grid 0.5,0.85,0.5 4,0,0 0,0,5 8x10\n"
      "  reemit measure room.h5 --points sensors.txt -o sensors.csv --error 0.2%\n"
      "What is in each file: docs/export_formats.md");
  command.add_option("solution", options->solution, "Solution file")->required()->type_name("SOLUTION");
  command
      .add_option("-o,--output", options->output,
                  "Table of all points to write, .csv: illuminance [lx] and irradiance [W/m2] with errors")
      ->type_name("FILE");
  add_room_option(command, options->room);
  add_point_options(command, *options);
  command.option_defaults()->group("Output");
  add_json_option(command, options->style);
  add_progress_options(command, options->style);
  command.callback([options, &command, &action] {
    constexpr double kGoodToReport = 0.005;
    const auto is_given = [&](const char* option) { return command.count(option) > 0; };
    if (!is_given("--error") && !is_given("--samples") && !is_given("--light-samples"))
      options->settings.error_target = kGoodToReport;
    action = [options] { return run_measure(*options); };
  });
}

}  // namespace reemit::cli

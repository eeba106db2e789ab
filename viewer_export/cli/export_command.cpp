#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/model/error.h"
#include "scenes/model/stopwatch.h"
#include "solver/losses/open_room.h"
#include "viewer_export/cli/command_options.h"
#include "viewer_export/cli/commands.h"
#include "viewer_export/cli/error_text.h"
#include "viewer_export/cli/form_factor_export.h"
#include "viewer_export/cli/interrupt.h"
#include "viewer_export/cli/loading.h"
#include "viewer_export/cli/messages.h"
#include "viewer_export/cli/option_values.h"
#include "viewer_export/cli/output_path.h"
#include "viewer_export/cli/progress.h"
#include "viewer_export/cli/solution_report.h"
#include "viewer_export/cli/text_table.h"
#include "viewer_export/cli/thread_limit.h"
#include "viewer_export/formats/export_table.h"
#include "viewer_export/still/room_exposure.h"
#include "viewer_export/vertex/vertex_radiance.h"

namespace reemit::cli {
namespace {

struct ExportOptions {
  std::filesystem::path solution;
  std::vector<std::filesystem::path> room;
  std::vector<std::filesystem::path> outputs;  ///< At least one; all hold the same values.
  VertexSettings vertex;
  std::vector<std::string> surfaces;  ///< Names of those that are exported; empty: all.
  bool form_factors = false;
  bool photometric = false;                ///< Write lx and cd/m2 instead of W/m2 and W/(m2 sr).
  std::optional<bool> smooth;              ///< Unset: gathered vertices without an error target.
  const char* gathering_option = nullptr;  ///< One that was given and says how vertices are gathered.
  ToneMapSettings tone_map;
  OutputStyle style;
};

std::string worst_name(const VertexData& data) {
  return data.worst.surface.valid() ? data.surface_names[data.worst.surface.index()] : "";
}

/// Where one surface is known much worse than all together.
std::string worst_text(const VertexData& data) {
  constexpr double kMuch = 2;
  if (!(data.worst.error > kMuch * data.info.error)) return "";
  return fmt::format(" ({} on '{}')", percent_text(data.worst.error), worst_name(data));
}

void report(const ExportOptions& options, const VertexData& data, const std::vector<std::string>& warnings,
            bool interrupted, double seconds) {
  if (options.style.json) {
    auto files = nlohmann::ordered_json::array();
    for (const std::filesystem::path& output : options.outputs) files.push_back(output.string());
    nlohmann::ordered_json json{{"file", files.front()},
                                {"files", files},
                                {"values", data.gathered ? "gather" : "zones"},
                                {"vertices", data.vertex_count()},
                                {"triangles", data.triangles.size()},
                                {"smoothed", data.smoothed},
                                {"error", known_error(data.info)},
                                {"worst_surface", worst_name(data)},
                                {"worst_surface_error", data.worst.error},
                                {"seconds", seconds},
                                {"interrupted", interrupted},
                                {"warnings", warnings}};
    add_zones(json, data.info.zones);
    print_json(json);
    return;
  }
  std::string names;
  for (const std::filesystem::path& output : options.outputs)
    names += (names.empty() ? "" : ", ") + output.string();
  print_result(fmt::format("{}: {} vertices, {} triangles{}, noise {}{}, zones {}, {:.2f} s\n", names,
                           data.vertex_count(), data.triangles.size(), data.smoothed ? ", smoothed" : "",
                           percent_text(known_error(data.info)), worst_text(data),
                           zones_text(data.info.zones), seconds));
}

std::size_t dark_vertices(const VertexData& data) {
  const auto bands = static_cast<std::ptrdiff_t>(data.bands.count());
  std::size_t count = 0;
  for (auto first = data.irradiance.begin(); first != data.irradiance.end(); first += bands)
    if (std::all_of(first, first + bands, [](float e) { return e == 0; })) ++count;
  return count;
}

bool shows_colours(const ExportOptions& options) {
  return std::any_of(options.outputs.begin(), options.outputs.end(), [](const std::filesystem::path& output) {
    return export_format_of(output).shows_colours;
  });
}

/// Refuses what would have no effect on these values and formats.
void check_has_effect(const ExportOptions& options) {
  if (options.vertex.average_zones && options.gathering_option != nullptr)
    throw InputError(options.gathering_option, "means of zones are not gathered",
                     "leave it out, or gather (--values gather)");
  if (options.vertex.average_zones && options.smooth.value_or(false))
    throw InputError("--smooth on", "means of zones are not smoothed",
                     "leave it out, or gather (--values gather)");
  if (options.tone_map.exposure_ev && !shows_colours(options))
    throw InputError("--exposure", "no file of this export shows colours",
                     "leave it out, or write .ply or .glb");
}

/// What the colours of a file cannot show. A vertex has one value, so images on surfaces are as coarse as
/// vertices are; and it has the light that a surface scatters or emits, whatever is seen over it or through
/// it.
void note_what_colours_lack(const ExportOptions& options, const Scene& scene) {
  if (options.style.quiet || !shows_colours(options)) return;
  const auto count_of = [&](auto&& is_meant) {
    return std::count_if(scene.surfaces.begin(), scene.surfaces.end(),
                         [&](const Surface& surface) { return is_meant(scene.material_of(surface)); });
  };
  const auto specular = count_of([](const Material& m) {
    return m.non_diffuse.reflects_specularly() || m.non_diffuse.transmits_specularly();
  });
  if (specular > 0)
    print_note(
        fmt::format("{} surface(s) are mirrors, gloss, panes or glass, whose colours show what they scatter "
                    "alone: black and opaque where that is nothing",
                    specular));
  const auto cut_outs = count_of([](const Material& m) { return m.textures.is_cut_out(); });
  if (cut_outs > 0) print_note(fmt::format("{} surface(s) are cut-outs, which are exported whole", cut_outs));
  const auto count =
      count_of([](const Material& m) { return m.textures.reflectance || m.textures.emission; });
  if (count > 0)
    print_note(
        fmt::format("{} surface(s) have textures, of which colours show one value at each vertex; the "
                    "irradiance that is exported with them has none of the image in it",
                    count));
}

/// Refuses unknown formats, files that cannot be written and one file given twice before the work.
void check_outputs(const ExportOptions& options) {
  std::set<std::filesystem::path> seen;
  for (const std::filesystem::path& output : options.outputs) {
    export_format_of(output);
    if (options.photometric) check_photometric(output);
    check_output_file(output, options.solution);
    if (!seen.insert(std::filesystem::weakly_canonical(output)).second)
      throw InputError(output.string(), "the same output is given twice", "give each file once");
  }
}

/// Surfaces of this name, or parts of what has it: "desk" is also "desk/top".
void add_surfaces_named(const std::string& name, const std::vector<std::string>& names,
                        std::vector<SurfaceId>& found) {
  const std::size_t before = found.size();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name || names[i].starts_with(name + '/')) found.push_back(SurfaceId(i));
  if (found.size() == before)
    throw InputError("--surface " + name, "no surface of the room has this name",
                     "reemit info SOLUTION lists them; the name of an object stands for all its sides");
}

ExitCode run_export(const ExportOptions& options) {
  const ThreadLimit limit(options.vertex.threads);
  if (options.form_factors) {
    if (options.outputs.size() > 1)
      throw InputError("-o", fmt::format("{} files for form factors", options.outputs.size()),
                       "give one file with --form-factors");
    if (!options.room.empty())
      throw InputError("--room", "form factors are those of the mesh that the solution holds",
                       "leave it out");
    return export_form_factors(
        {options.solution, options.outputs.front(), options.vertex.seed, options.style});
  }
  check_outputs(options);
  check_has_effect(options);
  const Solution solution = load_solution(options.solution, options.style);
  const Scene scene = load_room_of(solution, options.solution, options.room, options.style);
  for (const std::filesystem::path& output : options.outputs) check_keeps_room(output, scene);
  note_what_colours_lack(options, scene);
  const std::vector<std::string> warnings = state_warnings(solution, options.solution);
  if (!options.style.quiet) print_warnings(warnings);
  VertexSettings settings = options.vertex;
  for (const std::string& name : options.surfaces)
    add_surfaces_named(name, solution.surface_names, settings.only);
  Room room = build_room(scene, solution.mesh, options.style);
  if (is_open(solution.audit)) room.believe_misses();

  const auto start = std::chrono::steady_clock::now();
  const InterruptGuard interrupt;
  Progress progress("gathering", progress_style(options.style.quiet, options.style.verbose));
  if (!options.vertex.average_zones) progress.begin_step(0, "looking at the zones");
  VertexData data = gather_vertices(
      room, solution, settings, [&progress](double done) { progress.update(done); }, interrupt.requested());
  progress.finish();
  if (shows_colours(options))
    data.tone_map =
        tone_map_of_room(room, solution, options.tone_map, options.vertex.threads, interrupt.requested());
  for (const std::filesystem::path& output : options.outputs)
    write_output([&] {
      if (options.photometric)
        write_photometric_data(data, output);
      else
        write_vertex_data(data, output);
    });

  if (data.limited_by_zones && !options.style.quiet) {
    print_note(kSamplesDoNotHelp);
  }
  if (const std::size_t dark = dark_vertices(data); dark > 0 && !options.style.quiet)
    print_note(fmt::format(
        "no light at all comes to {} vertices: they lie under what stands there, or in the dark; least "
        "values and means of rows hold them as 0",
        dark));
  const std::string missed = missed_by_zones("the vertices", options.vertex.error_target, data.info.zones);
  if (!missed.empty() && !options.style.quiet) print_note(missed);
  if (interrupt.requested() && !options.style.quiet) {
    print_note(data.gathered
                   ? "interrupted; vertices not yet reached hold the mean of their zones"
                   : "interrupted; all vertices hold the mean of their zones, which had less noise");
  }
  report(options, data, warnings, interrupt.requested(), seconds_since(start));
  return ExitCode::kDone;
}

std::string output_help() {
  std::string help =
      "File to write, the format by its extension; may be given again: all are written from one\n"
      "gathering. Formats:";
  for (const ExportFormat& format : export_formats()) {
    help += fmt::format("\n{}  {}", format.extension, format.description);
  }
  return help;
}

void add_value_options(CLI::App& command, ExportOptions& options) {
  command.option_defaults()->group("Values");
  auto* form_factors =
      command.add_flag("--form-factors", options.form_factors,
                       "Write the form factors between all zones instead, computed anew; formats:" +
                           form_factor_formats_help());
  form_factors->excludes(add_choice_option<bool>(
      command, "--values", options.vertex.average_zones, {{"gather", false}, {"zones", true}},
      "gather: direct light and final gather at each vertex; zones: the mean of the\n"
      "zones around it, quick and as coarse as the zones"));
  form_factors->excludes(add_choice_option<bool>(
      command, "--units", options.photometric, {{"W", false}, {"lx", true}},
      "W: radiance [W/(m2 sr)] and irradiance [W/m2] per band; lx: luminance [cd/m2] and\n"
      "illuminance [lx], .csv only"));
  auto* error =
      add_parsed_option(command, "--error", options.vertex.error_target, parse_share, "SHARE",
                        "Refine until the relative error (area-weighted rms over vertices, worst band) is\n"
                        "below: 1%");
  error->excludes(form_factors);
  form_factors->excludes(add_integer_option(command, "--samples", options.vertex.gather_rays, 1, 1048576,
                                            "Gather rays per vertex, rounded up")
                             ->excludes(error));
  form_factors->excludes(add_integer_option(command, "--light-samples", options.vertex.light_samples, 1,
                                            65536, "Shadow rays per vertex, rounded up")
                             ->excludes(error));
  form_factors->excludes(add_choice_option<std::optional<bool>>(
      command, "--smooth", options.smooth, {{"auto", std::nullopt}, {"on", true}, {"off", false}},
      "Take noise out: every vertex becomes a fit to those around it that agree within\n"
      "their noise; auto: gathered vertices without --error"));
  form_factors->excludes(
      command
          .add_option("--surface", options.surfaces,
                      "Vertices of this surface alone, or of all sides of this object; may be given\n"
                      "again")
          ->allow_extra_args(false)
          ->type_name("NAME"));
  form_factors->excludes(
      command.add_flag("--all-zones", options.vertex.all_zones,
                       "Keep the backs of surfaces that no light reached and that do not emit"));
  add_seed_and_threads(command, options.vertex.seed, options.vertex.threads);
  form_factors->excludes(
      add_parsed_option(command, "--exposure", options.tone_map.exposure_ev, parse_exposure, "EV",
                        "Exposure of displayable colours (PLY, GLB) in stops: radiance times 2^EV\n"
                        "(default: as the still from the first camera)"));
}

}  // namespace

void add_export_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App& command = *program.add_subcommand(
      "export",
      "Write radiance [W/(m2 sr)] and irradiance [W/m2] per band at every vertex, or the form factors");
  command.footer(
      "Examples:\n"
      "  reemit export room.h5 -o room.ply\n"
      "  reemit export room.h5 -o room.glb -o room.csv --error 1%\n"
      "  reemit export room.h5 -o room.csv --samples 1024\n"
      "  reemit export room.h5 -o lux.csv --units lx --surface desk\n"
      "  reemit export room.h5 -o quick.glb --values zones\n"
      "  reemit export room.h5 -o factors.csv --form-factors\n"
      "What is in each file: docs/export_formats.md");
  command.add_option("solution", options->solution, "Solution file")->required()->type_name("SOLUTION");
  command.add_option("-o,--output", options->outputs, output_help())
      ->required()
      ->allow_extra_args(false)
      ->type_name("FILE");
  add_room_option(command, options->room);

  add_value_options(command, *options);
  command.option_defaults()->group("Output");
  add_json_option(command, options->style);
  add_progress_options(command, options->style);
  command.callback([options, &command, &action] {
    for (const char* gathering : {"--samples", "--light-samples", "--error"})
      if (command.count(gathering) > 0) options->gathering_option = gathering;
    const bool is_gathered = !options->vertex.average_zones;
    options->vertex.smooth =
        options->smooth.value_or(is_gathered && options->vertex.error_target == 0) && is_gathered;
    action = [options] { return run_export(*options); };
  });
}

}  // namespace reemit::cli

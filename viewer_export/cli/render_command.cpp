#include <algorithm>
#include <cctype>
#include <chrono>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/io/images/image_library.h"
#include "scenes/model/error.h"
#include "scenes/model/memory.h"
#include "scenes/model/stopwatch.h"
#include "solver/losses/open_room.h"
#include "solver/progressive_solver.h"
#include "viewer_export/cli/camera_choice.h"
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
#include "viewer_export/cli/step_note.h"
#include "viewer_export/cli/text_table.h"
#include "viewer_export/cli/thread_limit.h"
#include "viewer_export/still/eye_place.h"
#include "viewer_export/still/image_file.h"
#include "viewer_export/still/render_still.h"

namespace reemit::cli {
namespace {

namespace fs = std::filesystem;

/// What a picture gets without a word about its quality: smoothed, this relative error, and at most so many
/// camera rays per pixel, the mean over the picture.
constexpr double kGoodToLookAt = 0.03;
constexpr double kMostMeanSpp = 64;

struct RenderOptions {
  std::vector<fs::path> files;  ///< A solution, or the files of a room.
  ReadOptions read;             ///< Of a room.
  std::vector<fs::path> room;   ///< Of a solution, if it was moved.
  fs::path output;
  std::string format;  ///< Of pictures in a folder: an extension with its dot.
  bool format_given = false;
  CameraOptions camera;
  PixelSize size;  ///< 0x0: as the camera says.
  StillSettings still;
  std::optional<bool> smooth;  ///< Unset: gathered pictures without an error target.
  int spp = 0;                 ///< 0: as the picture needs.
  ToneMapSettings tone_map;
  OutputStyle style;

  bool into_folder() const { return !output.has_filename() || fs::is_directory(output); }
};

/// One picture to make.
struct Job {
  Camera camera;
  fs::path file;
};

/// Camera names become file names: what a file system or a shell might trip over becomes an underscore.
std::string file_stem(const std::string& camera_name, std::set<std::string>& taken) {
  std::string stem = camera_name;
  for (char& c : stem) {
    const auto letter = static_cast<unsigned char>(c);
    if (letter < 128 && std::isalnum(letter) == 0 && c != '-' && c != '_' && c != '.') c = '_';
  }
  if (stem.empty() || stem.front() == '.') stem.insert(0, "_");
  std::string unique = stem;
  for (int i = 2; !taken.insert(unique).second; ++i) unique = fmt::format("{}-{}", stem, i);
  return unique;
}

std::vector<Job> plan(const RenderOptions& options, const std::vector<Camera>& cameras) {
  std::vector<Job> jobs;
  std::set<std::string> taken;
  for (const Camera& camera : cameras) {
    jobs.push_back({camera, options.into_folder()
                                ? options.output / (file_stem(camera.name, taken) + options.format)
                                : options.output});
  }
  return jobs;
}

/// Camera rays per pixel, the mean over the picture.
double mean_samples(const StillImage& image) {
  if (image.samples.empty()) return 0;
  return std::accumulate(image.samples.begin(), image.samples.end(), 0.0) /
         static_cast<double>(image.samples.size());
}

class Renderer {
 public:
  Renderer(const RenderOptions& options, const Room& room, const Solution& solution)
      : options_(options), room_(room), solution_(solution) {}

  void render(const Job& job) {
    const auto start = std::chrono::steady_clock::now();
    const auto [width, height] = picture_size(options_.still, job.camera);
    const StepNote note(fmt::format("rendering {} ({} x {} pixels)", job.camera.name, width, height),
                        options_.style);
    if (!options_.style.quiet) warn_of_eye(job.camera);
    Progress progress("rendering " + job.camera.name,
                      progress_style(options_.style.quiet, options_.style.verbose));
    progress.begin_step(0, "looking at the zones");
    const auto on_progress = [&progress](const StillProgress& now) {
      progress.update(now.fraction, fmt::format("error {}", percent_text(now.error)));
    };
    if (light_ == nullptr)
      light_ = StillLight::prepare(room_, solution_, options_.still, interrupt_.requested());
    const StillImage image = render_still(*light_, job.camera, on_progress, interrupt_.requested());
    progress.finish();
    std::optional<WrittenImage> written;
    write_output([&] { written = write_still_image(image, job.file, options_.tone_map); });
    if (!options_.style.quiet) explain_missed_target(job, image);
    report(job, image, *written, seconds_since(start));
  }

  bool interrupted() const { return interrupt_.requested(); }

  /// Prints the one document of --json.
  void finish(std::size_t wanted, const std::vector<std::string>& warnings) const {
    if (options_.style.json)
      print_json(nlohmann::ordered_json{
          {"pictures", pictures_}, {"pictures_wanted", wanted}, {"warnings", warnings}});
  }

 private:
  void warn_of_eye(const Camera& camera) const {
    const std::string badly_placed = eye_warning(camera, room_, solution_);
    if (!badly_placed.empty()) print_warnings({fmt::format("camera '{}': {}", camera.name, badly_placed)});
  }

  void explain_missed_target(const Job& job, const StillImage& image) const {
    // Of what smoothing leaves nobody knows how much is that of the zones.
    if (image.limited_by_zones)
      print_note(fmt::format(
          "{}: {}", job.camera.name,
          image.smoothed ? "more samples hardly lessen what smoothing leaves; give render an --error, which "
                           "samples until it holds"
          : options_.still.integrator == Integrator::kPath ? kPathsTooNoisy
                                                           : kSamplesDoNotHelp));
    // The rest is for those who named a target.
    if (options_.still.error_target == 0 || options_.still.most_mean_spp > 0) return;
    if (!image.limited_by_zones && image.info.error > options_.still.error_target && !interrupted())
      print_note(fmt::format("{}: the error is above the target after the most samples a pixel can get ({})",
                             job.camera.name, options_.still.most_spp));
    const std::string missed = missed_by_zones("the picture", options_.still.error_target, image.info.zones);
    if (!missed.empty()) print_note(fmt::format("{}: {}", job.camera.name, missed));
  }

  void report(const Job& job, const StillImage& image, const WrittenImage& written, double seconds) {
    const std::string integrator = to_string(options_.still.integrator);
    if (options_.style.json) {
      nlohmann::ordered_json picture{{"file", job.file.string()},
                                     {"camera", job.camera.name},
                                     {"width_px", image.width},
                                     {"height_px", image.height},
                                     {"integrator", integrator},
                                     {"samples_per_pixel", mean_samples(image)},
                                     {"smoothed", image.smoothed},
                                     {"error", known_error(image.info)},
                                     {"seconds", seconds},
                                     {"peak_memory_bytes", peak_memory()},
                                     {"interrupted", image.interrupted}};
      add_zones(picture, image.info.zones);
      if (written.tone_mapped) picture["exposure_ev"] = written.tone_map.exposure_ev();
      pictures_.push_back(std::move(picture));
      return;
    }
    print_result(fmt::format(
        "{}: camera {}, {}x{} px, {}, {:.4g} samples per pixel{}, noise {}, zones {}, {}{:.2f} s\n",
        job.file.string(), job.camera.name, image.width, image.height, integrator, mean_samples(image),
        image.smoothed ? ", smoothed" : "", percent_text(known_error(image.info)),
        zones_text(image.info.zones),
        written.tone_mapped ? fmt::format("exposure {:+.2f} EV, ", written.tone_map.exposure_ev()) : "",
        seconds));
  }

  const RenderOptions& options_;
  const Room& room_;
  const Solution& solution_;
  InterruptGuard interrupt_;
  std::unique_ptr<StillLight> light_;  ///< From the first picture on.
  nlohmann::ordered_json pictures_ = nlohmann::ordered_json::array();
};

/// What stills are made of.
struct Source {
  Scene scene;
  Solution solution;  ///< Without any batch, of a room that is not solved.
};

Source load_source(const RenderOptions& options) {
  const fs::path& file = options.files.front();
  if (options.files.size() == 1 && is_meant_as_solution(file)) {
    check_no_read_options(options.read, file);
    Solution solution = load_solution(file, options.style);
    Scene scene = load_room_of(solution, file, options.room, options.style);
    return {std::move(scene), std::move(solution)};
  }
  if (const auto solution = std::find_if(options.files.begin(), options.files.end(), is_meant_as_solution);
      solution != options.files.end())
    throw InputError(solution->string(), "it is a solution, and it is not the only file",
                     "Stills are made of one solution at a time.");
  if (options.still.integrator != Integrator::kPath)
    throw InputError(file.string(),
                     "is a room, and only --integrator path makes stills of one that is not solved",
                     "Solve it first: reemit solve " + file.string() + " -o " +
                         fs::path(file.filename()).replace_extension(".h5").string());
  if (!options.room.empty())
    throw InputError("--room", "it says where the room of a solution is, and a room is given itself",
                     "Leave it out.");
  Scene scene = load_room(options.files, options.read, options.style);
  if (!options.style.quiet) print_warnings(scene.warnings);
  // Nobody reads zones.
  MeshResult meshed = mesh_room(scene, MeshSettings{.share_zones = false}, options.style);
  if (!options.style.quiet) print_warnings(meshed.report.warnings);
  Solution solution = new_solution(scene, std::move(meshed), {});
  return {std::move(scene), std::move(solution)};
}

/// Of all pictures. Throws InputError if it is unknown, or where options would have no effect on it.
const ImageFormat& check_format(const RenderOptions& options, bool into_folder) {
  if (!into_folder && !options.output.has_extension())
    throw InputError(options.output.string(), "has no extension, from which the format follows",
                     fmt::format("Name it {0}.png, .exr or .hdr; a folder for several pictures ends with a "
                                 "slash: {0}/",
                                 options.output.string()));
  const ImageFormat& format = image_format_of(into_folder ? fs::path("a" + options.format) : options.output);
  if (options.tone_map.exposure_ev && !format.tone_mapped)
    throw InputError("--exposure", fmt::format("{} pictures hold radiance and have none", format.extension),
                     "leave it out, or write .png");
  if (options.format_given && !into_folder)
    throw InputError("--format", "it is for pictures in a folder, and -o names a file",
                     "leave it out, for the extension of the file says it, or end -o with a /");
  return format;
}

/// What the options leave open of it.
void choose_quality(RenderOptions& options) {
  StillSettings& still = options.still;
  const bool is_gathered = still.integrator == Integrator::kGather;
  if (still.integrator == Integrator::kZones && options.smooth.value_or(false))
    throw InputError("--smooth on", "pictures of zones have no grain to take out",
                     "leave it out, or gather (--integrator gather)");
  still.smooth = options.smooth.value_or(is_gathered && still.error_target == 0);
  if (options.spp > 0) {
    still.spp = options.spp;
  } else if (is_gathered && still.smooth && still.error_target == 0) {
    still.error_target = kGoodToLookAt;
    still.most_mean_spp = kMostMeanSpp;
  }
}

ExitCode run_render(RenderOptions options) {
  const ThreadLimit limit(options.still.threads);
  check_view(options.camera);
  if (options.still.integrator == Integrator::kZones && options.still.light_selection)
    throw InputError("--light-selection", "pictures of zones send no shadow rays",
                     "leave it out, or gather (--integrator gather)");
  const bool into_folder = options.into_folder();
  // Refuses what cannot be loaded before the work.
  if (check_format(options, into_folder).by_image_library) image_library();
  const auto check_output = [&](const fs::path& output) {
    for (const fs::path& file : options.files) check_output_file(output, file);
  };
  if (!into_folder) check_output(options.output);
  const auto [scene, solution] = load_source(options);
  Room room = build_room(scene, solution.mesh, options.style);
  if (is_open(solution.audit)) room.believe_misses();
  const std::vector<std::string> warnings = options.still.integrator == Integrator::kPath
                                                ? std::vector<std::string>()
                                                : state_warnings(solution, options.files.front());
  if (!options.style.quiet) print_warnings(warnings);
  const std::vector<Job> jobs = plan(options, choose_cameras(options.camera, room, into_folder));
  if (into_folder) make_output_directory(options.output);
  for (const Job& job : jobs) {
    check_output(job.file);
    check_keeps_room(job.file, scene);
  }

  options.still.width = options.size.width;
  options.still.height = options.size.height;
  choose_quality(options);
  Renderer renderer(options, room, solution);
  std::size_t done = 0;
  while (done < jobs.size() && !renderer.interrupted()) renderer.render(jobs[done++]);
  if (renderer.interrupted() && !options.style.quiet) {
    print_note(
        fmt::format("interrupted; {} of {} pictures written, the last one with the samples it had "
                    "(zone values where it had none)",
                    done, jobs.size()));
  }
  renderer.finish(jobs.size(), warnings);
  return done < jobs.size() ? ExitCode::kInterrupted : ExitCode::kDone;
}

/// The formats by their names: {"exr", ".exr"}.
Choices<std::string> format_choices() {
  Choices<std::string> choices;
  for (const ImageFormat& format : image_formats()) {
    choices.emplace_back(format.extension.substr(1), format.extension);
  }
  return choices;
}

std::string format_help() {
  std::string help = "Picture file, or a folder (ending in /) for one picture per camera. By extension:";
  for (const ImageFormat& format : image_formats()) {
    help += fmt::format("\n{}  {}", format.extension, format.description);
  }
  return help;
}

void add_view_options(CLI::App& render, RenderOptions& options) {
  render.option_defaults()->group("View");
  auto* camera =
      add_parsed_option(render, "--camera", options.camera.name, parse_word, "NAME|all",
                        "Camera of the room by name, or 'all' (default: the first; all into a folder).\n"
                        "A room without cameras has auto-1, auto-2, ... inside its free space");
  auto* eye = add_parsed_option(render, "--eye", options.camera.eye, parse_point, kPointType,
                                "A camera of its own: where it is [m]");
  eye->excludes(camera);
  auto* look_at = add_parsed_option(render, "--look-at", options.camera.look_at, parse_point, kPointType,
                                    "What it looks at [m]");
  look_at->needs(eye);
  eye->needs(look_at);
  add_parsed_option(render, "--up", options.camera.up, parse_direction, kPointType,
                    "Which way is up, with --eye (default: 0,0,1 for MGF rooms, else 0,1,0, or the other\n"
                    "of these where the room's cameras, its sky or its lamps say so)");
  render
      .add_option("--fov", options.camera.fov_deg,
                  "Full vertical field of view [deg], with --eye (default: 45)")
      ->check(CLI::Range(0.1, 179.0))
      ->type_name("DEG");
  add_parsed_option(render, "--size", options.size, parse_size, "WxH",
                    "Size of the picture [px] (default: as the camera says; 640x480 with --eye)");
}

void add_quality_options(CLI::App& render, RenderOptions& options) {
  render.option_defaults()->group("Light");
  add_choice_option<Integrator>(
      render, "--integrator", options.still.integrator,
      {{"gather", Integrator::kGather}, {"path", Integrator::kPath}, {"zones", Integrator::kZones}},
      "gather: direct light and final gather over the zones; path: path tracing, the\n"
      "unbiased reference, which needs no solution; zones: the zone values as they are");
  auto* error =
      add_parsed_option(render, "--error", options.still.error_target, parse_share, "SHARE",
                        "Refine until the relative error (rms over pixels, worst band) is below: 2%.\n"
                        "Default of smoothed pictures: 3%, or what 64 camera rays per pixel reach");
  add_integer_option(render, "--spp", options.spp, 1, 1048576,
                     "Camera rays for each pixel, rounded up to whole passes (default where nothing\n"
                     "is to be reached: 16)")
      ->default_str("")
      ->excludes(error);
  using Chosen = std::optional<Selection>;
  add_choice_option<Chosen>(render, "--light-selection", options.still.light_selection,
                            {{"auto", Chosen()},
                             {"constant", Chosen(Selection::kConstant)},
                             {"linear", Chosen(Selection::kLinear)},
                             {"spatial", Chosen(Selection::kSpatial)}},
                            "How a shadow ray chooses among luminaires: all alike, by what each sends if\n"
                            "nothing is in the way, or by a tree of them; auto: linear for few");
  add_seed_and_threads(render, options.still.seed, options.still.threads);

  render.option_defaults()->group("Picture");
  add_choice_option<std::optional<bool>>(
      render, "--smooth", options.smooth, {{"auto", std::nullopt}, {"on", true}, {"off", false}},
      "Take the grain out: every pixel becomes a mean of pixels around it that are the\n"
      "same within their noise, and --error counts what is left; auto: of gathered\n"
      "pictures, unless --error asks for pixels that are good by themselves");
  add_choice_option<PixelFilter>(render, "--filter", options.still.filter,
                                 {{"box", PixelFilter::kBox}, {"tent", PixelFilter::kTent}}, "Pixel filter");
  add_parsed_option(render, "--exposure", options.tone_map.exposure_ev, parse_exposure, "EV",
                    "Exposure of PNG in stops: radiance times 2^EV (default: from the picture)");
  add_choice_option(render, "--format", options.format, format_choices(), "Format of pictures in a folder");
}

}  // namespace

void add_render_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App& render = *program.add_subcommand(
      "render", "Make stills of a solved room from any viewpoint; by path tracing of any room");
  render.footer(
      "Examples:\n"
      "  reemit render room.h5 --camera all --format png -o pictures/\n"
      "  reemit render room.h5 --eye 1,1.6,4 --look-at 2,1.2,0 --size 1280x720 --error 1% -o view.exr\n"
      "  reemit render room.h5 --integrator path --spp 1024 -o reference.exr\n"
      "  reemit render room.gltf --integrator path --error 3% -o first_look.png");
  render
      .add_option("solution", options->files,
                  "Solution file; or a room (several .mgf files are one), with --integrator path")
      ->required()
      ->type_name("SOLUTION|ROOM");
  render.add_option("-o,--output", options->output, format_help())->required()->type_name("FILE|DIR/");
  add_room_option(render, options->room);
  render.add_flag("--two-sided", options->read.force_two_sided, "As of solve, for a room");
  add_read_options(render, options->read);
  add_view_options(render, *options);
  add_quality_options(render, *options);
  render.option_defaults()->group("Output");
  add_json_option(render, options->style);
  add_progress_options(render, options->style);
  render.callback([options, &render, &action] {
    options->format_given = render.count("--format") > 0;
    action = [options] { return run_render(*options); };
  });
}

}  // namespace reemit::cli

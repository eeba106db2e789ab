// Stills of rooms gathered and path traced, side by side on a sheet, and how far apart the two are:
// docs/images/mirrors_and_glass.jpg, docs/images/caustics.jpg and their tables in docs/materials.md;
// docs/images/textured_rooms.jpg and its table in docs/gather.md.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/contact_sheet.h"
#include "bench/hit_paths/block_comparison.h"
#include "bench/hit_paths/checked_picture.h"
#include "bench/program_options.h"
#include "bench/vector_option.h"
#include "scenes/io/scene_reader.h"
#include "scenes/model/stopwatch.h"
#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "solver/zoning/build_zones.h"
#include "viewer_export/still/default_cameras.h"
#include "viewer_export/still/render_still.h"

namespace {

using namespace reemit;

constexpr int kGap = 4;     // [px]
constexpr int kLabel = 18;  // [px]

struct Settings {
  std::vector<std::filesystem::path> rooms;
  std::filesystem::path output = "gathered_and_path_traced.jpg";
  std::string font = "DejaVuSans";
  int columns = 2;  // rooms side by side
  int width = 240;  // [px] of one picture
  int height = 180;
  std::uint64_t packets = 2'400'000;  // of each solution
  int spp = 32;                       // of each gathered still
  int path_spp = 128;                 // of each path-traced one
  int runs = 4;                       // of each, with random numbers and solutions of their own
  std::uint64_t seed = 1;
  int threads = 0;
  ReadOptions read;
  std::vector<double> eye, look_at, up{0, 1, 0};  // empty: a camera of the room
  double fov_deg = 45;
};

/// A mean over independent runs.
struct Mean {
  double value = 0;
  double stderr_of_value = 0;
};

Mean mean_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0;
  for (const double v : values) sum += v;
  double squares = 0;
  for (const double v : values) squares += (v - sum / n) * (v - sum / n);
  return {sum / n, std::sqrt(squares / (n * std::max(1.0, n - 1)))};
}

/// Stills of one view by one integrator.
struct Runs {
  StillImage picture;             // the mean of all
  std::vector<double> radiance;   // of each, the mean over pixels and bands [W/(m2 sr)]
  std::vector<double> caustic;    // of it what came from luminaires over mirrors, glass and gloss
  std::vector<double> variances;  // of each, the mean square of the pixels' standard errors
  double seconds = 0;             // in all
  hit_paths::CheckedPicture blocks;

  void add(const StillImage& image, int runs) {
    if (radiance.empty()) {
      picture = image;
      blocks = hit_paths::empty_picture(image.width, image.height, image.bands.count());
      std::fill(picture.radiance.begin(), picture.radiance.end(), 0.0F);
    }
    for (std::size_t i = 0; i < image.radiance.size(); ++i)
      picture.radiance[i] += image.radiance[i] / static_cast<float>(runs);
    hit_paths::add_still(image, 1, blocks);
    radiance.push_back(mean_over(image.radiance));
    caustic.push_back(mean_over(image.caustic));
    double squares = 0;
    for (const float e : image.radiance_stderr) squares += static_cast<double>(e) * static_cast<double>(e);
    variances.push_back(squares / static_cast<double>(image.radiance_stderr.size()));
  }

  /// Root mean square of the pixels' standard errors in one picture, over the mean of the picture.
  double noise() const { return std::sqrt(mean_of(variances).value) / mean_of(radiance).value; }

 private:
  static double mean_over(const std::vector<float>& layer) {
    double sum = 0;
    for (const float v : layer) sum += static_cast<double>(v);
    return layer.empty() ? 0 : sum / static_cast<double>(layer.size());
  }
};

struct View {
  std::string room;
  std::string camera;
  Runs gathered, path_traced;
};

Camera choose_camera(const Settings& settings, const Room& room) {
  if (!settings.eye.empty())
    return {"as given", bench::vector_of(settings.eye), bench::vector_of(settings.look_at),
            bench::vector_of(settings.up), settings.fov_deg};
  return room.scene().cameras.empty() ? default_cameras(room).front() : room.scene().cameras.front();
}

View render(const std::filesystem::path& file, const Settings& settings) {
  const std::atomic<bool> never{false};
  const Scene scene = read_scene(file, settings.read);
  const MeshResult mesh = build_zones(scene);
  const Room room(scene, mesh.mesh);
  const Camera camera = choose_camera(settings, room);
  View view{file.stem().string(), camera.name, {}, {}};
  for (int run = 0; run < settings.runs; ++run) {
    SolverSettings solver;
    solver.packets = settings.packets;
    solver.threads = settings.threads;
    solver.seed = settings.seed * static_cast<std::uint64_t>(settings.runs) + static_cast<std::uint64_t>(run);
    const Solution solution = solve_zones(scene, mesh, solver, {}, never);
    const Room walls(scene, solution.mesh);
    for (const Integrator integrator : {Integrator::kGather, Integrator::kPath}) {
      const bool is_path = integrator == Integrator::kPath;
      StillSettings still;
      still.width = settings.width;
      still.height = settings.height;
      still.spp = is_path ? settings.path_spp : settings.spp;
      still.integrator = integrator;
      still.seed = solver.seed;
      still.threads = settings.threads;
      Runs& runs = is_path ? view.path_traced : view.gathered;
      const auto start = std::chrono::steady_clock::now();
      runs.add(render_still(walls, solution, camera, still, {}, never), settings.runs);
      runs.seconds += seconds_since(start);
    }
  }
  return view;
}

/// How far the gathered mean is off, with its standard error, in percent.
std::string deviation(const std::vector<double>& gathered, const std::vector<double>& path_traced) {
  const Mean g = mean_of(gathered);
  const Mean p = mean_of(path_traced);
  if (!(p.value > 0)) return "-";
  return fmt::format("{:+.2f} +- {:.2f}", 100 * (g.value / p.value - 1),
                     100 * std::hypot(g.stderr_of_value, p.stderr_of_value) / p.value);
}

/// `path_per_gathered`: samples of a path-traced still over those of a gathered one.
void print(const View& v, double path_per_gathered) {
  const std::vector<hit_paths::BlockDeviation> blocks =
      hit_paths::compare_pictures(v.gathered.blocks, v.path_traced.blocks);
  const auto differ = [](const hit_paths::BlockDeviation& block) { return block.differs(); };
  const double path_noise = 100 * v.path_traced.noise();
  fmt::print("| {} | {} | {} | {} | {}; {:.1f}; {} | {:.1f}, {:.1f}, {:.1f} | {:.0f}, {:.0f} |\n", v.room,
             v.camera, deviation(v.gathered.radiance, v.path_traced.radiance),
             deviation(v.gathered.caustic, v.path_traced.caustic), blocks.size(),
             blocks.empty() ? 0 : std::abs(blocks.front().errors()),
             std::count_if(blocks.begin(), blocks.end(), differ), 100 * v.gathered.noise(), path_noise,
             path_noise * std::sqrt(path_per_gathered), v.gathered.seconds, v.path_traced.seconds);
  for (const hit_paths::BlockDeviation& block : blocks)
    if (block.differs())
      fmt::print(stderr, "{}: block at {}, {}: {:+.1f} % ({:+.1f} standard errors)\n", v.room, block.x,
                 block.y, 100 * block.relative(), block.errors());
  std::fflush(stdout);
}

void write_sheet(const Settings& settings) {
  const int room_width = 2 * (settings.width + kGap);
  const int room_height = settings.height + kLabel;
  const int rows = (static_cast<int>(settings.rooms.size()) + settings.columns - 1) / settings.columns;
  bench::ContactSheet sheet(settings.columns * room_width + kGap, rows * room_height + kGap, settings.font);
  fmt::print(
      "| room | camera | gathered against path traced, mean of the picture [%] | the same of its caustic "
      "part [%] | blocks of 16 x 16; largest deviation [standard errors]; beyond 5 and 3 % "
      "| noise of a pixel in one run: gathered, path traced, path traced with as many samples as gathered "
      "(by the square root) [%] | seconds of all runs |\n|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < settings.rooms.size(); ++i) {
    const View view = render(settings.rooms[i], settings);
    print(view, static_cast<double>(settings.path_spp) / static_cast<double>(settings.spp));
    const int left = static_cast<int>(i) % settings.columns * room_width + kGap;
    const int top = static_cast<int>(i) / settings.columns * room_height;
    const ToneMap tone_map = bench::tone_map_of(view.path_traced.picture);
    sheet.label(left, top + kLabel - 5, view.room);
    sheet.paste(left, top + kLabel, view.gathered.picture, tone_map);
    sheet.paste(left + settings.width + kGap, top + kLabel, view.path_traced.picture, tone_map);
  }
  sheet.write(settings.output);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  bench::ProgramOptions program("Stills of rooms, gathered and path traced, side by side and compared");
  program.add_option("rooms", settings.rooms, "Room files; their first camera, or one found automatically")
      .required()
      .existing_file();
  program.add_option("-o,--output", settings.output, "JPEG or PNG").show_default();
  program.add_option("--font", settings.font, "Of the labels, a name or file").show_default();
  program.add_option("--columns", settings.columns, "Rooms side by side").in_range(1, 20).show_default();
  program.add_option("--width", settings.width, "Of a picture [px]").in_range(16, 4096).show_default();
  program.add_option("--height", settings.height, "[px]").in_range(16, 4096).show_default();
  program.add_option("--packets", settings.packets, "Of each zone solution").show_default();
  program.add_option("--spp", settings.spp, "Camera rays per pixel of each gathered still")
      .in_range(1, 65536)
      .show_default();
  program.add_option("--path-spp", settings.path_spp, "Of each path-traced one")
      .in_range(1, 65536)
      .show_default();
  program.add_option("--runs", settings.runs, "Solutions and stills with random numbers of their own")
      .in_range(2, 64)
      .show_default();
  program.add_option("--seed", settings.seed).show_default();
  bench::ProgramOption eye =
      program.add_option("--eye", settings.eye, "A view of its own, of all rooms [m]").count(3);
  bench::ProgramOption look_at = program.add_option("--look-at", settings.look_at, "[m]").count(3).needs(eye);
  eye.needs(look_at);
  program.add_option("--up", settings.up).count(3).needs(eye).show_default();
  program.add_option("--fov", settings.fov_deg, "Vertical [deg]")
      .in_range(0.1, 179.0)
      .needs(eye)
      .show_default();
  program.add_option("--sky", settings.read.sky, "Of all rooms, as reemit solve has it");
  program.add_option("--sun", settings.read.sun, "Likewise");
  program.add_option("--threads", settings.threads, "0 = all cores").show_default();
  if (const auto exit_code = program.parse(argc, argv)) return *exit_code;
  try {
    write_sheet(settings);
  } catch (const std::exception& e) {
    fmt::print(stderr, "bench_gathered_and_path_traced: {}\n", e.what());
    return 1;
  }
  return 0;
}

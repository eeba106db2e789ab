// Contact sheet of rooms by zones of one size and by zones that fit the light, seen directly and gathered,
// beside path tracing: docs/images/zones.jpg.
#include <array>
#include <atomic>
#include <exception>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/contact_sheet.h"
#include "bench/program_options.h"
#include "scenes/io/scene_reader.h"
#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "solver/zoning/build_zones.h"
#include "viewer_export/still/default_cameras.h"
#include "viewer_export/still/render_still.h"

namespace {

using namespace reemit;

constexpr int kWidth = 240;  // [px] of one picture
constexpr int kHeight = 180;
constexpr int kGap = 4;
constexpr int kLabel = 18;
const std::atomic<bool> kNever{false};

struct Settings {
  std::vector<std::filesystem::path> rooms;
  std::filesystem::path output = "zones.jpg";
  std::string font = "DejaVuSans";
  double packets = 2e7;
  int zones = 8000;
  int spp = 64;
  int path_spp = 256;
};

Solution solved(const Scene& scene, const Settings& settings, bool fitting) {
  MeshSettings mesh;
  mesh.default_zone_count = settings.zones;
  mesh.share_zones = fitting;
  SolverSettings solver;
  solver.packets = static_cast<std::uint64_t>(settings.packets);
  return solve_zones(scene, build_zones(scene, mesh), solver, {}, kNever);
}

StillImage picture(const Room& room, const Solution& solution, const Camera& camera, Integrator integrator,
                   int spp) {
  StillSettings still;
  still.width = kWidth;
  still.height = kHeight;
  still.integrator = integrator;
  still.spp = spp;
  return render_still(room, solution, camera, still, {}, kNever);
}

/// A row: zones of one size, zones that fit, gathered from the one and from the other, path traced; all
/// exposed as the last but one.
void add_room(const Settings& settings, std::size_t row, bench::ContactSheet& sheet) {
  const std::filesystem::path& file = settings.rooms[row];
  const Scene scene = read_scene(file);
  const Solution even = solved(scene, settings, false);
  const Solution fitting = solved(scene, settings, true);
  const Room even_room(scene, even.mesh);
  const Room fitting_room(scene, fitting.mesh);
  const Camera camera = scene.cameras.empty() ? default_cameras(fitting_room).front() : scene.cameras.front();
  const std::array<StillImage, 5> pictures{
      picture(even_room, even, camera, Integrator::kZones, settings.spp),
      picture(fitting_room, fitting, camera, Integrator::kZones, settings.spp),
      picture(even_room, even, camera, Integrator::kGather, settings.spp),
      picture(fitting_room, fitting, camera, Integrator::kGather, settings.spp),
      picture(fitting_room, fitting, camera, Integrator::kPath, settings.path_spp)};
  const std::array<std::string, 5> labels{
      fmt::format("{}: {} zones, one size", file.stem().string(), even.mesh.zone_count()),
      fmt::format("{} zones that fit the light", fitting.mesh.zone_count()),
      "gathered from those of one size", "gathered from those that fit", "path traced"};
  const ToneMap tone_map = bench::tone_map_of(pictures[3]);
  const int top = static_cast<int>(row) * (kHeight + kLabel);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const int left = static_cast<int>(i) * (kWidth + kGap) + kGap;
    sheet.label(left, top + kLabel - 5, labels[i]);
    sheet.paste(left, top + kLabel, pictures[i], tone_map);
  }
  fmt::print("{}\n", file.stem().string());
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  bench::ProgramOptions program(
      "Contact sheet of rooms by zones of one size and by zones that fit the light");
  program.add_option("rooms", settings.rooms, "Room files").required();
  program.add_option("-o,--output", settings.output, "JPEG or PNG").show_default();
  program.add_option("--font", settings.font, "Of the labels, a name or file").show_default();
  program.add_option("--packets", settings.packets, "Of each solve").show_default();
  program.add_option("--zones", settings.zones, "Zones asked for").show_default();
  program.add_option("--spp", settings.spp, "Camera rays per pixel").show_default();
  program.add_option("--path-spp", settings.path_spp, "The same for path tracing").show_default();
  if (const auto exit_code = program.parse(argc, argv)) return *exit_code;
  try {
    bench::ContactSheet sheet(5 * (kWidth + kGap) + kGap,
                              static_cast<int>(settings.rooms.size()) * (kHeight + kLabel) + kGap,
                              settings.font);
    for (std::size_t i = 0; i < settings.rooms.size(); ++i) add_room(settings, i, sheet);
    sheet.write(settings.output);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
  return 0;
}

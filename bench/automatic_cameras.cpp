// Contact sheet of the automatic cameras of solved rooms, rooms with cameras of their own included:
// docs/images/automatic_cameras.jpg.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/contact_sheet.h"
#include "bench/program_options.h"
#include "scenes/model/stopwatch.h"
#include "solver/room/room.h"
#include "solver/solution/room_of_solution.h"
#include "solver/solution/solution_file.h"
#include "viewer_export/still/default_cameras.h"
#include "viewer_export/still/render_still.h"

namespace {

using namespace reemit;

constexpr int kWidth = 160;  // [px] of one picture
constexpr int kHeight = 120;
constexpr int kPictures = 3;  // of a room, at most
constexpr int kGap = 4;
constexpr int kLabel = 18;
constexpr int kRoomWidth = kPictures * kWidth + 3 * kGap;
constexpr int kRoomHeight = kLabel + kHeight;

struct Settings {
  std::vector<std::filesystem::path> solutions;
  std::filesystem::path output = "automatic_cameras.jpg";
  std::string font = "DejaVuSans";
  int columns = 2;  // rooms side by side
  int spp = 16;
  int threads = 0;
};

void add_room(const Settings& settings, std::size_t number, bench::ContactSheet& sheet) {
  const std::filesystem::path& file = settings.solutions[number];
  const int left = static_cast<int>(number) % settings.columns * kRoomWidth + kGap;
  const int top = static_cast<int>(number) / settings.columns * kRoomHeight;
  const Solution solution = load_solution(file);
  const Scene scene = read_room_of(solution, file);
  const Room walls(scene, solution.mesh);
  const auto start = std::chrono::steady_clock::now();
  const std::vector<Camera> cameras = default_cameras(walls);
  fmt::print("{}: {:.3f} s\n", file.stem().string(), seconds_since(start));
  sheet.label(left, top + kLabel - 5, file.stem().string());
  const std::atomic<bool> no_interrupt{false};
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Camera& camera = cameras[i];
    fmt::print("  {}: eye {:.3g},{:.3g},{:.3g} look-at {:.3g},{:.3g},{:.3g} up {:.2g},{:.2g},{:.2g}\n",
               camera.name, camera.eye.x(), camera.eye.y(), camera.eye.z(), camera.look_at.x(),
               camera.look_at.y(), camera.look_at.z(), camera.up.x(), camera.up.y(), camera.up.z());
    StillSettings still;
    still.width = kWidth;
    still.height = kHeight;
    still.spp = settings.spp;
    still.threads = settings.threads;
    const StillImage image = render_still(walls, solution, camera, still, {}, no_interrupt);
    sheet.paste(left + static_cast<int>(i) * (kWidth + kGap), top + kLabel, image, bench::tone_map_of(image));
  }
}

void write_sheet(const Settings& settings) {
  const int rows = (static_cast<int>(settings.solutions.size()) + settings.columns - 1) / settings.columns;
  bench::ContactSheet sheet(settings.columns * kRoomWidth + kGap, rows * kRoomHeight + kGap, settings.font);
  for (std::size_t i = 0; i < settings.solutions.size(); ++i) add_room(settings, i, sheet);
  sheet.write(settings.output);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  bench::ProgramOptions program("Contact sheet of the automatic cameras of solved rooms");
  program.add_option("solutions", settings.solutions, "Solution files; their names label the pictures")
      .required();
  program.add_option("-o,--output", settings.output, "JPEG or PNG").show_default();
  program.add_option("--font", settings.font, "Of the labels, a name or file").show_default();
  program.add_option("--columns", settings.columns, "Rooms side by side").in_range(1, 20).show_default();
  program.add_option("--spp", settings.spp, "Camera rays per pixel").show_default();
  program.add_option("--threads", settings.threads, "0 = all cores").show_default();
  if (const auto exit_code = program.parse(argc, argv)) return *exit_code;
  try {
    write_sheet(settings);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
  return 0;
}

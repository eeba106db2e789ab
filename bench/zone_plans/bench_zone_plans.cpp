// What zones that fit the light bring: the error of zones at points, of light gathered from them, of pictures
// and of exports, against their number and against time, for zones of one size and for those of build_zones.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/program_options.h"
#include "bench/zone_plans/export_check.h"
#include "bench/zone_plans/picture_check.h"
#include "bench/zone_plans/plan_plot.h"
#include "bench/zone_plans/plan_table.h"
#include "mesh/build_mesh.h"
#include "scenes/io/scene_reader.h"
#include "scenes/model/stopwatch.h"
#include "solver/gather/discretisation.h"
#include "solver/gather/zone_bias_estimate.h"
#include "solver/progressive_solver.h"
#include "solver/zoning/build_zones.h"

namespace {

using namespace reemit;
using namespace reemit::bench;

constexpr std::size_t kProbes = 16'384;
constexpr std::size_t kExportPoints = 8'192;
const std::atomic<bool> kNever{false};

struct Plan {
  bool fitting = false;
  int zones = 0;
};

MeshSettings mesh_settings(const Plan& plan) {
  MeshSettings mesh;
  mesh.default_zone_count = plan.zones;
  mesh.share_zones = plan.fitting;
  return mesh;
}

PlanRow measure(const Scene& scene, const Plan& plan, const SolverSettings& settings,
                const PictureCheck& pictures) {
  PlanRow row;
  row.fitting = plan.fitting;
  const auto start = std::chrono::steady_clock::now();
  MeshResult zones = build_zones(scene, mesh_settings(plan));
  row.zoning_s = seconds_since(start);
  const Solution s = solve_zones(scene, std::move(zones), settings, {}, kNever);
  const Room room(scene, s.mesh);
  const StopToken stop(kNever);
  row.zones = s.mesh.zone_count();
  row.lit = row.zones - s.record.unreached_zones;
  row.solve_s = s.record.seconds;
  row.rays_per_s = static_cast<double>(s.record.rays) / s.record.seconds;
  row.noise = s.record.error;
  row.points = discretisation_error(room, s, stop, kProbes).value_or(0);
  if (const auto gathered = estimate_zone_bias(RadianceField(room, s, ZoneSums::kGroups), s,
                                               ZoneBiasEffort::of(static_cast<double>(s.record.rays)), stop))
    row.gathered = gathered->rms;
  row.picture_zones = pictures.error(room, s);
  const ExportDifference exported = export_difference(room, s, kExportPoints);
  row.exported = exported.rms;
  row.wrong_area = exported.wrong_area;
  return row;
}

/// The two path-traced pictures are of the room, whatever its zones.
PictureCheck references(const Scene& scene, int spp) {
  const Solution unsolved = new_solution(scene, build_zones(scene, mesh_settings({false, 2000})), {});
  return {Room(scene, unsolved.mesh), unsolved, spp};
}

}  // namespace

int main(int argc, char** argv) {
  ProgramOptions app("Zones of one size against zones that fit the light, by their number or by time");
  std::vector<std::filesystem::path> rooms;
  std::vector<int> counts{500, 1000, 2000, 4000, 8000, 16000, 32000};
  std::vector<double> times;
  SolverSettings settings;
  settings.packets = 20'000'000;
  settings.gather_small_zones = false;
  bool only_fitting = false;
  int reference_spp = 1024;
  std::filesystem::path plot, table;
  const ProgramOption measured = app.add_option("rooms", rooms, "Room files");
  app.add_option("--zones", counts, "Numbers of zones to ask for").show_default();
  app.add_option("--packets", settings.packets, "Packets of each solve").show_default();
  app.add_option("--time", times, "Seconds of each solve instead: each of these for each number of zones");
  app.add_option("--reference-spp", reference_spp, "Camera rays per pixel of the path-traced pictures")
      .show_default();
  app.add_flag("--only-fitting", only_fitting, "Leave the zones of one size out");
  const ProgramOption drawn = app.add_option("--plot", plot, "Draw the errors with gnuplot, as SVG");
  app.add_option("--from-table", table,
                 "Measure nothing: draw a table that was printed before (with --time: by time)")
      .needs(drawn)
      .excludes(measured);
  if (const auto exit_code = app.parse(argc, argv)) return *exit_code;
  if (rooms.empty() && table.empty()) return app.exit_without("rooms");
  const bool by_time = !times.empty();
  if (by_time)
    settings.packets = 0;
  else
    times = {0};
  try {
    std::vector<PlanRow> rows;
    if (!table.empty()) {
      rows = read_plan_table(table);
      draw_plans(rows, by_time, plot);
      return 0;
    }
    fmt::print("{}", plan_table_head());
    for (const std::filesystem::path& file : rooms) {
      const Scene scene = read_scene(file);
      const PictureCheck pictures = references(scene, reference_spp);
      for (const bool fitting : {false, true}) {
        if (!fitting && only_fitting) continue;
        for (const int count : counts)
          for (const double time : times) {
            settings.time_limit_s = time;
            rows.push_back(measure(scene, {fitting, count}, settings, pictures));
            rows.back().room = file.stem().string();
            fmt::print("{}", row_text(rows.back()));
            std::fflush(stdout);
          }
      }
    }
    if (!plot.empty()) draw_plans(rows, by_time, plot);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
  return 0;
}

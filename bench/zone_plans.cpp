// What zones that fit the light bring: the error of zones at points and of light gathered from them, against
// their number, for zones of one size and for those of build_zones.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "mesh/build_mesh.h"
#include "scenes/io/scene_reader.h"
#include "solver/gather/discretisation.h"
#include "solver/gather/zone_bias_estimate.h"
#include "solver/progressive_solver.h"
#include "solver/zoning/build_zones.h"

namespace {

using namespace reemit;

constexpr std::size_t kProbes = 16'384;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void measure(const Scene& scene, const std::string& kind, const MeshSettings& mesh,
             const SolverSettings& settings) {
  const std::atomic<bool> never{false};
  const auto start = std::chrono::steady_clock::now();
  MeshResult zones = build_zones(scene, mesh);
  const double zoning = seconds_since(start);
  const Solution s = solve_zones(scene, std::move(zones), settings, {}, never);
  const Room room(scene, s.mesh);
  const StopToken stop(never);
  const auto points = discretisation_error(room, s, stop, kProbes);
  const auto gathered = estimate_zone_bias(room, s, stop);
  fmt::print("| {} | {} | {} | {:.2f} | {:.2f} | {:.3f} % | {} | {} |\n", kind, s.mesh.zone_count(),
             s.mesh.zone_count() - s.record.unreached_zones, zoning,
             static_cast<double>(s.record.rays) / s.record.seconds / 1e6, 100 * s.record.error,
             points ? fmt::format("{:.2f} %", 100 * *points) : "not known",
             gathered ? fmt::format("{:.2f} % (< {:.2f} %)", 100 * gathered->rms, 100 * gathered->bound)
                      : "not known");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Zones of one size against zones that fit the light, by their number");
  std::string room;
  std::vector<int> counts{500, 1000, 2000, 4000, 8000, 16000, 32000};
  SolverSettings settings;
  settings.packets = 20'000'000;
  settings.gather_small_zones = false;
  bool only_fitting = false;
  app.add_option("room", room, "Room file")->required();
  app.add_option("--zones", counts, "Numbers of zones to ask for")->capture_default_str();
  app.add_option("--packets", settings.packets, "Packets of each solve")->capture_default_str();
  app.add_option("--time", settings.time_limit_s, "Seconds of each solve instead");
  app.add_flag("--only-fitting", only_fitting, "Leave the zones of one size out");
  CLI11_PARSE(app, argc, argv);
  if (settings.time_limit_s > 0) settings.packets = 0;
  try {
    const Scene scene = read_scene(room);
    fmt::print(
        "{}, {}.\n\n| zones | number | lit | zoning [s] | Mray/s | noise | points differ from zones by | "
        "error in "
        "gathered light |\n|---|---|---|---|---|---|---|---|\n",
        room,
        settings.time_limit_s > 0 ? fmt::format("{} s", settings.time_limit_s)
                                  : fmt::format("{} packets", settings.packets));
    for (const bool fitting : {false, true}) {
      if (!fitting && only_fitting) continue;
      for (const int count : counts) {
        MeshSettings mesh;
        mesh.default_zone_count = count;
        mesh.share_zones = fitting;
        measure(scene, fitting ? "that fit the light" : "of one size", mesh, settings);
      }
    }
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
  return 0;
}

// Solves a room to 5 % and prints the irradiance of every surface: irradiance ROOM
#include <atomic>
#include <cstdio>
#include <exception>
#include <utility>

#include <reemit/mesh/zones/total_powers.h>
#include <reemit/scenes/io/scene_reader.h>
#include <reemit/solver/progressive_solver.h>
#include <reemit/solver/solution/mean_light.h>
#include <reemit/solver/zoning/build_zones.h>

int main(int argc, char** argv) try {
  reemit::Scene room = reemit::read_scene(argc > 1 ? argv[1] : "room.json");
  reemit::MeshResult zones = reemit::build_zones(room);
  // Of luminaires that overlap or stand on things.
  reemit::spread_total_powers(zones.report, zones.mesh, room);
  reemit::SolverSettings settings;
  settings.error_target = 0.05;
  const std::atomic<bool> interrupt{false};  // true from anywhere ends the run with what it has
  const reemit::Solution solution = reemit::solve(room, std::move(zones), settings, {}, interrupt);
  for (const reemit::SideLight& side : reemit::mean_light(solution).sides)
    for (std::size_t band = 0; side.counts && band < room.bands.count(); ++band)
      std::printf("%s\t%s\t%s\t%.8g W/m2\n", room.surfaces[side.surface.index()].name.c_str(),
                  side.front ? "front" : "back", room.bands.name(band).c_str(),
                  side.light.irradiance[band].mean);
} catch (const std::exception& problem) {
  std::fprintf(stderr, "irradiance: %s\n", problem.what());
  return 2;
}

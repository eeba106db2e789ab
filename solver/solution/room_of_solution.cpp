#include "solver/solution/room_of_solution.h"

#include <algorithm>

#include "mesh/zones/total_powers.h"
#include "scenes/io/scene_reader.h"
#include "scenes/model/error.h"

namespace reemit {
namespace fs = std::filesystem;
namespace {

fs::path find_room_file(const fs::path& stored, const fs::path& solution_file) {
  std::error_code code;
  if (fs::exists(stored, code)) return stored;
  const fs::path beside = solution_file.parent_path() / stored.filename();
  if (stored.has_filename() && fs::exists(beside, code)) return beside;
  throw InputError(solution_file.string(),
                   stored.empty() ? "it does not say which room it was solved from"
                                  : "the room it was solved from is gone: " + stored.string(),
                   "Put the room file back, or beside the solution, or name it (render and export: --room).");
}

std::vector<fs::path> find_room(const Solution& solution, const fs::path& solution_file,
                                const std::vector<fs::path>& override) {
  if (!override.empty()) return override;
  std::vector<fs::path> files;
  for (const std::string& stored : room_files(solution))
    files.push_back(find_room_file(stored, solution_file));
  return files;
}

// The hash says that the rooms are the same; what is left to check are numbers of the solution file itself.
bool fits(const Solution& solution, const Scene& scene) {
  if (!(solution.bands == scene.bands) || solution.surface_names.size() != scene.surfaces.size())
    return false;
  // Shapes may have become faces, which are numbered after those of the room.
  const auto has_face = [&scene](const SurfaceFace& f) {
    if (f.surface.index() >= scene.surfaces.size()) return false;
    const Surface& surface = scene.surfaces[f.surface.index()];
    return f.face < surface.faces.size() || !surface.shapes.empty();
  };
  const auto& triangles = solution.mesh.base().triangles;
  const auto& backs = solution.mesh.base().backs;
  return std::all_of(triangles.begin(), triangles.end(),
                     [&](const BaseTriangle& t) {
                       if (!t.is_curved()) return has_face({t.surface, t.face});
                       return t.surface.index() < scene.surfaces.size() &&
                              t.face < scene.surfaces[t.surface.index()].shapes.size();
                     }) &&
         std::all_of(backs.begin(), backs.end(),
                     [&](const SurfaceFace& f) { return !f.surface.valid() || has_face(f); });
}

}  // namespace

void check_has_zones_of(const Solution& solution, const Scene& scene, const ZoneMesh& mesh) {
  if (solution.mesh.zone_count() != mesh.zone_count() ||
      solution.mesh.triangle_count() != mesh.triangle_count() || !(solution.bands == scene.bands) ||
      solution.surface_names.size() != scene.surfaces.size())
    throw InputError(scene.source, "the room is not the one that was solved",
                     "Solve it again: its surfaces, zones or bands have changed since.");
}

void check_is_room_of(const Solution& solution, const Scene& scene, const ZoneMesh& mesh) {
  check_has_zones_of(solution, scene, mesh);
  if (!solution.room_hash.empty() && content_hash(scene) != solution.room_hash)
    throw InputError(scene.source, "the room is not the one that was solved",
                     "Solve it again: something of it has changed since.");
}

Scene read_room_of(const Solution& solution, const fs::path& solution_file,
                   const std::vector<fs::path>& override) {
  Scene scene = read_scene(find_room(solution, solution_file, override), solution.read_options);
  if (solution.mesh_report.surfaces.size() == scene.surfaces.size())
    spread_total_powers(solution.mesh_report, solution.mesh, scene);
  if (content_hash(scene) != solution.room_hash)
    throw InputError(scene.source,
                     "the room has changed since " + solution_file.string() + " was solved from it",
                     "Solve it again, or restore its files as they were.");
  if (!fits(solution, scene))
    throw InputError(solution_file.string(), "is damaged: its zones do not fit the room " + scene.source,
                     "Restore a copy of the file or solve the room again.");
  return scene;
}

}  // namespace reemit

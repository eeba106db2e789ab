#include "scenes/io/obj/obj_reader.h"

#include <map>
#include <utility>

#include <fmt/format.h>

#include "scenes/io/common/surface_builder.h"
#include "scenes/io/obj/obj_camera.h"
#include "scenes/io/obj/obj_geometry.h"

namespace reemit {
namespace fs = std::filesystem;
namespace {

Polygon polygon_of(const ObjFace& face, const ObjGeometry& geometry) {
  Polygon polygon;
  for (const std::uint32_t index : face.positions) polygon.outer.push_back(geometry.positions[index]);
  for (const std::uint32_t index : face.normals) polygon.normals.push_back(geometry.normals[index]);
  for (const std::uint32_t index : face.texture_points) {
    TexturePoint& point = polygon.texture_points.emplace_back();
    point.uv[0] = geometry.texture_points[index];
  }
  return polygon;
}

// One surface per group and material, in order of first use.
void build_surfaces(const ObjGeometry& geometry, Scene& scene) {
  std::vector<SurfaceBuilder> builders;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> index;
  std::size_t degenerate = 0;
  std::uint32_t first_degenerate = 0;
  for (const ObjFace& face : geometry.faces) {
    const std::vector<Polygon> polygons = split_at_seams(polygon_of(face, geometry));
    if (polygons.empty() && degenerate++ == 0) first_degenerate = face.line;
    if (polygons.empty()) continue;
    const auto [entry, added] = index.try_emplace({face.group, face.material}, builders.size());
    if (added) {
      const std::string& group = geometry.groups[face.group];
      builders.emplace_back(group.empty() ? scene.materials[face.material].name : group, scene.source,
                            MaterialId(face.material));
    }
    for (const Polygon& polygon : polygons) builders[entry->second].add(polygon, face.line);
  }
  for (SurfaceBuilder& builder : builders) scene.surfaces.push_back(builder.take());
  if (degenerate > 0) {
    scene.refused["faces"] += degenerate;
    scene.warnings.push_back(fmt::format(
        "{}: {} face(s) have less than three different corners and were left out, the first in line {}.",
        scene.source, degenerate, first_degenerate));
  }
}

}  // namespace

Scene read_obj_scene(const fs::path& file, const ReadOptions& /*options*/) {
  Scene scene;
  scene.name = file.stem().string();
  scene.source = file.string();
  scene.bands = BandSet::rgb();
  ObjMaterials materials;
  ObjGeometry geometry = read_obj_geometry(file, materials);
  scene.warnings = materials.warnings();
  scene.notes = materials.notes;
  scene.materials = std::move(materials.materials);
  scene.refused = std::move(materials.refused);
  scene.not_modelled = std::move(materials.not_modelled);
  if (geometry.ignored_statements > 0) scene.refused["statements"] = geometry.ignored_statements;
  scene.warnings.insert(scene.warnings.end(), geometry.warnings.begin(), geometry.warnings.end());
  build_surfaces(geometry, scene);
  tell_surfaces_apart(scene);
  std::error_code ignored;
  if (const fs::path beside = file.parent_path() / "camera.txt"; fs::exists(beside, ignored))
    if (auto camera = read_obj_camera(beside, scene.warnings)) scene.cameras.push_back(std::move(*camera));
  scene.notes.push_back(
      "OBJ: metres; Kd is the linear Rec.709 reflectance of both sides, Ke the radiance of the front in "
      "W/(m2 sr); transparent shares of the light and what mirrors take are not reflected diffusely.");
  return scene;
}

}  // namespace reemit

#include <algorithm>

#include <fmt/format.h>

#include "scenes/io/common/kind_counts.h"
#include "scenes/io/common/scene_bands.h"
#include "scenes/io/common/surface_geometry.h"
#include "scenes/io/common/text_parse.h"
#include "scenes/io/gltf/gltf_reader.h"
#include "scenes/io/native/native_objects.h"
#include "scenes/io/obj/obj_reader.h"
#include "scenes/io/ply/ply_reader.h"

namespace reemit {

NativeObjects::ReferencedFile& NativeObjects::load(const JsonCursor& path) {
  const std::string& name = path.string();
  const auto known = files_.find(name);
  if (known != files_.end()) return known->second;
  const std::filesystem::path file = folder_ / name;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    path.fail(fmt::format("there is no file {}", file.string()),
              "Names are relative to the folder of the room file.");
  }
  const std::string extension = lower_case_extension(file);
  ReferencedFile loaded;
  if (extension == ".ply") {
    PlyMesh mesh = read_ply(file);
    loaded.surfaces.push_back(std::move(mesh.surface));
    for (const std::string& warning : mesh.warnings)
      scene_.warnings.push_back(fmt::format("{}: {}", name, warning));
  } else if (extension == ".obj" || extension == ".gltf" || extension == ".glb") {
    Scene read = extension == ".obj" ? read_obj_scene(file, options_) : read_gltf_scene(file, options_);
    loaded.surfaces = std::move(read.surfaces);
    loaded.materials = std::move(read.materials);
    loaded.bands = read.bands;
    add_counts(read.refused, scene_.refused);
    add_counts(read.not_modelled, scene_.not_modelled);
    if (!read.lights.empty()) scene_.refused["luminaires"] += read.lights.size();
    if (!read.cameras.empty()) scene_.refused["cameras"] += read.cameras.size();
    for (const std::string& warning : read.warnings)
      scene_.warnings.push_back(fmt::format("{}: {}", name, warning));
    for (const std::string& note : read.notes) scene_.notes.push_back(fmt::format("{}: {}", name, note));
    if (!read.lights.empty() || !read.cameras.empty()) {
      scene_.warnings.push_back(
          fmt::format("{}: its {} punctual light(s) and {} camera(s) are not taken over", name,
                      read.lights.size(), read.cameras.size()));
    }
  } else {
    path.fail(fmt::format("cannot read \"{}\" files as geometry", extension),
              "Use .obj, .ply, .gltf or .glb.");
  }
  loaded.ids.resize(loaded.materials.size());
  return files_.emplace(name, std::move(loaded)).first->second;
}

MaterialId NativeObjects::material_of_file(ReferencedFile& file, const Surface& surface,
                                           const JsonCursor& object) {
  const Material& own = file.materials[surface.material.index()];
  if (const auto mapping = object.find("materials")) {
    if (const auto mapped = mapping->find(own.name.c_str())) return materials_.find(*mapped);
  }
  if (const auto all = object.find("material")) return materials_.find(*all);
  MaterialId& id = file.ids[surface.material.index()];
  if (id.valid()) return id;
  Material material = own;
  constexpr double kWorthAWord = 1e-3;
  if (const double deviation = convert_material(material, file.bands, scene_); deviation > kWorthAWord)
    scene_.warnings.push_back(
        fmt::format("{}: the bands of the room are too few for the colours of material '{}': the nearest "
                    "spectra miss one by {:.2g} %.",
                    object.where(), own.name, 100 * deviation));
  id = materials_.import(std::move(material), scene_);
  return id;
}

void NativeObjects::read_file(const JsonCursor& at, const JsonCursor& object, const Placement& placement,
                              const std::string& name) {
  at.expect_object({"path", "unit", "vertex_colours"});
  const auto colours = at.find("vertex_colours");
  const bool drops_colours = colours && !colours->boolean();
  ReferencedFile& file = load(at.at("path"));
  if (const auto mapping = object.find("materials")) {
    std::vector<std::string> known;
    for (const Material& material : file.materials) known.push_back(material.name);
    for (const auto& [from, to] : mapping->members()) {
      if (std::find(known.begin(), known.end(), from) == known.end()) {
        to.fail(fmt::format("the file has no material \"{}\"", from), known_names(from, known));
      }
    }
  }
  // The transform of the object works in the unit of the room, so the file is brought to that unit first.
  const auto unit = at.find("unit");
  const double scale = (unit ? read_unit(*unit) : 1.0) / unit_;
  Placement scaled = placement;
  scaled.to_world = placement.to_world * Eigen::Affine3d(Eigen::Scaling(scale));
  const auto flipped = object.find("flip");
  const bool flips = flipped && flipped->boolean();
  for (const Surface& original : file.surfaces) {
    Surface surface = original;
    surface.material = file.materials.empty() ? demand_material(object, placement)
                                              : material_of_file(file, original, object);
    if (drops_colours) surface.has_vertex_colours = false;
    if (flips) flip_surface(surface);
    // A format without names of its own (PLY) takes the name of the object.
    const std::string full_name = surface.name.empty()
                                      ? placement.prefix.substr(0, placement.prefix.size() - 1)
                                      : placement.prefix + surface.name;
    append(std::move(surface), object, scaled, full_name);
  }
  if (file.surfaces.empty()) scene_.warnings.push_back(fmt::format("{}: the file has no faces", name));
}

}  // namespace reemit

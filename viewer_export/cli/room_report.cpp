#include "viewer_export/cli/room_report.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "viewer_export/cli/luminaire_list.h"
#include "viewer_export/cli/surface_models.h"
#include "viewer_export/cli/text_table.h"
#include "viewer_export/cli/texture_report.h"
#include "viewer_export/cli/zone_lines.h"

namespace reemit::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kHeadWidth = 14;  // of the first column

std::string format_name(const Scene& scene) {
  std::string extension = std::filesystem::path(scene.source).extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  for (char& c : extension) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return extension;
}

std::string point_text(const Vec3& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

Json spectrum_json(const Spectrum& value) {
  return std::vector<double>(value.begin(), value.end());
}

Json point_json(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

std::size_t face_count(const Scene& scene) {
  std::size_t count = 0;
  for (const Surface& surface : scene.surfaces) count += surface.faces.size() + surface.shapes.size();
  return count;
}

double input_area(const MeshReport& report) {
  double area = 0;
  for (const SurfaceAreas& surface : report.surfaces) area += surface.input;
  return area;
}

/// {name, count} of every kind of repair the mesh stage made.
std::vector<std::pair<const char*, std::size_t>> repairs(const MeshReport& report) {
  return {{"degenerate_faces", report.degenerate_faces},    {"duplicate_faces", report.duplicate_faces},
          {"overlapping_faces", report.overlapping_faces},  {"flipped_faces", report.flipped_faces},
          {"nonplanar_faces", report.nonplanar_faces},      {"cut_faces", report.cut_faces},
          {"back_to_back_faces", report.back_to_back_faces}};
}

std::string sides_text(const Material& material) {
  if (material.emits_both_sides) return "both, both emit";
  if (!material.two_sided) return "front";
  if (material.back_reflectance.size() == 0) return "both";
  return fmt::format("both, rho of the back {:.3g}", fmt::join(material.back_reflectance, " "));
}

std::string materials_text(const Scene& scene) {
  TextTable table;
  std::vector<std::string> head{"material"};
  add_band_heads(head, "rho", scene.bands);
  add_band_heads(head, "L_e", scene.bands);
  head.emplace_back("sides");
  table.row(std::move(head));
  for (std::size_t m = 0; m < std::min(kMostRows, scene.materials.size()); ++m) {
    const Material& material = scene.materials[m];
    std::vector<std::string> cells{"  " + material.name};
    add_band_cells(cells, material.reflectance);
    add_band_cells(cells, material.emitted_radiance);
    cells.push_back(sides_text(material));
    table.row(std::move(cells));
  }
  return "Materials: diffuse reflectance rho [1], emitted radiance L_e [W/(m2 sr)]\n" + table.text() +
         rest_text(scene.materials.size(), "materials");
}

std::string models_text(const Scene& scene, const MeshResult& meshed) {
  std::string text;
  for (const ModelShare& share : model_shares(scene, meshed))
    text += fmt::format("; {} {} of the area and about {} of the light that arrives", share.model,
                        percent_text(share.area), rough_percent_text(share.power));
  return fmt::format("surfaces are  Lambertian{}\n", text);
}

std::string surfaces_text(const Scene& scene, const MeshReport& report) {
  TextTable table;
  table.row({"surface", "faces", "area [m2]", "removed [m2]", "material"});
  for (std::size_t s = 0; s < std::min(kMostRows, scene.surfaces.size()); ++s) {
    const Surface& surface = scene.surfaces[s];
    table.row({"  " + surface.name, std::to_string(surface.faces.size() + surface.shapes.size()),
               number_text(report.surfaces[s].input), number_text(report.surfaces[s].removed),
               scene.material_of(surface).name});
  }
  return table.text() + rest_text(scene.surfaces.size(), "surfaces");
}

std::string cameras_text(const Scene& scene) {
  if (scene.cameras.empty()) return "Cameras: none; render chooses some inside the free space\n";
  TextTable table;
  table.row({"camera", "eye [m]", "look at [m]", "fov [deg]", "size [px]"});
  for (const Camera& camera : scene.cameras) {
    table.row({"  " + camera.name, point_text(camera.eye), point_text(camera.look_at),
               number_text(camera.vertical_fov_deg), fmt::format("{}x{}", camera.width, camera.height)});
  }
  return table.text();
}

Json counts_json(const KindCounts& counts) {
  std::size_t sum = 0;
  Json kinds = Json::object();
  for (const auto& [kind, count] : counts) {
    sum += count;
    kinds[kind] = count;
  }
  return {{"count", sum}, {"kinds", kinds}};
}

/// "3 faces, 1 textures", or what to say of none.
template <class Counts>
std::string counts_text(const Counts& counts) {
  std::string text;
  for (const auto& [kind, count] : counts) {
    if (count == 0) continue;
    std::string words = kind;
    std::replace(words.begin(), words.end(), '_', ' ');
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, words);
  }
  return text.empty() ? "none" : text;
}

Json materials_json(const Scene& scene) {
  Json materials = Json::array();
  for (const Material& material : scene.materials)
    materials.push_back(
        {{"name", material.name},
         {"reflectance", spectrum_json(material.reflectance)},
         {"back_reflectance", spectrum_json(material.reflectance_of(false))},
         {"specular_reflectance", spectrum_json(material.non_diffuse.specular_reflectance)},
         {"specular_transmittance", spectrum_json(material.non_diffuse.specular_transmittance)},
         {"emitted_radiance_W_sr_m2", spectrum_json(material.emitted_radiance)},
         {"two_sided", material.two_sided},
         {"emits_both_sides", material.emits_both_sides},
         {"models", models_of(material)}});
  return materials;
}

Json surfaces_json(const Scene& scene, const MeshReport& report) {
  Json surfaces = Json::array();
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
    surfaces.push_back({{"name", scene.surfaces[s].name},
                        {"material", scene.material_of(scene.surfaces[s]).name},
                        {"faces", scene.surfaces[s].faces.size()},
                        {"shapes", scene.surfaces[s].shapes.size()},
                        {"area_m2", report.surfaces[s].input},
                        {"removed_m2", report.surfaces[s].removed}});
  return surfaces;
}

Json cameras_json(const Scene& scene) {
  Json cameras = Json::array();
  for (const Camera& camera : scene.cameras)
    cameras.push_back({{"name", camera.name},
                       {"eye_m", point_json(camera.eye)},
                       {"look_at_m", point_json(camera.look_at)},
                       {"up", point_json(camera.up)},
                       {"vertical_fov_deg", camera.vertical_fov_deg},
                       {"width_px", camera.width},
                       {"height_px", camera.height}});
  return cameras;
}

}  // namespace

std::string room_text(const Scene& scene, const MeshResult& meshed) {
  const Box box = bounds(scene);
  std::string text = fmt::format("{}: room, {}\n", scene.source, format_name(scene));
  text += fmt::format("hash          {}\n", content_hash(scene));
  text += fmt::format("bands         {} ({})\n", fmt::join(scene.bands.names(), " "),
                      scene.bands.efficacy_statement());
  text += fmt::format("bounding box  {} to {} m\n", point_text(box.min), point_text(box.max));
  text += fmt::format("size          {:.6g} x {:.6g} x {:.6g} m\n", box.size().x(), box.size().y(),
                      box.size().z());
  text += fmt::format("geometry      {} surfaces, {} faces, {:.6g} m2 (one side)\n", scene.surfaces.size(),
                      face_count(scene), input_area(meshed.report));
  if (const std::string textures = textures_text(scene); !textures.empty())
    text += fmt::format("textures      {}\n", textures);
  text += fmt::format("mesh          {} base triangles, {} zones with default settings\n",
                      meshed.mesh.triangle_count(), meshed.mesh.zone_count());
  text += shared_zones_text(meshed.mesh, kHeadWidth);
  text += fmt::format("repairs       {}\n", counts_text(repairs(meshed.report)));
  text += fmt::format("refused       {}\n", counts_text(scene.refused));
  text += fmt::format("not modelled  {}\n", counts_text(scene.not_modelled));
  text += models_text(scene, meshed);
  text += '\n' + materials_text(scene) + '\n' + surfaces_text(scene, meshed.report) + '\n' +
          luminaires_text(list_luminaires(scene, meshed), scene.bands) + '\n' + cameras_text(scene);
  for (const std::string& note : scene.notes) text += "note: " + note + '\n';
  return text;
}

Json refused_room_json(const std::vector<std::filesystem::path>& files, const std::string& message) {
  const std::size_t end = message.find('\n');
  const std::size_t advice = end == std::string::npos ? end : message.find_first_not_of(' ', end + 1);
  Json json{{"kind", "refused"},
            {"files", Json::array()},
            {"refused", counts_json({{"rooms", 1}})},
            {"not_modelled", counts_json({})},
            {"error", message.substr(0, end)},
            {"advice", advice == std::string::npos ? "" : message.substr(advice)}};
  for (const std::filesystem::path& file : files) json["files"].push_back(file.string());
  return json;
}

Json room_json(const Scene& scene, const MeshResult& meshed, const std::vector<std::string>& light_warnings) {
  const Box box = bounds(scene);
  Json json{{"kind", "room"},
            {"file", scene.source},
            {"format", format_name(scene)},
            {"name", scene.name},
            {"hash", content_hash(scene)},
            {"bands", scene.bands.names()},
            {"efficacy_lm_per_W", spectrum_json(scene.bands.efficacy_lm_per_w())},
            {"bounding_box_m", {{"min", point_json(box.min)}, {"max", point_json(box.max)}}},
            {"size_m", point_json(box.size())},
            {"faces", face_count(scene)},
            {"area_m2", input_area(meshed.report)},
            {"base_triangles", meshed.mesh.triangle_count()},
            {"zones_by_default", meshed.mesh.zone_count()}};
  add_shared_zones(json, meshed.mesh);
  json["textures"] = textures_json(scene);
  for (const auto& [name, count] : repairs(meshed.report)) json["repairs"][name] = count;
  json["materials"] = materials_json(scene);
  json["model_area_shares"] = json["model_power_shares"] = Json::object();
  for (const ModelShare& share : model_shares(scene, meshed)) {
    json["model_area_shares"][share.model] = share.area;
    json["model_power_shares"][share.model] = share.power;
  }
  json["surfaces"] = surfaces_json(scene, meshed.report);
  add_luminaires(json, list_luminaires(scene, meshed), scene.bands);
  json["cameras"] = cameras_json(scene);
  json["refused"] = counts_json(scene.refused);
  json["not_modelled"] = counts_json(scene.not_modelled);
  json["warnings"] = scene.warnings;
  for (const std::string& warning : meshed.report.warnings) json["warnings"].push_back(warning);
  for (const std::string& warning : light_warnings) json["warnings"].push_back(warning);
  json["notes"] = scene.notes;
  return json;
}

}  // namespace reemit::cli

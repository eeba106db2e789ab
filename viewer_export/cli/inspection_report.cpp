#include "viewer_export/cli/inspection_report.h"

#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "viewer_export/cli/output_path.h"
#include "viewer_export/cli/progress.h"
#include "viewer_export/cli/text_table.h"
#include "viewer_export/inspection/face_lists.h"
#include "viewer_export/inspection/inspection_picture.h"
#include "viewer_export/inspection/side_kinds.h"
#include "viewer_export/inspection/zone_sizes.h"

namespace reemit::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kOption = "--report";
constexpr const char* kZoneKeys[] = {"cells", "shared", "sealed"};  // by ZoneKind

std::vector<SideKindSum> sum_sides_of(const Scene& scene, const MeshResult& meshed) {
  return sum_sides(meshed.mesh, kinds_of_sides(scene, meshed));
}

std::string megabytes_text(const std::filesystem::path& file) {
  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::file_size(file, unknown);
  return unknown ? "" : fmt::format(", {:.1f} MB", static_cast<double>(bytes) / 1e6);
}

std::string picture_text(const Scene& scene, const MeshResult& meshed, const std::filesystem::path& report) {
  TextTable table;
  table.row({"object", "colour", "sides of triangles", "area [m2]"});
  for (const SideKindSum& sum : sum_sides_of(scene, meshed)) {
    const SideKindStyle& style = style_of(sum.kind);
    table.row(
        {fmt::format("  {}", style.name), style.hex(), std::to_string(sum.sides), number_text(sum.area)});
  }
  return fmt::format("Report: {}{}; docs/meshing.md says how to read it\n", report.string(),
                     megabytes_text(report)) +
         table.text();
}

std::string faces_text(const Scene& scene, const MeshResult& meshed) {
  const std::vector<FaceList> lists = list_faces(meshed);
  if (lists.empty()) return "Faces: none was changed, none is sealed\n";
  std::string text = "Faces by what happened to them; one may be in several lists\n";
  for (const FaceList& list : lists)
    text += fmt::format("  {} {}\n    {}\n", list.count, list.description, names_of(scene, list));
  return text;
}

std::string zone_sizes_text(const ZoneMesh& mesh) {
  TextTable table;
  table.row({"zones", "number", "smallest [m2]", "median [m2]", "largest [m2]"});
  for (const ZoneKind kind : kZoneKinds) {
    const ZoneSizes sizes = zone_sizes(mesh, kind);
    if (sizes.count == 0) continue;
    table.row({fmt::format("  {}", name_of(kind)), std::to_string(sizes.count), number_text(sizes.smallest),
               number_text(sizes.median), number_text(sizes.largest)});
  }
  return table.text();
}

Json face_json(const Scene& scene, const FaceRef& face) {
  Json json{{"surface", scene.surfaces[face.surface.index()].name}, {"file", source_of(scene, face)}};
  if (const std::uint32_t line = source_line(scene, face); line > 0) json["line"] = line;
  json[face.is_shape ? "shape" : "face"] = face.number;
  return json;
}

}  // namespace

void check_report(const std::filesystem::path& report, const std::vector<std::filesystem::path>& room) {
  check_inspection_name(report);
  for (const std::filesystem::path& file : room) check_output_file(report, file, kOption);
}

void write_report(const std::filesystem::path& report, const Scene& scene, const MeshResult& meshed,
                  const OutputStyle& style) {
  check_keeps_room(report, scene, kOption);
  const WaitingLine line("drawing the report", progress_style(style.quiet, style.verbose));
  const InspectionPicture picture = draw_inspection(scene, meshed);
  write_output([&] { write_inspection(picture, scene, report); });
}

std::string inspection_text(const Scene& scene, const MeshResult& meshed,
                            const std::filesystem::path& report) {
  return picture_text(scene, meshed, report) + '\n' + faces_text(scene, meshed) + '\n' +
         zone_sizes_text(meshed.mesh);
}

void add_inspection(Json& json, const Scene& scene, const MeshResult& meshed,
                    const std::filesystem::path& report) {
  json["changed_faces"] = Json::array();
  for (const FaceList& list : list_faces(meshed)) {
    Json first = Json::array();
    for (const FaceRef& face : list.first) first.push_back(face_json(scene, face));
    json["changed_faces"].push_back({{"kind", list.key}, {"count", list.count}, {"first", std::move(first)}});
  }
  for (const ZoneKind kind : kZoneKinds) {
    const ZoneSizes sizes = zone_sizes(meshed.mesh, kind);
    Json& row = json["zone_sizes"][kZoneKeys[static_cast<std::size_t>(kind)]];
    row["count"] = sizes.count;
    if (sizes.count == 0) continue;
    row["smallest_m2"] = sizes.smallest;
    row["median_m2"] = sizes.median;
    row["largest_m2"] = sizes.largest;
  }
  if (report.empty()) return;
  json["report"] = {{"file", report.string()}, {"objects", Json::array()}};
  for (const SideKindSum& sum : sum_sides_of(scene, meshed)) {
    const SideKindStyle& style = style_of(sum.kind);
    json["report"]["objects"].push_back({{"kind", style.key},
                                         {"name", style.name},
                                         {"colour", style.hex()},
                                         {"sides", sum.sides},
                                         {"area_m2", sum.area}});
  }
}

}  // namespace reemit::cli

#include "viewer_export/formats/ply_writer.h"

#include <limits>
#include <vector>

#include <fmt/format.h>

#include "scenes/model/error.h"
#include "viewer_export/formats/vertex_export.h"

namespace reemit {
namespace {

constexpr const char* kRgbNames[] = {"r", "g", "b"};

void write_header(const VertexData& data, const ToneMap& tone_map, double gap, bool double_positions,
                  OutputFile& file) {
  file.write("ply\nformat binary_little_endian 1.0\n");
  for (const auto& [name, value] : describe(data.info, data.bands))
    file.write(fmt::format("comment {}: {}\n", name, value));
  file.write(fmt::format("comment up: +{}, axes as in the room file\n", data.up.z() > 0.5 ? 'z' : 'y'));
  if (gap > 0) file.write(fmt::format("comment backs: moved at most {:.3g} m off their fronts\n", gap));
  file.write("comment quality: luminance [cd/m2]\n");
  file.write(fmt::format("comment red green blue: sRGB, {}\n", tone_map.statement()));
  if (data.bands.kind() != BandKind::kRgb)
    file.write("comment radiance_r/g/b, irradiance_r/g/b: linear Rec.709 derived from the bands\n");
  for (std::size_t i = 0; i < data.surface_names.size(); ++i)
    file.write(fmt::format("comment surface {}: {}\n", i, one_line(data.surface_names[i])));
  for (std::size_t i = 0; i < data.material_names.size(); ++i)
    file.write(fmt::format("comment material {}: {}\n", i, one_line(data.material_names[i])));

  file.write(fmt::format("element vertex {}\n", data.vertex_count()));
  for (const char* axis : {"x", "y", "z"})
    file.write(fmt::format("property {} {}\n", double_positions ? "double" : "float", axis));
  file.write("property float nx\nproperty float ny\nproperty float nz\n");
  file.write("property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float quality\n");
  for (const char* quantity : {"radiance", "irradiance"})
    for (const char* channel : kRgbNames)
      file.write(fmt::format("property float {}_{}\n", quantity, channel));
  if (data.bands.kind() != BandKind::kRgb)
    for (const char* quantity : {"radiance", "irradiance"})
      for (const std::string& band : data.bands.names())
        file.write(fmt::format("property float {}_{}\n", quantity, band));
  std::vector<const char*> parts{"stderr", "direct"};
  if (!data.caustic_radiance.empty()) parts.push_back("caustic");
  for (const char* quantity : parts)
    for (const std::string& band : data.bands.names())
      file.write(fmt::format("property float {}_{}\n", quantity, band));
  file.write("property int surface\nproperty int material\n");
  file.write(fmt::format("element face {}\n", data.triangles.size()));
  file.write("property list uchar int vertex_indices\nend_header\n");
}

}  // namespace

std::optional<ToneMap> write_ply(const VertexData& data, OutputFile& file) {
  if (data.vertex_count() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw InputError("PLY export", "more than 2^31-1 vertices", "Write .csv, or solve with larger zones.");
  const VertexColours colours = colours_of(data);
  const bool double_positions = single_precision_origin(data) != Vec3::Zero();
  const double gap = back_gap(data);
  const std::vector<Vec3> positions = positions_for_viewing(data, gap);
  write_header(data, colours.tone_map, gap, double_positions, file);

  const std::size_t bands = data.bands.count();
  const bool rgb_room = data.bands.kind() == BandKind::kRgb;
  std::string row;
  const auto append_values = [&](const std::vector<float>& values, std::size_t v) {
    for (std::size_t i = v * bands; i < (v + 1) * bands; ++i) append_bytes(row, values[i]);
  };
  for (std::size_t v = 0; v < data.vertex_count(); ++v) {
    row.clear();
    for (const double x : positions[v])
      double_positions ? append_bytes(row, x) : append_bytes(row, static_cast<float>(x));
    for (const double x : data.normals[v]) append_bytes(row, static_cast<float>(x));
    for (const double c : colours.displayable(v)) append_bytes(row, srgb_byte(c));
    double cd_per_m2 = 0;
    for (std::size_t band = 0; band < bands; ++band)
      cd_per_m2 +=
          data.bands.efficacy_lm_per_w()[static_cast<Eigen::Index>(band)] * data.radiance[v * bands + band];
    append_bytes(row, static_cast<float>(cd_per_m2));
    if (rgb_room) {
      append_values(data.radiance, v);
      append_values(data.irradiance, v);
    } else {
      for (std::size_t c = 0; c < 3; ++c) append_bytes(row, colours.rgb[3 * v + c]);
      for (const double c : data.rgb(data.irradiance, v)) append_bytes(row, static_cast<float>(c));
      append_values(data.radiance, v);
      append_values(data.irradiance, v);
    }
    append_values(data.radiance_stderr, v);
    append_values(data.direct_radiance, v);
    if (!data.caustic_radiance.empty()) append_values(data.caustic_radiance, v);
    append_bytes(row, static_cast<std::int32_t>(data.surfaces[v].index()));
    append_bytes(row, static_cast<std::int32_t>(data.materials[v].index()));
    file.write(row);
  }
  for (const auto& triangle : data.triangles) {
    row.clear();
    append_bytes(row, std::uint8_t{3});
    for (const std::uint32_t v : triangle) append_bytes(row, static_cast<std::int32_t>(v));
    file.write(row);
  }
  return colours.tone_map;
}

}  // namespace reemit

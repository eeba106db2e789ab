#include "viewer_export/formats/csv_writer.h"

#include <iterator>

#include <fmt/format.h>

namespace reemit {
namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n#") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

void write_header(const VertexData& data, OutputFile& file) {
  for (const auto& [name, value] : describe(data.info, data.bands))
    file.write(fmt::format("# {}: {}\n", name, value));
  file.write("vertex,x,y,z,nx,ny,nz,surface,material");
  for (const std::string& band : data.bands.names())
    file.write(fmt::format(",radiance_{0},irradiance_{0},stderr_{0},direct_{0}", band));
  file.write("\n");
}

}  // namespace

std::optional<ToneMap> write_csv(const VertexData& data, OutputFile& file) {
  write_header(data, file);
  std::vector<std::string> surfaces;
  std::vector<std::string> materials;
  for (const std::string& name : data.surface_names) surfaces.push_back(quoted(one_line(name)));
  for (const std::string& name : data.material_names) materials.push_back(quoted(one_line(name)));

  const std::size_t bands = data.bands.count();
  fmt::memory_buffer row;
  for (std::size_t v = 0; v < data.vertex_count(); ++v) {
    row.clear();
    const Vec3& p = data.positions[v];
    const Vec3& n = data.normals[v];
    fmt::format_to(std::back_inserter(row), "{},{},{},{},{},{},{},{},{}", v, p.x(), p.y(), p.z(), n.x(),
                   n.y(), n.z(), surfaces[data.surfaces[v].index()], materials[data.materials[v].index()]);
    for (std::size_t i = v * bands; i < (v + 1) * bands; ++i)
      fmt::format_to(std::back_inserter(row), ",{},{},{},{}", data.radiance[i], data.irradiance[i],
                     data.radiance_stderr[i], data.direct_radiance[i]);
    row.push_back('\n');
    file.write({row.data(), row.size()});
  }
  return std::nullopt;
}

}  // namespace reemit

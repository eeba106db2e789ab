#include "viewer_export/vertex/vertex_data.h"

#include <stdexcept>

namespace reemit {

Eigen::Array3d VertexData::rgb(const std::vector<float>& values, std::size_t vertex) const {
  const std::size_t count = bands.count();
  Spectrum value(static_cast<Eigen::Index>(count));
  for (std::size_t band = 0; band < count; ++band)
    value[static_cast<Eigen::Index>(band)] = values[vertex * count + band];
  return bands.to_rgb(value);
}

void check_consistent(const VertexData& data) {
  const auto require = [](bool condition, const char* problem) {
    if (!condition) throw std::invalid_argument(std::string("vertex data: ") + problem);
  };
  const std::size_t vertices = data.vertex_count();
  const std::size_t values = vertices * data.bands.count();
  require(data.normals.size() == vertices, "one normal per vertex expected");
  require(data.surfaces.size() == vertices, "one surface per vertex expected");
  require(data.materials.size() == vertices, "one material per vertex expected");
  require(data.on_back.size() == vertices, "one side per vertex expected");
  for (const auto* array : {&data.radiance, &data.irradiance, &data.radiance_stderr, &data.direct_radiance})
    require(array->size() == values, "one value per vertex and band expected");
  require(data.caustic_radiance.empty() || data.caustic_radiance.size() == values,
          "caustics at all vertices or none expected");
  for (const SurfaceId s : data.surfaces)
    require(s.index() < data.surface_names.size(), "surface without a name");
  for (const MaterialId m : data.materials)
    require(m.index() < data.material_names.size(), "material without a name");
  for (const auto& triangle : data.triangles)
    for (const std::uint32_t v : triangle) require(v < vertices, "triangle with a vertex out of range");
}

}  // namespace reemit

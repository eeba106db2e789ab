#pragma once
#include <string>

#include "viewer_export/vertex/vertex_data.h"

namespace reemit::test {

/// Two surfaces of two materials, interleaved in the order of vertices, with a different number in every
/// field; one triangle is degenerate and one vertex belongs to no triangle.
inline VertexData sample_vertices(const BandSet& bands, const Vec3& shift = Vec3::Zero()) {
  VertexData data;
  data.info.program_version = "1.2.3";
  data.info.room = "kitchen\nnorth.json";
  data.info.room_hash = "0123456789abcdef";
  data.info.seed = 77;
  data.info.error = 0.0125;
  data.info.settings = {{"gather rays", std::uint64_t{256}}};
  data.bands = bands;
  data.surface_names = {"floor, \"old\"", "unused", "wall"};
  data.material_names = {"spare", "oak", "plaster"};
  const Vec3 corners[] = {{0, 0, 0}, {0, 0, 2}, {1, 0, 0},      {1.5, 0, 2},
                          {0, 1, 0}, {0, 1, 2}, {0.1, 0.2, 0.3}};
  for (std::size_t v = 0; v < 7; ++v) {
    const bool wall = v % 2 == 1;
    data.positions.push_back(corners[v] + shift);
    data.normals.push_back(wall ? Vec3(0, 0.6, 0.8) : Vec3(0, 0, 1));
    data.surfaces.emplace_back(wall ? 2 : 0);
    data.materials.emplace_back(wall ? 2 : 1);
    data.on_back.push_back(false);
    for (std::size_t b = 0; b < bands.count(); ++b) {
      const auto n = static_cast<float>(v * bands.count() + b + 1);
      data.radiance.push_back(n / 3);
      data.irradiance.push_back(10 * n / 3);
      data.radiance_stderr.push_back(n / 300);
      data.direct_radiance.push_back(n / 7);
      // The others are of rooms that bend no light.
      if (bands.kind() == BandKind::kRgb) data.caustic_radiance.push_back(n / 11);
    }
  }
  data.triangles = {{0, 2, 4}, {1, 3, 5}, {0, 0, 2}};
  return data;
}

}  // namespace reemit::test

#include "scenes/io/gltf/gltf_meshes.h"

#include <array>
#include <numeric>

#include <fmt/format.h>

#include "scenes/model/error.h"

namespace reemit {

namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// The corners of all triangles in the order of glTF 2.0, 3.7.2.1, so that every front stays a front.
std::vector<Triangle> triangles_of(const std::vector<std::uint32_t>& v, int mode) {
  std::vector<Triangle> triangles;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    for (std::size_t i = 0; i + 2 < v.size(); i += 3) triangles.push_back({v[i], v[i + 1], v[i + 2]});
  } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
    for (std::size_t i = 0; i + 2 < v.size(); ++i)
      triangles.push_back({v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
  } else {
    for (std::size_t i = 0; i + 2 < v.size(); ++i) triangles.push_back({v[i + 1], v[i + 2], v[0]});
  }
  return triangles;
}

int attribute(const tinygltf::Primitive& primitive, const char* name) {
  const auto it = primitive.attributes.find(name);
  return it == primitive.attributes.end() ? -1 : it->second;
}

GltfPrimitive read_primitive(const GltfModel& gltf, const GltfAccessors& accessors,
                             const tinygltf::Primitive& source, const std::string& where,
                             GltfOmissions& omissions) {
  GltfPrimitive primitive;
  const std::size_t materials = gltf.model.materials.size();
  const bool has_material = source.material >= 0;
  if (has_material && static_cast<std::size_t>(source.material) >= materials) {
    throw InputError(gltf.at(where + "/material"), fmt::format("there is no material {}", source.material),
                     "Export the file anew.");
  }
  primitive.material = MaterialId(has_material ? static_cast<std::size_t>(source.material) : materials);
  if (source.mode < TINYGLTF_MODE_TRIANGLES || source.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
    ++omissions.other_modes;
    return primitive;
  }
  if (!has_material) ++omissions.plain;
  if (!source.targets.empty()) ++omissions.morphed;
  if (attribute(source, "COLOR_0") >= 0) ++omissions.coloured;
  const int positions = attribute(source, "POSITION");
  if (positions < 0) {
    throw InputError(gltf.at(where), "the primitive has no positions", "Export the file anew.");
  }
  primitive.positions = accessors.vec3(positions, where + "/attributes/POSITION");
  if (const int normals = attribute(source, "NORMAL"); normals >= 0) {
    primitive.normals = accessors.vec3(normals, where + "/attributes/NORMAL");
    if (primitive.normals.size() != primitive.positions.size()) {
      throw InputError(
          gltf.at(where + "/attributes/NORMAL"),
          fmt::format("{} normals for {} positions", primitive.normals.size(), primitive.positions.size()),
          "Export the file anew.");
    }
  }
  std::vector<std::uint32_t> order;
  if (source.indices >= 0) {
    order = accessors.indices(source.indices, primitive.positions.size(), where + "/indices");
  } else {
    order.resize(primitive.positions.size());
    std::iota(order.begin(), order.end(), 0u);
  }
  for (const Triangle& t : triangles_of(order, source.mode)) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      ++omissions.collapsed;
      continue;
    }
    Face face;
    face.outer.assign(t.begin(), t.end());
    if (!primitive.normals.empty()) face.normals = face.outer;
    primitive.faces.push_back(std::move(face));
  }
  return primitive;
}

}  // namespace

std::vector<GltfPrimitive> read_gltf_mesh(const GltfModel& gltf, const GltfAccessors& accessors, int mesh,
                                          GltfOmissions& omissions) {
  const tinygltf::Mesh& source = gltf.model.meshes[static_cast<std::size_t>(mesh)];
  std::vector<GltfPrimitive> primitives;
  for (std::size_t i = 0; i < source.primitives.size(); ++i) {
    const std::string where = fmt::format("/meshes/{}/primitives/{}", mesh, i);
    primitives.push_back(read_primitive(gltf, accessors, source.primitives[i], where, omissions));
  }
  return primitives;
}

}  // namespace reemit

#include "scenes/io/gltf/gltf_meshes.h"

#include <algorithm>
#include <array>
#include <numeric>

#include <fmt/format.h>

#include "scenes/model/error.h"

namespace reemit {

namespace {

using IndexTriangle = std::array<std::uint32_t, 3>;

/// The corners of all triangles in the order of glTF 2.0, 3.7.2.1, so that every front stays a front.
std::vector<IndexTriangle> triangles_of(const std::vector<std::uint32_t>& v, int mode) {
  std::vector<IndexTriangle> triangles;
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

void read_texture_points(const GltfModel& gltf, const GltfAccessors& accessors,
                         const tinygltf::Primitive& source, const std::string& where,
                         GltfPrimitive& primitive) {
  const auto points = [&](std::size_t count, const std::string& pointer) -> std::vector<TexturePoint>& {
    if (count != primitive.positions.size())
      throw InputError(gltf.at(pointer),
                       fmt::format("{} values for {} positions", count, primitive.positions.size()),
                       "Export the file anew.");
    primitive.texture_points.resize(count);
    return primitive.texture_points;
  };
  for (std::size_t set = 0; set < TexturePoint::kSets; ++set) {
    const std::string name = fmt::format("TEXCOORD_{}", set);
    const int accessor = attribute(source, name.c_str());
    if (accessor < 0) continue;
    const std::string pointer = fmt::format("{}/attributes/{}", where, name);
    const auto values = accessors.vec2(accessor, pointer);
    std::vector<TexturePoint>& to = points(values.size(), pointer);
    for (std::size_t i = 0; i < values.size(); ++i) to[i].uv[set] = values[i];
  }
  const int colours = attribute(source, "COLOR_0");
  if (colours < 0) return;
  const std::string pointer = where + "/attributes/COLOR_0";
  const auto put = [&](const auto& values) {
    std::vector<TexturePoint>& to = points(values.size(), pointer);
    for (std::size_t i = 0; i < values.size(); ++i)
      for (int c = 0; c < 3; ++c)
        to[i].colour[static_cast<std::size_t>(c)] = static_cast<float>(std::clamp(values[i][c], 0.0, 1.0));
  };
  const auto& all = gltf.model.accessors;
  const bool has_alpha = static_cast<std::size_t>(colours) < all.size() &&
                         all[static_cast<std::size_t>(colours)].type == TINYGLTF_TYPE_VEC4;
  if (has_alpha)
    put(accessors.vec4(colours, pointer));
  else
    put(accessors.vec3(colours, pointer));
  primitive.has_colours = true;
}

/// Adds what the targets of a primitive add to one of its attributes, by weight.
void add_targets(const GltfModel& gltf, const GltfAccessors& accessors, const tinygltf::Primitive& source,
                 const char* name, const std::vector<double>& weights, const std::string& where,
                 std::vector<Vec3>& values) {
  for (std::size_t t = 0; t < std::min(source.targets.size(), weights.size()); ++t) {
    const auto target = source.targets[t].find(name);
    if (weights[t] == 0 || target == source.targets[t].end()) continue;
    const std::string pointer = fmt::format("{}/targets/{}/{}", where, t, name);
    const std::vector<Vec3> moves = accessors.vec3(target->second, pointer);
    if (moves.size() != values.size())
      throw InputError(gltf.at(pointer), fmt::format("{} moves for {} vertices", moves.size(), values.size()),
                       "Export the file anew.");
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += weights[t] * moves[i];
  }
}

GltfPrimitive read_primitive(const GltfModel& gltf, const GltfAccessors& accessors,
                             const tinygltf::Primitive& source, const std::vector<double>& weights,
                             const std::string& where, GltfOmissions& omissions) {
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
  const int positions = attribute(source, "POSITION");
  if (positions < 0) {
    throw InputError(gltf.at(where), "the primitive has no positions", "Export the file anew.");
  }
  primitive.positions = accessors.vec3(positions, where + "/attributes/POSITION");
  add_targets(gltf, accessors, source, "POSITION", weights, where, primitive.positions);
  if (const int normals = attribute(source, "NORMAL"); normals >= 0) {
    primitive.normals = accessors.vec3(normals, where + "/attributes/NORMAL");
    if (primitive.normals.size() != primitive.positions.size()) {
      throw InputError(
          gltf.at(where + "/attributes/NORMAL"),
          fmt::format("{} normals for {} positions", primitive.normals.size(), primitive.positions.size()),
          "Export the file anew.");
    }
    add_targets(gltf, accessors, source, "NORMAL", weights, where, primitive.normals);
  }
  read_texture_points(gltf, accessors, source, where, primitive);
  std::vector<std::uint32_t> order;
  if (source.indices >= 0) {
    order = accessors.indices(source.indices, primitive.positions.size(), where + "/indices");
  } else {
    order.resize(primitive.positions.size());
    std::iota(order.begin(), order.end(), 0u);
  }
  for (const IndexTriangle& t : triangles_of(order, source.mode)) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      ++omissions.collapsed;
      continue;
    }
    Face face;
    face.outer.assign(t.begin(), t.end());
    if (!primitive.normals.empty()) face.normals = face.outer;
    if (!primitive.texture_points.empty()) face.texture_points = face.outer;
    primitive.faces.push_back(std::move(face));
  }
  return primitive;
}

}  // namespace

std::vector<GltfPrimitive> read_gltf_mesh(const GltfModel& gltf, const GltfAccessors& accessors, int mesh,
                                          const std::vector<double>& weights, GltfOmissions& omissions) {
  const tinygltf::Mesh& source = gltf.model.meshes[static_cast<std::size_t>(mesh)];
  std::vector<GltfPrimitive> primitives;
  for (std::size_t i = 0; i < source.primitives.size(); ++i) {
    const std::string where = fmt::format("/meshes/{}/primitives/{}", mesh, i);
    primitives.push_back(read_primitive(gltf, accessors, source.primitives[i], weights, where, omissions));
  }
  return primitives;
}

}  // namespace reemit

#include "viewer_export/formats/glb_writer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/model/error.h"
#include "viewer_export/formats/glb_file.h"
#include "viewer_export/formats/vertex_export.h"

namespace reemit {
namespace {

using Json = nlohmann::ordered_json;

float finite(double value) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  if (std::isnan(value)) return 0;
  return static_cast<float>(std::clamp<double>(value, -kLargest, kLargest));
}

// The vertices and triangles of one surface, as ranges of the reordered arrays.
struct Part {
  SurfaceId surface;
  MaterialId material;
  std::size_t first_vertex = 0, vertex_count = 0;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // relative to first_vertex
};

// Vertices in the order of their surfaces, so that every mesh of the file is one range of the buffers.
struct Layout {
  std::vector<std::uint32_t> order;  // new vertex -> vertex of the data
  std::vector<Part> parts;
};

bool degenerate(const std::array<std::uint32_t, 3>& t, const std::vector<Eigen::Vector3f>& p) {
  return p[t[0]] == p[t[1]] || p[t[1]] == p[t[2]] || p[t[2]] == p[t[0]];
}

Layout lay_out(const VertexData& data, const std::vector<Eigen::Vector3f>& positions) {
  std::vector<std::vector<std::array<std::uint32_t, 3>>> triangles(data.surface_names.size());
  std::vector<bool> used(data.vertex_count(), false);
  for (const auto& t : data.triangles) {
    if (degenerate(t, positions)) continue;
    triangles[data.surfaces[t[0]].index()].push_back(t);
    for (const std::uint32_t v : t) used[v] = true;
  }
  Layout layout;
  for (std::uint32_t v = 0; v < data.vertex_count(); ++v)
    if (used[v]) layout.order.push_back(v);
  std::stable_sort(layout.order.begin(), layout.order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return data.surfaces[a] < data.surfaces[b]; });
  std::vector<std::uint32_t> place(data.vertex_count());
  for (std::uint32_t i = 0; i < layout.order.size(); ++i) place[layout.order[i]] = i;

  std::size_t next = 0;
  for (std::size_t s = 0; s < triangles.size(); ++s) {
    if (triangles[s].empty()) continue;
    Part part{SurfaceId(s), data.materials[triangles[s].front()[0]], next, 0, std::move(triangles[s])};
    while (next < layout.order.size() && data.surfaces[layout.order[next]] == part.surface) ++next;
    part.vertex_count = next - part.first_vertex;
    for (auto& t : part.triangles)
      for (std::uint32_t& v : t) v = place[v] - static_cast<std::uint32_t>(part.first_vertex);
    layout.parts.push_back(std::move(part));
  }
  return layout;
}

// One vertex attribute: its name, its numbers per vertex, and how to append them for a vertex of the data.
struct Attribute {
  std::string semantic;
  int components;
  std::function<void(std::string&, std::uint32_t)> append;
};

std::vector<Attribute> attributes_of(const VertexData& data, const VertexColours& colours,
                                     const std::vector<Eigen::Vector3f>& positions) {
  const auto vector = [](std::string semantic, auto value_of) {
    return Attribute{std::move(semantic), 3, [value_of](std::string& out, std::uint32_t v) {
                       const auto value = value_of(v);
                       for (Eigen::Index c = 0; c < 3; ++c) append_bytes(out, finite(value[c]));
                     }};
  };
  const auto rgb = [&data, &vector](std::string semantic, const std::vector<float>& values) {
    return vector(std::move(semantic), [&data, &values](std::uint32_t v) { return data.rgb(values, v); });
  };
  std::vector<Attribute> attributes;
  attributes.push_back(vector("POSITION", [&positions](std::uint32_t v) { return positions[v]; }));
  attributes.push_back(vector("NORMAL", [&data](std::uint32_t v) -> Vec3 {
    const Vec3 normal = data.normals[v].normalized();
    return std::abs(normal.norm() - 1) < 1e-6 ? normal : Vec3(Vec3::UnitZ());
  }));
  attributes.push_back(vector("COLOR_0", [&colours](std::uint32_t v) { return colours.displayable(v); }));
  attributes.push_back(rgb("_RADIANCE", data.radiance));
  attributes.push_back(rgb("_IRRADIANCE", data.irradiance));
  std::vector<std::pair<const char*, const std::vector<float>*>> parts{{"_STDERR", &data.radiance_stderr},
                                                                       {"_DIRECT", &data.direct_radiance}};
  if (!data.caustic_radiance.empty()) parts.emplace_back("_CAUSTIC", &data.caustic_radiance);
  if (data.bands.kind() == BandKind::kRgb) {
    for (const auto& [name, values] : parts) attributes.push_back(rgb(name, *values));
    return attributes;
  }
  const std::size_t bands = data.bands.count();
  const auto scalar = [&](const std::string& semantic, const std::vector<float>& values, std::size_t band) {
    attributes.push_back({semantic, 1, [&values, bands, band](std::string& out, std::uint32_t v) {
                            append_bytes(out, finite(values[v * bands + band]));
                          }});
  };
  for (std::size_t band = 0; band < bands; ++band) {
    std::string suffix = data.bands.name(band);
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    scalar("_RADIANCE_" + suffix, data.radiance, band);
    scalar("_IRRADIANCE_" + suffix, data.irradiance, band);
    for (const auto& [name, values] : parts) scalar(std::string(name) + "_" + suffix, *values, band);
  }
  return attributes;
}

Json extras_of(const VertexData& data, const ToneMap& tone_map) {
  Json extras;
  for (const auto& [name, value] : describe_values(data.info, data.bands))
    std::visit([&extras, &key = name](const auto& v) { extras[key] = v; }, value);
  extras["_RADIANCE"] = "W/(m2 sr), linear Rec.709";
  extras["_IRRADIANCE"] = "W/m2, linear Rec.709";
  extras["COLOR_0"] = tone_map.statement();
  extras["exposure"] = tone_map.exposure();
  extras["exposure_ev"] = tone_map.exposure_ev();
  extras["white"] = tone_map.white();
  extras["axes"] = has_z_up(data.up)
                       ? "in the meshes as in the room file, z up; the node above them turns z up to y up"
                       : "as in the room file";
  extras["backs"] = fmt::format("moved at most {:.3g} m off their fronts", back_gap(data));
  return extras;
}

// The views of the binary chunk: one per attribute, in their order, then the indices.
BufferViews views_of(const Layout& layout, const std::vector<Attribute>& attributes) {
  BufferViews views;
  for (const Attribute& a : attributes) {
    const auto stride = 4 * static_cast<std::size_t>(a.components);
    views.add(layout.order.size() * stride, Gltf::kArrayBuffer, stride);
  }
  const std::size_t index_count =
      3 * std::accumulate(layout.parts.begin(), layout.parts.end(), std::size_t{0},
                          [](std::size_t n, const Part& p) { return n + p.triangles.size(); });
  views.add(4 * index_count, Gltf::kElementArrayBuffer);
  return views;
}

// What the parts of the layout are in glTF, a mesh and a node for each.
class MeshLists {
 public:
  MeshLists(const VertexData& data, const Layout& layout, const std::vector<Attribute>& attributes,
            const std::vector<Eigen::Vector3f>& positions, const Vec3& origin)
      : data_(data),
        layout_(layout),
        attributes_(attributes),
        positions_(positions),
        origin_(origin),
        material_number_(data.material_names.size(), -1) {
    for (const Part& part : layout.parts) add(part);
  }

  void add_to(Json& gltf) && {
    Json roots = Json::array();
    for (std::size_t i = 0; i < nodes_.size(); ++i) roots.push_back(i);
    add_scene(gltf, std::move(nodes_), std::move(roots), data_.up);
    gltf["meshes"] = std::move(meshes_);
    gltf["materials"] = std::move(materials_);
    gltf["accessors"] = std::move(accessors_);
  }

 private:
  void add(const Part& part) {
    Json primitive;
    for (std::size_t a = 0; a < attributes_.size(); ++a) {
      primitive["attributes"][attributes_[a].semantic] = accessors_.size();
      accessors_.push_back(values_of(part, a));
    }
    primitive["indices"] = accessors_.size();
    accessors_.push_back({{"bufferView", attributes_.size()},
                          {"byteOffset", index_offset_},
                          {"componentType", Gltf::kUnsignedInt},
                          {"count", 3 * part.triangles.size()},
                          {"type", "SCALAR"}});
    index_offset_ += 12 * part.triangles.size();
    primitive["material"] = number_of(part.material);
    primitive["mode"] = Gltf::kTriangles;
    const std::string& name = data_.surface_names[part.surface.index()];
    nodes_.push_back({{"name", name}, {"mesh", meshes_.size()}});
    if (origin_ != Vec3::Zero()) nodes_.back()["translation"] = {origin_.x(), origin_.y(), origin_.z()};
    meshes_.push_back({{"name", name}, {"primitives", Json::array({std::move(primitive)})}});
  }

  // The accessor of one attribute; readers require the bounds of positions.
  Json values_of(const Part& part, std::size_t attribute) const {
    const int components = attributes_[attribute].components;
    Json accessor = {{"bufferView", attribute},
                     {"byteOffset", part.first_vertex * 4 * static_cast<std::size_t>(components)},
                     {"componentType", Gltf::kFloat},
                     {"count", part.vertex_count},
                     {"type", components == 3 ? "VEC3" : "SCALAR"}};
    if (attributes_[attribute].semantic != "POSITION") return accessor;
    Eigen::Vector3f low = positions_[layout_.order[part.first_vertex]];
    Eigen::Vector3f high = low;
    for (std::size_t i = 0; i < part.vertex_count; ++i) {
      low = low.cwiseMin(positions_[layout_.order[part.first_vertex + i]]);
      high = high.cwiseMax(positions_[layout_.order[part.first_vertex + i]]);
    }
    accessor["min"] = {low.x(), low.y(), low.z()};
    accessor["max"] = {high.x(), high.y(), high.z()};
    return accessor;
  }

  // Of a material, which is listed when a part first has it.
  int number_of(MaterialId id) {
    int& material = material_number_[id.index()];
    if (material < 0) {
      material = static_cast<int>(materials_.size());
      materials_.push_back({{"name", data_.material_names[id.index()]},
                            {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 1.0}}},
                            {"extensions", {{"KHR_materials_unlit", Json::object()}}}});
    }
    return material;
  }

  const VertexData& data_;
  const Layout& layout_;
  const std::vector<Attribute>& attributes_;
  const std::vector<Eigen::Vector3f>& positions_;
  const Vec3& origin_;
  Json accessors_ = Json::array();
  Json meshes_ = Json::array();
  Json nodes_ = Json::array();
  Json materials_ = Json::array();
  std::vector<int> material_number_;  // -1: not listed yet
  std::size_t index_offset_ = 0;      // [bytes]
};

// The JSON chunk.
Json document(const VertexData& data, const Layout& layout, const std::vector<Attribute>& attributes,
              const std::vector<Eigen::Vector3f>& positions, const Vec3& origin, const ToneMap& tone_map) {
  Json gltf;
  gltf["asset"] = {{"version", "2.0"},
                   {"generator", "reemit " + data.info.program_version},
                   {"extras", extras_of(data, tone_map)}};
  gltf["extensionsUsed"] = {"KHR_materials_unlit"};
  MeshLists(data, layout, attributes, positions, origin).add_to(gltf);
  views_of(layout, attributes).add_to(gltf);
  return gltf;
}

}  // namespace

std::optional<ToneMap> write_glb(const VertexData& data, OutputFile& file) {
  const Vec3 origin = single_precision_origin(data);
  std::vector<Eigen::Vector3f> positions;
  positions.reserve(data.vertex_count());
  for (const Vec3& p : positions_for_viewing(data, back_gap(data)))
    positions.push_back((p - origin).cast<float>());
  const Layout layout = lay_out(data, positions);
  if (layout.parts.empty())
    throw InputError("glTF export", "the room has no triangle to draw", "Check the room with `reemit info`.");
  const VertexColours colours = colours_of(data);
  const std::vector<Attribute> attributes = attributes_of(data, colours, positions);

  const Json gltf = document(data, layout, attributes, positions, origin, colours.tone_map);
  begin_glb(gltf, "Write .ply or .csv, or solve with larger zones.", file);
  std::string bytes;
  for (const Attribute& attribute : attributes)
    for (const std::uint32_t v : layout.order) {
      bytes.clear();
      attribute.append(bytes, v);
      file.write(bytes);
    }
  for (const Part& part : layout.parts)
    for (const auto& triangle : part.triangles) {
      bytes.clear();
      for (const std::uint32_t v : triangle) append_bytes(bytes, v);
      file.write(bytes);
    }
  return colours.tone_map;
}

}  // namespace reemit

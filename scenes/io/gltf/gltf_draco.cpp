#include "scenes/io/gltf/gltf_draco.h"

#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/io/common/json_cursor.h"
#include "scenes/io/common/surface_geometry.h"
#include "scenes/io/gltf/gltf_accessors.h"
#include "scenes/io/gltf/gltf_draco_mesh.h"
#include "scenes/model/memory.h"

namespace reemit {
namespace {

constexpr int kMostIndex = std::numeric_limits<int>::max();

/// Values of an attribute, one after the other, as components of type T.
template <class T>
bool append_values(const draco::PointAttribute& attribute, std::size_t points, int components,
                   std::vector<unsigned char>& bytes) {
  std::vector<T> value(static_cast<std::size_t>(components));
  for (std::size_t i = 0; i < points; ++i) {
    const auto index = attribute.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i)));
    if (index.value() >= attribute.size() ||
        !attribute.ConvertValue(index, static_cast<std::int8_t>(components), value.data()))
      return false;
    const auto* begin = reinterpret_cast<const unsigned char*>(value.data());
    bytes.insert(bytes.end(), begin, begin + value.size() * sizeof(T));
  }
  return true;
}

bool append_values_as(int component_type, const draco::PointAttribute& attribute, std::size_t points,
                      int components, std::vector<unsigned char>& bytes) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return append_values<std::int8_t>(attribute, points, components, bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return append_values<std::uint8_t>(attribute, points, components, bytes);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return append_values<std::int16_t>(attribute, points, components, bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return append_values<std::uint16_t>(attribute, points, components, bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return append_values<std::uint32_t>(attribute, points, components, bytes);
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return append_values<float>(attribute, points, components, bytes);
    default:
      return false;
  }
}

/// Decodes the primitives of one file.
class DracoPrimitives {
 public:
  explicit DracoPrimitives(GltfModel& gltf) : gltf_(gltf) {}

  /// `pointer`: that of the primitive in its file.
  void decode(const JsonCursor& at, const std::string& pointer, tinygltf::Primitive& primitive) {
    view_pointer_ = fmt::format("{}/extensions/{}/bufferView", pointer, kDracoCompression);
    const JsonCursor extension = at.at("extensions").at(kDracoCompression);
    const auto listed = extension.at("attributes").members();
    const auto indices = at.find("indices");
    if (indices) primitive.indices = indices->integer_in(-1, kMostIndex);  // The parser did not see all.
    if (!needs_decoding(listed, primitive)) return;
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES)
      at.fail(fmt::format("Draco data in a primitive of the mode {}", primitive.mode),
              "Export it as triangles (mode 4).");
    if (!indices || primitive.indices < 0)
      at.fail("Draco data without an accessor of the indices", kDamagedAdvice);
    const std::size_t corners = accessor(primitive.indices, *indices).count;
    if (corners % 3 != 0 || corners / 3 > kMostFaces)
      indices->fail(fmt::format("{} indices", corners), kDamagedAdvice);
    const JsonCursor view = extension.at("bufferView");
    const Source source{view.integer_in(0, kMostIndex), corners / 3};
    for (const auto& [name, id] : listed) {
      const auto attribute = primitive.attributes.find(name);
      if (attribute == primitive.attributes.end())
        id.fail(fmt::format("the primitive has no attribute {}", name), kDamagedAdvice);
      attribute->second = decoded_attribute(source, id, attribute->second, view);
    }
    primitive.indices = decoded_indices(source, primitive.indices, view);
  }

 private:
  /// Data that several primitives may share.
  struct Source {
    int view;
    std::size_t faces;
    auto operator<=>(const Source&) const = default;
  };

  const tinygltf::Accessor& accessor(int index, const JsonCursor& at) const {
    if (static_cast<std::size_t>(index) >= gltf_.model.accessors.size())
      at.fail(fmt::format("there is no accessor {}", index), kDamagedAdvice);
    return gltf_.model.accessors[static_cast<std::size_t>(index)];
  }

  /// Files may hold the geometry twice, for programs that cannot decode it.
  bool needs_decoding(const std::vector<std::pair<std::string, JsonCursor>>& listed,
                      const tinygltf::Primitive& primitive) const {
    const auto lacks_bytes = [&](int index) {
      return index < 0 || static_cast<std::size_t>(index) >= gltf_.model.accessors.size() ||
             gltf_.model.accessors[static_cast<std::size_t>(index)].bufferView < 0;
    };
    if (lacks_bytes(primitive.indices)) return true;
    for (const auto& [name, id] : listed) {
      const auto attribute = primitive.attributes.find(name);
      if (attribute != primitive.attributes.end() && lacks_bytes(attribute->second)) return true;
    }
    return false;
  }

  const draco::Mesh& mesh(const Source& source, const JsonCursor& at) {
    std::unique_ptr<draco::Mesh>& known = meshes_[source];
    if (!known) {
      const auto [bytes, size] = GltfAccessors(gltf_).view_bytes(source.view, view_pointer_);
      known = decode_draco_mesh(bytes, size, source.faces, at);
    }
    return *known;
  }

  int decoded_attribute(const Source& source, const JsonCursor& id_at, int index, const JsonCursor& at) {
    const int id = id_at.integer_in(0, kMostIndex);
    const auto [known, is_new] = attributes_.try_emplace({source, id, index}, 0);
    if (!is_new) return known->second;
    const draco::Mesh& decoded = mesh(source, at);
    const draco::PointAttribute* attribute = decoded.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
    if (!attribute)
      id_at.fail(fmt::format("the Draco data have no attribute with the id {}", id), kDamagedAdvice);
    const tinygltf::Accessor promised = accessor(index, id_at);
    const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(promised.type));
    const std::size_t points = decoded.num_points();
    if (attribute->num_components() != components || points != promised.count)
      id_at.fail(fmt::format("{} values of {} components, where accessor {} promises {} of {}", points,
                             attribute->num_components(), index, promised.count, components),
                 kDamagedAdvice);
    constexpr double kMostPerComponent = sizeof(float);
    take_memory(kMostPerComponent * components * static_cast<double>(points), at);
    std::vector<unsigned char> bytes;
    if (!append_values_as(promised.componentType, *attribute, points, components, bytes))
      id_at.fail(fmt::format("its values do not fit the component type {} of accessor {}",
                             promised.componentType, index),
                 kDamagedAdvice);
    return known->second = append_accessor(promised, std::move(bytes));
  }

  int decoded_indices(const Source& source, int index, const JsonCursor& at) {
    const auto [known, is_new] = indices_.try_emplace(source, 0);
    if (!is_new) return known->second;
    const draco::Mesh& decoded = mesh(source, at);
    take_memory(3.0 * sizeof(std::uint32_t) * static_cast<double>(source.faces), at);
    std::vector<std::uint32_t> corners;
    corners.reserve(3 * source.faces);
    for (std::uint32_t i = 0; i < decoded.num_faces(); ++i)
      for (const draco::PointIndex& corner : decoded.face(draco::FaceIndex(i)))
        corners.push_back(corner.value());
    if (corners.size() != 3 * source.faces)
      at.fail(fmt::format("the Draco data have {} triangles, where accessor {} promises {}",
                          decoded.num_faces(), index, source.faces),
              kDamagedAdvice);
    tinygltf::Accessor accessor = gltf_.model.accessors[static_cast<std::size_t>(index)];
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    std::vector<unsigned char> bytes(corners.size() * sizeof(std::uint32_t));
    std::memcpy(bytes.data(), corners.data(), bytes.size());
    return known->second = append_accessor(accessor, std::move(bytes));
  }

  int append_accessor(tinygltf::Accessor accessor, std::vector<unsigned char> bytes) {
    tinygltf::Model& model = gltf_.model;
    tinygltf::Buffer buffer;
    buffer.data = std::move(bytes);
    tinygltf::BufferView view;
    view.buffer = static_cast<int>(model.buffers.size());
    view.byteLength = buffer.data.size();
    model.buffers.push_back(std::move(buffer));
    accessor.bufferView = static_cast<int>(model.bufferViews.size());
    accessor.byteOffset = 0;
    accessor.sparse.isSparse = false;
    model.bufferViews.push_back(view);
    model.accessors.push_back(accessor);
    return static_cast<int>(model.accessors.size()) - 1;
  }

  void take_memory(double bytes, const JsonCursor& at) {
    total_ += bytes;
    check_memory([&] { return at.where() + ": the decoded geometry"; }, total_, available_);
  }

  GltfModel& gltf_;
  std::map<Source, std::unique_ptr<draco::Mesh>> meshes_;
  std::map<std::tuple<Source, int, int>, int> attributes_;  ///< Accessor by source, id and promised accessor.
  std::map<Source, int> indices_;
  std::string view_pointer_;  ///< Of the data of the primitive that is being decoded, for messages.
  const std::optional<std::uint64_t> available_ = available_memory();
  double total_ = 0;  ///< Decoded so far [bytes].
};

}  // namespace

void decode_draco_primitives(const nlohmann::json& document, GltfModel& gltf) {
  DracoPrimitives primitives(gltf);
  const auto meshes = JsonCursor(document, gltf.file).find("meshes");
  for (std::size_t m = 0; m < gltf.model.meshes.size(); ++m) {
    const JsonCursor listed = (*meshes)[m].at("primitives");
    std::vector<tinygltf::Primitive>& all = gltf.model.meshes[m].primitives;
    for (std::size_t p = 0; p < all.size(); ++p)
      if (const auto extensions = listed[p].find("extensions"))
        if (extensions->find(kDracoCompression))
          primitives.decode(listed[p], fmt::format("/meshes/{}/primitives/{}", m, p), all[p]);
  }
}

}  // namespace reemit

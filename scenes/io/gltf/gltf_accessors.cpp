#include "scenes/io/gltf/gltf_accessors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "scenes/model/error.h"

namespace reemit {

namespace {

/// Most elements of an accessor that has no bytes behind it (all zero, or sparse): nothing else bounds their
/// number.
constexpr std::size_t kMostImplicitElements = 10'000'000;

template <class T>
double component(const unsigned char* bytes, bool normalized) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  if (!normalized || !std::numeric_limits<T>::is_integer) return static_cast<double>(value);
  // The most negative integer stands for -1 as well.
  return std::max(static_cast<double>(value) / static_cast<double>(std::numeric_limits<T>::max()), -1.0);
}

double read_component(const unsigned char* bytes, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return component<std::int8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return component<std::uint8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return component<std::int16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return component<std::uint16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return component<std::uint32_t>(bytes, normalized);
    default:
      return component<float>(bytes, normalized);
  }
}

bool is_unsigned_integer(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

}  // namespace

void GltfAccessors::fail(const std::string& where, const std::string& problem) const {
  throw InputError(gltf_.at(where), problem,
                   "Check the file with the Khronos glTF validator, or export it anew.");
}

std::pair<const unsigned char*, std::size_t> GltfAccessors::view_bytes(int view,
                                                                       const std::string& where) const {
  const tinygltf::Model& model = gltf_.model;
  if (view < 0 || static_cast<std::size_t>(view) >= model.bufferViews.size()) {
    fail(where, fmt::format("there is no buffer view {}", view));
  }
  const tinygltf::BufferView& buffer_view = model.bufferViews[static_cast<std::size_t>(view)];
  if (buffer_view.buffer < 0 || static_cast<std::size_t>(buffer_view.buffer) >= model.buffers.size()) {
    fail(where,
         fmt::format("buffer view {} lies in buffer {}, which does not exist", view, buffer_view.buffer));
  }
  const auto& data = model.buffers[static_cast<std::size_t>(buffer_view.buffer)].data;
  if (buffer_view.byteOffset > data.size() || buffer_view.byteLength > data.size() - buffer_view.byteOffset) {
    fail(where, fmt::format("buffer view {} ends outside of its buffer of {} bytes", view, data.size()));
  }
  return {data.data() + buffer_view.byteOffset, buffer_view.byteLength};
}

std::vector<double> GltfAccessors::numbers(int index, int components, const std::string& where) const {
  const tinygltf::Model& model = gltf_.model;
  if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size()) {
    fail(where, fmt::format("there is no accessor {}", index));
  }
  const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(index)];
  const std::string what = fmt::format("{}: accessor {}", where, index);
  const int found = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  if (found != components)
    fail(what, fmt::format("{} components per element, expected {}", found, components));
  const int type = accessor.componentType;
  if (type == TINYGLTF_COMPONENT_TYPE_INT || type == TINYGLTF_COMPONENT_TYPE_DOUBLE) {
    fail(what, "components of type int or double, which glTF does not allow");
  }
  const auto component_size =
      static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type)));
  const std::size_t size = component_size * static_cast<std::size_t>(components);

  if (accessor.bufferView < 0) {
    if (accessor.count > kMostImplicitElements)
      fail(what, fmt::format("{} elements without data", accessor.count));
    std::vector<double> zeros(accessor.count * static_cast<std::size_t>(components), 0.0);
    if (accessor.sparse.isSparse) apply_sparse(accessor, components, what, zeros);
    return zeros;
  }
  const auto [bytes, length] = view_bytes(accessor.bufferView, what);
  const std::size_t given_stride =
      model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
  const std::size_t stride = given_stride == 0 ? size : given_stride;
  if (stride < size) fail(what, fmt::format("a stride of {} bytes for elements of {}", stride, size));
  const bool fits =
      accessor.count == 0 || (accessor.byteOffset <= length && size <= length - accessor.byteOffset &&
                              accessor.count - 1 <= (length - accessor.byteOffset - size) / stride);
  if (!fits)
    fail(what,
         fmt::format("{} elements do not fit into the buffer view of {} bytes", accessor.count, length));
  std::vector<double> values;
  values.reserve(accessor.count * static_cast<std::size_t>(components));
  for (std::size_t i = 0; i < accessor.count; ++i) {
    const unsigned char* element = bytes + accessor.byteOffset + i * stride;
    for (int k = 0; k < components; ++k) {
      values.push_back(
          read_component(element + static_cast<std::size_t>(k) * component_size, type, accessor.normalized));
    }
  }
  if (accessor.sparse.isSparse) apply_sparse(accessor, components, what, values);
  return values;
}

void GltfAccessors::apply_sparse(const tinygltf::Accessor& accessor, int components, const std::string& where,
                                 std::vector<double>& values) const {
  const auto& sparse = accessor.sparse;
  if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) {
    fail(where, "a negative count or offset in its sparse part");
  }
  if (!is_unsigned_integer(sparse.indices.componentType))
    fail(where, "sparse indices are not unsigned integers");
  const auto count = static_cast<std::size_t>(sparse.count);
  const auto index_size = static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(sparse.indices.componentType)));
  const auto value_size = static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType)));
  const std::size_t element_size = value_size * static_cast<std::size_t>(components);
  const auto slice = [&](int view, int byte_offset, std::size_t size) {
    const auto [bytes, length] = view_bytes(view, where);
    const auto offset = static_cast<std::size_t>(byte_offset);
    if (offset > length || count > (length - offset) / size) {
      fail(where, fmt::format("{} sparse elements do not fit into their buffer view", count));
    }
    return bytes + offset;
  };
  const unsigned char* indices = slice(sparse.indices.bufferView, sparse.indices.byteOffset, index_size);
  const unsigned char* replaced = slice(sparse.values.bufferView, sparse.values.byteOffset, element_size);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(
        read_component(indices + i * index_size, sparse.indices.componentType, false));
    if (at >= accessor.count) fail(where, fmt::format("sparse index {} is out of range", at));
    for (std::size_t k = 0; k < static_cast<std::size_t>(components); ++k) {
      values[at * static_cast<std::size_t>(components) + k] = read_component(
          replaced + i * element_size + k * value_size, accessor.componentType, accessor.normalized);
    }
  }
}

std::vector<std::array<double, 2>> GltfAccessors::vec2(int accessor, const std::string& where) const {
  const std::vector<double> values = numbers(accessor, 2, where);
  std::vector<std::array<double, 2>> pairs;
  pairs.reserve(values.size() / 2);
  for (std::size_t i = 0; i + 1 < values.size(); i += 2) pairs.push_back({values[i], values[i + 1]});
  return pairs;
}

std::vector<Vec3> GltfAccessors::vec3(int accessor, const std::string& where) const {
  const std::vector<double> values = numbers(accessor, 3, where);
  std::vector<Vec3> vectors;
  vectors.reserve(values.size() / 3);
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
    vectors.emplace_back(values[i], values[i + 1], values[i + 2]);
    if (!vectors.back().allFinite())
      fail(where, fmt::format("element {} of accessor {} is not finite", i / 3, accessor));
  }
  return vectors;
}

std::vector<Eigen::Vector4d> GltfAccessors::vec4(int accessor, const std::string& where) const {
  const std::vector<double> values = numbers(accessor, 4, where);
  std::vector<Eigen::Vector4d> vectors;
  vectors.reserve(values.size() / 4);
  for (std::size_t i = 0; i + 3 < values.size(); i += 4) {
    vectors.emplace_back(values[i], values[i + 1], values[i + 2], values[i + 3]);
    if (!vectors.back().allFinite())
      fail(where, fmt::format("element {} of accessor {} is not finite", i / 4, accessor));
  }
  return vectors;
}

std::vector<std::uint32_t> GltfAccessors::indices(int accessor, std::size_t limit,
                                                  const std::string& where) const {
  const std::vector<double> values = numbers(accessor, 1, where);
  if (!is_unsigned_integer(gltf_.model.accessors[static_cast<std::size_t>(accessor)].componentType)) {
    fail(where, fmt::format("the indices in accessor {} are not unsigned integers", accessor));
  }
  std::vector<std::uint32_t> indices(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] >= static_cast<double>(limit)) {
      fail(where, fmt::format("index {} is out of range: there are {} vertices", values[i], limit));
    }
    indices[i] = static_cast<std::uint32_t>(values[i]);
  }
  return indices;
}

}  // namespace reemit

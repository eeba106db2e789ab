#include "scenes/io/gltf/gltf_meshopt.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

#include "scenes/io/common/json_cursor.h"
#include "scenes/model/memory.h"

namespace reemit {
namespace {

constexpr int kMostBytes = std::numeric_limits<int>::max();

/// What the extension says of one buffer view.
struct CompressedView {
  const unsigned char* bytes = nullptr;
  std::size_t length = 0;
  std::size_t count = 0;   ///< Of elements.
  std::size_t stride = 0;  ///< Bytes of an element.
  std::string mode;        ///< ATTRIBUTES, TRIANGLES or INDICES.
  std::string filter;      ///< NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL.

  std::size_t size() const { return count * stride; }
};

void check_shape(const CompressedView& view, const JsonCursor& at) {
  const JsonCursor stride = at.at("byteStride");
  const auto wrong_stride = [&] {
    stride.fail(fmt::format("{} bytes for each element in the mode {} with the filter {}", view.stride,
                            view.mode, view.filter),
                kDamagedAdvice);
  };
  if (view.mode != "ATTRIBUTES") {
    if (view.stride != 2 && view.stride != 4) wrong_stride();
    if (view.filter != "NONE") at.at("filter").fail("a filter of indices", kDamagedAdvice);
    if (view.mode == "TRIANGLES" && view.count % 3 != 0)
      at.at("count").fail(fmt::format("{} indices are no triangles", view.count), kDamagedAdvice);
    return;
  }
  constexpr std::size_t kLargestStride = 256;
  const bool fits_filter = view.filter == "OCTAHEDRAL"   ? view.stride == 4 || view.stride == 8
                           : view.filter == "QUATERNION" ? view.stride == 8
                                                         : true;
  if (view.stride % 4 != 0 || view.stride > kLargestStride || !fits_filter) wrong_stride();
}

/// What the codec cannot do without, so that a count is believed only if there are bytes for it: of
/// attributes two bits for 16 times the same byte, of triangles a byte and a table, of indices a byte.
bool is_long_enough(const CompressedView& view) {
  constexpr std::size_t kMostPerByte = 64, kTriangleTable = 16, kIndexTail = 4;
  if (view.mode == "ATTRIBUTES") return view.size() / kMostPerByte <= view.length;
  if (view.mode == "TRIANGLES") return view.count / 3 + kTriangleTable < view.length;
  return view.count + kIndexTail < view.length;
}

CompressedView read_view(const JsonCursor& at, const GltfModel& gltf) {
  const auto& buffers = gltf.model.buffers;
  const JsonCursor buffer = at.at("buffer");
  const auto index = static_cast<std::size_t>(buffer.integer_in(0, kMostBytes));
  if (index >= buffers.size()) buffer.fail(fmt::format("there is no buffer {}", index), kDamagedAdvice);
  const auto given_offset = at.find("byteOffset");
  const auto offset = static_cast<std::size_t>(given_offset ? given_offset->integer_in(0, kMostBytes) : 0);
  const JsonCursor length = at.at("byteLength");
  CompressedView view;
  view.length = static_cast<std::size_t>(length.integer_in(1, kMostBytes));
  const std::size_t available = buffers[index].data.size();
  if (offset > available || view.length > available - offset)
    length.fail(
        fmt::format("{} bytes from {} end outside of the buffer of {} bytes", view.length, offset, available),
        kDamagedAdvice);
  view.bytes = buffers[index].data.data() + offset;
  view.count = static_cast<std::size_t>(at.at("count").integer_in(1, kMostBytes));
  view.stride = static_cast<std::size_t>(at.at("byteStride").integer_in(1, kMostBytes));
  view.mode = at.at("mode").choice({"ATTRIBUTES", "TRIANGLES", "INDICES"});
  const auto filter = at.find("filter");
  view.filter = filter ? filter->choice({"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"}) : "NONE";
  check_shape(view, at);
  if (!is_long_enough(view))
    at.at("count").fail(fmt::format("{} elements of {} bytes are more than {} compressed bytes can hold",
                                    view.count, view.stride, view.length),
                        kDamagedAdvice);
  return view;
}

std::vector<unsigned char> decode(const CompressedView& view, const JsonCursor& at) {
  std::vector<unsigned char> decoded(view.size());
  int problem = 0;
  if (view.mode == "ATTRIBUTES")
    problem = meshopt_decodeVertexBuffer(decoded.data(), view.count, view.stride, view.bytes, view.length);
  else if (view.mode == "TRIANGLES")
    problem = meshopt_decodeIndexBuffer(decoded.data(), view.count, view.stride, view.bytes, view.length);
  else
    problem = meshopt_decodeIndexSequence(decoded.data(), view.count, view.stride, view.bytes, view.length);
  if (problem != 0)
    at.fail(fmt::format("the {} compressed bytes are not {} elements of {} bytes in the mode {}", view.length,
                        view.count, view.stride, view.mode),
            kDamagedAdvice);
  if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(decoded.data(), view.count, view.stride);
  if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(decoded.data(), view.count, view.stride);
  if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(decoded.data(), view.count, view.stride);
  return decoded;
}

}  // namespace

void decode_meshopt_views(const nlohmann::json& document, GltfModel& gltf) {
  const auto views = JsonCursor(document, gltf.file).find("bufferViews");
  const std::optional<std::uint64_t> available = available_memory();
  double total = 0;  // [bytes]
  for (std::size_t i = 0; i < gltf.model.bufferViews.size(); ++i) {
    const auto extensions = (*views)[i].find("extensions");
    const auto extension = extensions ? extensions->find(kMeshoptCompression) : std::nullopt;
    if (!extension) continue;
    const CompressedView view = read_view(*extension, gltf);
    total += static_cast<double>(view.size());
    check_memory([&] { return extension->where() + ": the decoded geometry"; }, total, available);
    tinygltf::Buffer decoded;
    decoded.data = decode(view, *extension);
    tinygltf::BufferView& shown = gltf.model.bufferViews[i];
    shown.buffer = static_cast<int>(gltf.model.buffers.size());
    shown.byteOffset = 0;
    shown.byteLength = decoded.data.size();
    gltf.model.buffers.push_back(std::move(decoded));
  }
}

}  // namespace reemit

#include "viewer_export/formats/glb_file.h"

#include <limits>
#include <numbers>
#include <utility>

#include "scenes/model/error.h"
#include "viewer_export/formats/vertex_export.h"

namespace reemit {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kMagic = 0x46546C67;
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinChunk = 0x004E4942;

}  // namespace

bool has_z_up(const Vec3& up) {
  return up.z() > 0.5;
}

void add_scene(Json& gltf, Json nodes, Json roots, const Vec3& up) {
  if (has_z_up(up)) {
    const double half = std::numbers::sqrt2 / 2;
    nodes.push_back(
        {{"name", "z up to y up"}, {"rotation", {-half, 0.0, 0.0, half}}, {"children", std::move(roots)}});
    roots = Json::array({nodes.size() - 1});
  }
  gltf["scene"] = 0;
  gltf["scenes"] = Json::array({{{"nodes", std::move(roots)}}});
  gltf["nodes"] = std::move(nodes);
}

std::size_t BufferViews::add(std::size_t bytes, int target, std::size_t stride) {
  views_.push_back({{"buffer", 0}, {"byteOffset", bytes_}, {"byteLength", bytes}, {"target", target}});
  if (stride > 0) views_.back()["byteStride"] = stride;
  bytes_ += bytes;
  return views_.size() - 1;
}

void BufferViews::add_to(Json& gltf) && {
  gltf["bufferViews"] = std::move(views_);
  gltf["buffers"] = Json::array({{{"byteLength", bytes_}}});
}

void begin_glb(const Json& gltf, const std::string& advice, OutputFile& file) {
  std::string json = gltf.dump(-1, ' ', false, Json::error_handler_t::replace);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto binary_bytes = gltf["buffers"][0]["byteLength"].get<std::size_t>();
  const std::size_t total = 12 + 8 + json.size() + 8 + binary_bytes;
  if (total > std::numeric_limits<std::uint32_t>::max())
    throw InputError("glTF export", "the file would exceed 4 GiB, the limit of .glb", advice);
  std::string bytes;
  for (const std::uint32_t word : {kMagic, kVersion, static_cast<std::uint32_t>(total),
                                   static_cast<std::uint32_t>(json.size()), kJsonChunk})
    append_bytes(bytes, word);
  bytes += json;
  append_bytes(bytes, static_cast<std::uint32_t>(binary_bytes));
  append_bytes(bytes, kBinChunk);
  file.write(bytes);
}

}  // namespace reemit

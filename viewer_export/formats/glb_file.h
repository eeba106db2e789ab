#pragma once
#include <cstddef>
#include <string>

#include <nlohmann/json.hpp>

#include "scenes/io/common/output_file.h"
#include "scenes/model/vec.h"

namespace reemit {

/// Numbers that the glTF 2.0 specification assigns.
struct Gltf {
  static constexpr int kUnsignedByte = 5121;
  static constexpr int kUnsignedInt = 5125;
  static constexpr int kFloat = 5126;
  static constexpr int kArrayBuffer = 34962;
  static constexpr int kElementArrayBuffer = 34963;
  static constexpr int kLines = 1;
  static constexpr int kTriangles = 4;
};

/// Whether the way that is up in a room is z, which glTF files turn: there it is y.
bool has_z_up(const Vec3& up);

/// Makes `nodes` and the one scene of a document; `roots` are the nodes that have no parent. Rooms with z up
/// get a node above them that turns them.
void add_scene(nlohmann::ordered_json& gltf, nlohmann::ordered_json nodes, nlohmann::ordered_json roots,
               const Vec3& up);

/// The views of the binary chunk of a .glb, one after the other.
class BufferViews {
 public:
  /// `target`: Gltf::kArrayBuffer of vertices, with the bytes of each in `stride`, or kElementArrayBuffer.
  /// Returns its number.
  std::size_t add(std::size_t bytes, int target, std::size_t stride = 0);
  /// Makes `bufferViews` and `buffers`.
  void add_to(nlohmann::ordered_json& gltf) &&;

 private:
  nlohmann::ordered_json views_ = nlohmann::ordered_json::array();
  std::size_t bytes_ = 0;
};

/// Writes a .glb up to the first byte of its binary chunk; the caller appends as many as `buffers` of the
/// document says, a multiple of 4. Throws InputError with this advice where the file would exceed the 4 GiB
/// of the format.
void begin_glb(const nlohmann::ordered_json& gltf, const std::string& advice, OutputFile& file);

}  // namespace reemit

#pragma once
#include <filesystem>
#include <string>

#include "scenes/model/scene.h"

namespace reemit {

enum class EmissiveUnits { kCandela, kWatt };  ///< cd/m2 or W/(sr m2).

/// What a file format leaves open.
struct ReadOptions {
  /// Unit of glTF emissiveFactor x emissive strength. The specification says cd/m2; exporters disagree.
  EmissiveUnits gltf_emissive_units = EmissiveUnits::kCandela;
  bool force_two_sided = false;  ///< Treat every face as reflecting on both sides (rooms with mixed winding).

  bool operator==(const ReadOptions&) const = default;
};

/// Reads a room; the format follows from the extension: .json .obj .gltf .glb .mgf (case is ignored).
/// The result has been through finish_scene. Throws InputError with file and line (or JSON pointer).
Scene read_scene(const std::filesystem::path& file, const ReadOptions& options = {});

}  // namespace reemit

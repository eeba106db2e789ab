#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "scenes/model/scene.h"

namespace reemit {

/// cd/m2, W/(sr m2), or what the program that wrote the file is known to write.
enum class EmissiveUnits { kByGenerator, kCandela, kWatt };

/// What a file format leaves open.
struct ReadOptions {
  /// Unit of glTF emissiveFactor x emissive strength. The specification says cd/m2; exporters disagree.
  EmissiveUnits gltf_emissive_units = EmissiveUnits::kByGenerator;
  bool force_two_sided = false;  ///< Treat every face as reflecting on both sides (rooms with mixed winding).
  /// Luminous efficacy by which the cd and lx of glTF lamps become watts [lm/W], finite and above 0. Nothing:
  /// by the program that wrote the file (docs/gltf_input.md).
  std::optional<double> gltf_light_efficacy;

  bool operator==(const ReadOptions&) const = default;
};

/// Reads a room; the format follows from the extension: .json .obj .gltf .glb .mgf (case is ignored).
/// The result has been through finish_scene. Throws InputError with file and line (or JSON pointer).
Scene read_scene(const std::filesystem::path& file, const ReadOptions& options = {});

/// The same for files, one or more, that are one room: only MGF has such rooms, read in order as one context.
/// Throws InputError for others.
Scene read_scene(std::span<const std::filesystem::path> files, const ReadOptions& options = {});

}  // namespace reemit

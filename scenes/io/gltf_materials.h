#pragma once
#include <vector>

#include "scenes/io/gltf_texture.h"
#include "scenes/io/scene_reader.h"

namespace reemit {

/// Appends the materials of a glTF file to an RGB scene, one per glTF material in the same order, and one
/// more for primitives without a material. docs/gltf_input.md has the conversion.
void read_gltf_materials(const GltfModel& gltf, const GltfAccessors& accessors, const ReadOptions& options,
                         Scene& scene);

/// Luminous efficacy that turns photometric values of glTF into radiometric ones [lm/W]; see BandSet.
inline constexpr double kGltfEfficacy = 179;

}  // namespace reemit

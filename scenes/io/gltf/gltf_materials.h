#pragma once
#include <vector>

#include "scenes/io/gltf/gltf_texture.h"
#include "scenes/io/gltf/gltf_units.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Appends the materials of a glTF file to an RGB scene, one per glTF material in the same order, and one
/// more for primitives without a material. docs/gltf_input.md has the conversion.
void read_gltf_materials(const GltfModel& gltf, const GltfAccessors& accessors, const GltfUnits& units,
                         Scene& scene);

}  // namespace reemit

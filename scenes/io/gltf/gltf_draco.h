#pragma once
#include <nlohmann/json_fwd.hpp>

#include "scenes/io/gltf/gltf_model.h"

namespace reemit {

inline constexpr const char* kDracoCompression = "KHR_draco_mesh_compression";

/// Decodes the primitives with KHR_draco_mesh_compression whose accessors have no bytes of their own: each
/// gets accessors with the decoded values, of the types that the file says. Throws InputError at the JSON
/// pointer for what does not fit or cannot be decoded, and ResourceError if it does not fit into memory.
void decode_draco_primitives(const nlohmann::json& document, GltfModel& gltf);

}  // namespace reemit

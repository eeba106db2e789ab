#pragma once
#include <nlohmann/json_fwd.hpp>

#include "scenes/io/gltf/gltf_model.h"

namespace reemit {

inline constexpr const char* kMeshoptCompression = "EXT_meshopt_compression";

/// Decodes the buffer views with EXT_meshopt_compression, each into a buffer of its own that the view then
/// shows. Throws InputError at the JSON pointer for what does not fit or cannot be decoded, and ResourceError
/// if it does not fit into memory.
void decode_meshopt_views(const nlohmann::json& document, GltfModel& gltf);

}  // namespace reemit

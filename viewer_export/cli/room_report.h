#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "mesh/build_mesh.h"
#include "scenes/model/scene.h"

namespace reemit::cli {

/// What `info` says about a room: units, size, materials, surfaces, luminaires with their power, cameras.
std::string room_text(const Scene& scene, const MeshResult& meshed);
/// The same; `light_warnings` are added to those of the room and of the mesh.
nlohmann::ordered_json room_json(const Scene& scene, const MeshResult& meshed,
                                 const std::vector<std::string>& light_warnings);
/// What `info` says about files that cannot be read as a room; `message` as InputError has it.
nlohmann::ordered_json refused_room_json(const std::vector<std::filesystem::path>& files,
                                         const std::string& message);

}  // namespace reemit::cli

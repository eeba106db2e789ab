#pragma once
#include <string>

#include <nlohmann/json.hpp>

#include "scenes/model/scene.h"

namespace reemit::cli {

/// What a room has of textures, one line of `info` without its head; empty if it has none.
std::string textures_text(const Scene& scene);

/// The same: images with size and memory, and what they vary.
nlohmann::ordered_json textures_json(const Scene& scene);

}  // namespace reemit::cli

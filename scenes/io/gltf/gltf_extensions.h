#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "scenes/io/gltf/gltf_model.h"

namespace reemit {

/// Throws InputError if the document requires an extension that may change its room in ways that are not
/// read, with what to do about it.
void check_gltf_extensions(const nlohmann::json& document, const std::string& file);

/// The document with what extensions allow and the parser does not know written in a way that it knows, if
/// there is any of it: data URIs of image formats beyond PNG and JPEG; buffers that only stand in for
/// compressed geometry and may have no bytes become buffers of one byte; buffers whose file or data URI is
/// longer get its length; indices that are in Draco data alone are taken out. `folder`: that file names are
/// relative to. Pre: check_gltf_document holds.
std::optional<nlohmann::json> simplified_for_parser(const nlohmann::json& document,
                                                    const std::filesystem::path& folder);

/// Textures that have their image by an extension alone get it as their source.
/// Throws InputError for a source that is no number.
void take_extended_texture_sources(const nlohmann::json& document, GltfModel& gltf);

}  // namespace reemit

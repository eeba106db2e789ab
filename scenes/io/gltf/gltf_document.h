#pragma once
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace reemit {

/// Throws InputError at the JSON pointer of the first value, of those that rooms are made of, that is missing
/// or of another type. The parser says no place, and takes a transform or an emission that is not made of
/// numbers for one that is not there.
void check_gltf_document(const nlohmann::json& document, const std::string& file);

}  // namespace reemit

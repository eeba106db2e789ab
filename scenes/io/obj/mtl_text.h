#pragma once
#include <string>
#include <vector>

namespace reemit {

/// The name of materials without one, which old Blenders write for faces without a material.
inline constexpr const char* kNoMaterialName = "no material";

/// The text of the MTL file `name` as tinyobjloader is to read it: checked, one statement a line, numbers
/// without comments. Shares above 1 (up to 10) become 1 and Ns below 0 becomes 0, statements before the first
/// newmtl are left out, each with a warning; a map_Ke without Ke gets one of 1 W/(m2 sr), with a note. Throws
/// InputError with file and line.
std::string checked_mtl_text(const std::string& text, const std::string& name,
                             std::vector<std::string>& notes, std::vector<std::string>& warnings);

}  // namespace reemit

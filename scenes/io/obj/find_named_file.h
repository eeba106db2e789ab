#pragma once
#include <filesystem>
#include <string>

namespace reemit {

/// The file that an OBJ or MTL file in `folder` names: as it is named; else with its names in any case; else
/// one of its last name in `folder`, whatever its case. Paths of another computer, file systems that ignore
/// case, backslashes and quotation marks leave all of these. Empty if there is none.
std::filesystem::path find_named_file(const std::filesystem::path& folder, std::string name);

}  // namespace reemit

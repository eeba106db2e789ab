#pragma once
#include <filesystem>

namespace reemit::test {

/// The rooms that come with reemit.
inline const std::filesystem::path kLibrary = std::filesystem::path(REEMIT_SOURCE_DIR) / "scenes" / "library";

}  // namespace reemit::test

#pragma once
#include <string>

#include "viewer_export/cli/manual/program_outline.h"

namespace reemit::cli {

/// The page reemit(1) in roff, with the macros of man(7).
std::string manual_page(const ProgramOutline& outline);

}  // namespace reemit::cli

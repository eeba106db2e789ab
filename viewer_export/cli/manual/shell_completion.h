#pragma once
#include <string>

#include "viewer_export/cli/manual/program_outline.h"

namespace reemit::cli {

/// A script for bash that completes commands, options, and values that are words; for values that are files
/// bash completes file names. It needs nothing but bash, or zsh with its bashcompinit.
std::string bash_completion(const ProgramOutline& outline);

}  // namespace reemit::cli

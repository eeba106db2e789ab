#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "viewer_export/cli/command_options.h"
#include "viewer_export/cli/exit_code.h"

namespace reemit::cli {

struct FormFactorExport {
  std::filesystem::path solution;
  std::filesystem::path output;
  std::uint64_t seed = 1;
  OutputStyle style;
};

/// Computes the form factors of the zones of a solution file and writes them. Throws as compute_form_factors
/// and write_form_factors do.
ExitCode export_form_factors(const FormFactorExport& options);

/// The extensions it knows, for --help.
std::string form_factor_formats_help();

}  // namespace reemit::cli

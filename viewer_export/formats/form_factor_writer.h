#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/zones/zone_mesh.h"
#include "scenes/io/common/output_file.h"
#include "solver/matrix/form_factors.h"

namespace reemit {

/// Form factors with what a file says about them.
struct FormFactorData {
  const FormFactors& factors;
  const ZoneMesh& mesh;
  const std::vector<std::string>& surface_names;           ///< By SurfaceId.
  std::vector<std::pair<std::string, std::string>> notes;  ///< {name, value}, one line each.
};

/// One output format for form factors.
struct FormFactorFormat {
  std::string_view extension;    ///< Lower case with the dot: ".csv".
  std::string_view description;  ///< For --help.
  /// Throws InputError for more than the format holds, ResourceError when the file cannot be written.
  void (*write)(const FormFactorData& data, OutputFile& file);
};

/// All formats; the one place where a new one is added.
std::span<const FormFactorFormat> form_factor_formats();

/// The format of a file name by its extension (case is ignored). Throws InputError that lists the known ones.
const FormFactorFormat& form_factor_format_of(const std::filesystem::path& file);

/// Writes form factors in the format of the extension (docs/export_formats.md); the file appears whole or not
/// at all. Throws InputError for an unknown extension, ResourceError when the file cannot be written.
void write_form_factors(const FormFactorData& data, const std::filesystem::path& file);

}  // namespace reemit

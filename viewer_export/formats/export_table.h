#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scenes/io/common/output_file.h"
#include "viewer_export/output/tone_map.h"
#include "viewer_export/vertex/vertex_data.h"

namespace reemit {

/// One output format for vertex data.
struct ExportFormat {
  std::string_view extension;    ///< Lower case with the dot: ".ply".
  std::string_view description;  ///< For --help.
  bool shows_colours;            ///< Displayable ones, for which the data needs its tone map.
  /// Writes all of the data; returns the tone map of the displayable colours if the format has such.
  std::optional<ToneMap> (*write)(const VertexData& data, OutputFile& file);
};

/// All formats; the one place where a new one is added.
std::span<const ExportFormat> export_formats();

/// The format of a file name by its extension (case is ignored). Throws InputError that lists the known ones.
const ExportFormat& export_format_of(const std::filesystem::path& file);

/// Writes vertex data in the format of the extension; the file appears whole or not at all. Returns the tone
/// map of the displayable colours if the format has such. Throws InputError for an unknown extension,
/// ResourceError when the file cannot be written, std::invalid_argument for inconsistent data.
std::optional<ToneMap> write_vertex_data(const VertexData& data, const std::filesystem::path& file);

/// Throws InputError unless the format of the extension can hold photometric units.
void check_photometric(const std::filesystem::path& file);

/// Writes illuminance [lx] and luminance [cd/m2] instead. Throws as check_photometric and write_vertex_data.
void write_photometric_data(const VertexData& data, const std::filesystem::path& file);

}  // namespace reemit

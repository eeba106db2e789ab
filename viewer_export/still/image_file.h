#pragma once
#include <filesystem>
#include <span>
#include <string_view>

#include "scenes/io/common/output_file.h"
#include "viewer_export/output/tone_map.h"
#include "viewer_export/still/still_image.h"

namespace reemit {

/// What a written picture looks like, for printing.
struct WrittenImage {
  ToneMap tone_map;          ///< Exposure that suits the picture; burnt into PNG only.
  bool tone_mapped = false;  ///< The file holds displayable colours, not radiances.
};

/// One image format.
struct ImageFormat {
  std::string_view extension;    ///< Lower case with the dot: ".exr".
  std::string_view description;  ///< For --help.
  bool tone_mapped;              ///< Holds displayable colours, not radiances.
  bool by_image_library;         ///< Written by image_library(), which takes a quarter of a second to load.
  void (*write)(const StillImage& image, std::span<const float> rgb, const ToneMap& tone_map,
                OutputFile& file);
};

/// All formats; the one place where a new one is added.
std::span<const ImageFormat> image_formats();

/// The format of a file name by its extension (case is ignored). Throws InputError that lists the known ones.
const ImageFormat& image_format_of(const std::filesystem::path& file);

/// Writes a picture in the format of the extension; the file appears whole or not at all. EXR holds all
/// layers, HDR and PNG the picture only. Throws InputError for an unknown extension, ResourceError when the
/// file cannot be written, std::invalid_argument for an inconsistent picture or settings out of range.
WrittenImage write_still_image(const StillImage& image, const std::filesystem::path& file,
                               const ToneMapSettings& settings = {});

}  // namespace reemit

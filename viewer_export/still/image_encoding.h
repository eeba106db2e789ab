#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenes/io/common/output_file.h"
#include "scenes/io/images/image_library.h"
#include "viewer_export/still/still_image.h"

namespace reemit {

/// A picture of the size of `image`, without metadata.
ImageDescription sized_as(const StillImage& image, std::string_view format, PixelType type,
                          std::vector<std::string> channels = {"R", "G", "B"});

/// Program, room, units, seed, error and settings: names, which start with "reemit:" but for "Software", and
/// values.
std::vector<std::pair<std::string, std::string>> metadata_of(const StillImage& image);

/// Adds these to the metadata of a picture.
void add_metadata(const StillImage& image, ImageDescription& description);

/// Encodes a whole picture; `pixels` as the description has it. Throws ResourceError when the disk is full or
/// the library fails.
void encode_image(const ImageDescription& description, const void* pixels, OutputFile& file);
/// The same into memory.
std::string encode_image(const ImageDescription& description, const void* pixels);

}  // namespace reemit

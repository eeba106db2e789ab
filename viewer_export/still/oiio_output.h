#pragma once
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

#include "scenes/io/common/output_file.h"
#include "viewer_export/still/still_image.h"

namespace reemit {

/// Puts program, room, units, seed, error and settings into the metadata of a picture, names starting with
/// "reemit:".
void describe_image(const StillImage& image, OIIO::ImageSpec& spec);

/// Encodes a whole picture. `pixels` holds spec.nchannels values of `type` per pixel, rows from the top.
/// Throws ResourceError when the disk is full or OpenImageIO fails.
void encode_image(const std::string& format, const OIIO::ImageSpec& spec, const OIIO::TypeDesc& type,
                  const void* pixels, OutputFile& file);
/// The same into memory.
std::vector<unsigned char> encode_image(const std::string& format, const OIIO::ImageSpec& spec,
                                        const OIIO::TypeDesc& type, const void* pixels);

}  // namespace reemit

#pragma once
#include <filesystem>
#include <vector>

#include "bench/many_luminaires/direct_picture.h"

namespace reemit::bench {

/// Writes a PNG with the pictures in a row, all with the tone map of the last one, the reference; below them
/// two crops, framed in the pictures above, enlarged to the same size: where the first differs most from the
/// reference compared with the third, and where the second and the third differ most in how much they do.
/// Pre: four pictures of one size. Throws std::runtime_error when the file cannot be written.
void write_side_by_side(const std::vector<DirectPicture>& pictures, const std::filesystem::path& file);

}  // namespace reemit::bench

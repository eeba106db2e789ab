#pragma once
#include <filesystem>

#include "scenes/io/photometry/measured_luminaire.h"

namespace reemit {

/// Reads a EULUMDAT file [STO90] (docs/ies.md): planes C and angles gamma as in type C photometry of LM-63;
/// the length of the luminous area lies along C = 90, its width along C = 0. Of several lamp sets, which are
/// alternatives, the first counts. Throws InputError with file and line.
MeasuredLuminaire read_eulumdat_file(const std::filesystem::path& file);

}  // namespace reemit

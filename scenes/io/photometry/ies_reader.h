#pragma once
#include <filesystem>

#include "scenes/io/photometry/measured_luminaire.h"

namespace reemit {

/// Reads LM-63-1986, 1991, 1995, 2002 and 2019 files (docs/ies.md) [LM63]. The luminaire is named by the
/// keyword LUMINAIRE or LUMCAT, else the first label line, else the name of the file; lamp_lumens are those
/// after the ballast factor. Throws InputError with file and line.
MeasuredLuminaire read_ies_file(const std::filesystem::path& file);

}  // namespace reemit

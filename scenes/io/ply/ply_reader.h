#pragma once
#include <filesystem>

#include "scenes/model/surface.h"

namespace reemit {

/// The polygons of a PLY file (ASCII, binary little-endian or big-endian) in the unit of the file: vertex x y
/// z, and nx ny nz where given; face vertex_indices (or vertex_index). Every other element and property is
/// skipped. The surface has neither name nor material. Throws InputError with the file and line (ASCII) or
/// element number.
///
/// Read here and not with a mesh library: those at hand keep coordinates in single precision, drop polygons
/// that do not form a manifold, or do not survive damaged files.
Surface read_ply_surface(const std::filesystem::path& file);

}  // namespace reemit

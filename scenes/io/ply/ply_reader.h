#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "scenes/model/surface.h"

namespace reemit {

struct PlyMesh {
  Surface surface;  ///< Without name and material.
  std::vector<std::string> warnings;
};

/// The polygons of a PLY file (ASCII, binary little-endian or big-endian) in the unit of the file: vertex x y
/// z, with normals, texture coordinates and colours where given; vertex_indices (or vertex_index) of face,
/// and of tristrips. Every other element and property is skipped. Throws InputError with the file and line
/// (ASCII) or element number.
///
/// Read here and not with a mesh library: those at hand keep coordinates in single precision, drop polygons
/// that do not form a manifold, or do not survive damaged files.
PlyMesh read_ply(const std::filesystem::path& file);

}  // namespace reemit

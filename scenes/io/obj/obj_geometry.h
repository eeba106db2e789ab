#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenes/io/obj/obj_materials.h"
#include "scenes/model/vec.h"

namespace reemit {

/// One `f` statement with what was in effect there. Indices count from 0.
struct ObjFace {
  std::vector<std::uint32_t> positions;
  std::vector<std::uint32_t> normals;         ///< One per corner, or none.
  std::vector<std::uint32_t> texture_points;  ///< Likewise.
  std::size_t group = 0;                      ///< Into ObjGeometry::groups.
  std::size_t material = 0;                   ///< Into ObjMaterials::materials.
  std::uint32_t line = 0;
};

struct ObjGeometry {
  std::vector<Vec3> positions, normals;
  std::vector<std::array<double, 2>> texture_points;
  std::vector<ObjFace> faces;
  std::vector<std::string> groups;  ///< Names made of `o` and `g`; may be empty.
  std::vector<std::string> warnings;
  std::size_t ignored_statements = 0;  ///< That hold geometry other than polygons, or are of no known kind.
};

/// Reads the geometry of an OBJ file, and through `materials` the MTL files it names. Polygons stay polygons.
/// Throws InputError with file and line for everything that tinyobjloader would read as 0 or skip: missing or
/// garbled numbers, indices out of range.
ObjGeometry read_obj_geometry(const std::filesystem::path& file, ObjMaterials& materials);

}  // namespace reemit

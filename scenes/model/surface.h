#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/model/ids.h"
#include "scenes/model/shape.h"
#include "scenes/model/texture.h"
#include "scenes/model/vec.h"

namespace reemit {

/// A polygon with holes. Indices into Surface::positions; the front is where the outer loop runs
/// counter-clockwise.
struct Face {
  std::vector<std::uint32_t> outer;               ///< >= 3 vertices.
  std::vector<std::vector<std::uint32_t>> holes;  ///< Each >= 3 vertices, any winding.
  std::vector<std::uint32_t> normals;  ///< Into Surface::normals, one per outer vertex; empty = flat.
  std::uint32_t source_line = 0;       ///< In the file named by Surface::source; 0 = not known.
  /// Into Surface::texture_points, one per outer vertex; empty = textures count with their means.
  std::vector<std::uint32_t> texture_points = {};
};

/// A named group of faces and curved shapes of one material, in world coordinates.
struct Surface {
  std::string name;
  std::string source;  ///< File it came from, for messages.
  MaterialId material;
  std::vector<Vec3> positions;  ///< [m]
  std::vector<Vec3> normals;    ///< Unit shading normals; used in stills and to find creases only.
  std::vector<TexturePoint> texture_points;
  bool has_vertex_colours = false;  ///< Reflectance is that of the material times TexturePoint::colour.
  std::vector<Face> faces;
  std::vector<CurvedShape> shapes;

  bool empty() const { return faces.empty() && shapes.empty(); }
};

}  // namespace reemit

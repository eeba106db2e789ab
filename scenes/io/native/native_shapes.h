#pragma once
#include "scenes/io/common/json_cursor.h"
#include "scenes/model/surface.h"

namespace reemit {

/// The six faces of a box, in the order of Surface::faces: the side each looks to.
inline constexpr const char* kBoxFaces[] = {"x-", "x+", "y-", "y+", "z-", "z+"};

/// Each reads one shape of docs/room_format.md, in the coordinates of its object and without name and
/// material. Curved shapes stay what they are, unless a number of segments is given: then they are
/// tessellated with vertices on the true surface and carry its normals.
Surface read_polygon(const JsonCursor& at);
Surface read_quad(const JsonCursor& at);
Surface read_box(const JsonCursor& at);  ///< Six faces; those that are "open" have no vertices.
Surface read_sphere(const JsonCursor& at);
Surface read_cylinder(const JsonCursor& at);
Surface read_disk(const JsonCursor& at);
Surface read_mesh(const JsonCursor& at);

}  // namespace reemit

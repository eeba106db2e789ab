#pragma once
#include "scenes/io/common/json_cursor.h"
#include "scenes/model/surface.h"

namespace reemit {

/// The six faces of a box, in the order of Surface::faces: the side each looks to.
inline constexpr const char* kBoxFaces[] = {"x-", "x+", "y-", "y+", "z-", "z+"};

// Each reads one shape of docs/room_format.md, in the coordinates of its object and without name and
// material. Curved shapes stay what they are, unless a number of segments is given: then they are
// tessellated with vertices on the true surface and carry its normals.
// Lengths are in the unit of the file. Each throws InputError at the place of a value that is missing, has a
// wrong type or makes no shape with an area.

/// One face of "vertices" in order, with "holes".
Surface read_polygon(const JsonCursor& at);
/// One face of corner, corner + u, corner + u + v and corner + v.
Surface read_quad(const JsonCursor& at);
/// Six faces; those that are "open" have no vertices.
Surface read_box(const JsonCursor& at);
/// Tessellated, its poles lie along y.
Surface read_sphere(const JsonCursor& at);
/// A mantle and its "caps"; with a "top_radius" a cone, which has no cap at its tip.
Surface read_cylinder(const JsonCursor& at);
/// A disk, or a ring if it has an "inner_radius".
Surface read_disk(const JsonCursor& at);
/// Faces of three or more indices into "vertices", which they share.
Surface read_mesh(const JsonCursor& at);

}  // namespace reemit

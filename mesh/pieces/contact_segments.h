#pragma once
#include <vector>

#include "mesh/geometry/vertex_table.h"
#include "mesh/pieces/face_piece.h"

namespace reemit {

/// Straight piece of a cut, in the coordinates of a plane.
struct PlanarSegment {
  Vec2 from;
  Vec2 to;
};

/// Where `piece` touches or crosses a plane: its edges within `contact` metres of the plane, and its section
/// with it. Appends to `out`.
void section_with_plane(const VertexTable& vertices, const FacePiece& piece, const PlaneFrame& plane,
                        double contact, std::vector<PlanarSegment>& out);

/// The parts of a segment that run inside the loops, farther than `clearance` from their boundary. Appends to
/// `out`.
void clip_to_loops(const PlanarSegment& segment, const PlanarLoops& loops, double clearance,
                   std::vector<PlanarSegment>& out);

}  // namespace reemit

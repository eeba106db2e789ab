#pragma once
#include <span>
#include <vector>

#include "mesh/geometry/box_tree.h"
#include "mesh/pieces/contact_segments.h"
#include "scenes/model/shape.h"

namespace reemit {

/// Sides of the polygon that stands for a circle in a cut; what it leaves out of the circle's area is 0.6 %.
inline constexpr int kFootSides = 32;

/// Where a shape stands on a plane (circles within `contact` metres of it) or passes through it, as inscribed
/// polygons in the coordinates of the plane. Appends to `out`.
void section_with_plane(const CurvedShape& shape, const PlaneFrame& plane, double contact,
                        std::vector<PlanarSegment>& out);

/// True if a face passes through the shape, so that parts of it may lie in different rooms. Touching does not
/// count.
bool is_pierced(const CurvedShape& shape, const VertexTable& vertices, const FacePiece& piece,
                double contact);

/// Boxes around shapes, grown by `margin` metres.
std::vector<IndexedBox> boxes_of(std::span<const CurvedShape> shapes, double margin);

}  // namespace reemit

#pragma once
#include "mesh/pieces/face_piece.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Whether two pieces of one plane are the two sides of a wall without thickness, each of which its own piece
/// keeps: their fronts look apart and both are matt. Not if one is the outside of a solid: the other then
/// lies between the solid and what is beyond, and has that side too. Nor if both are of one material that is
/// two-sided.
bool may_be_back_to_back(const Scene& scene, const FacePiece& a, const FacePiece& b);

}  // namespace reemit

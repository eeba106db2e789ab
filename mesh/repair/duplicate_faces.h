#pragma once
#include <vector>

#include "mesh/model/mesh_report.h"
#include "mesh/pieces/face_piece.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Drops polygons that are there twice (the same corners in either sense), books their area as removed and
/// warns. The luminaire is kept, else the first. Of two opposite one-sided faces of one material, the way
/// some modellers draw a sheet, the kept one becomes two-sided; of two materials, both faces stay
/// (may_be_back_to_back).
void drop_duplicate_faces(const Scene& scene, std::vector<FacePiece>& pieces, MeshReport& report);

}  // namespace reemit

#pragma once
#include <vector>

#include "mesh/geometry/vertex_table.h"
#include "mesh/model/mesh_report.h"
#include "mesh/pieces/face_piece.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Turns faces round where their neighbours leave no doubt, and warns with count and share of area.
/// - In a closed shell of one material (every edge has exactly two faces) the faces that disagree with the
///   larger area are flipped. Open sheets, shells with edges of three faces, and Moebius bands are left as
///   they are.
/// - A closed one-sided luminaire whose fronts point inwards is turned outwards when nothing else of the room
///   (faces, curved shapes, lights, cameras) lies in its bounding box: else it may be a room with glowing
///   walls, as in a furnace test.
/// Nothing else is guessed: a closed shell that points inwards is as likely a room as a mistake.
/// Also sets FacePiece::in_closed_shell.
void orient_faces(const Scene& scene, const VertexTable& vertices, std::vector<FacePiece>& pieces,
                  MeshReport& report);

}  // namespace reemit

#pragma once
#include <array>
#include <vector>

#include "solver/room/room.h"

namespace reemit {

/// A flat piece of an emitting surface [m].
struct LuminaireFace {
  std::vector<Vec3> corners;  ///< Convex, 3 or more.
  Vec3 normal;                ///< Unit, of the front.
  SurfaceId surface;
  bool emits_both_sides;
};

/// A cell of a zone whose emission differs from point to point, or of a cut-out.
struct LuminaireCell {
  std::array<Vec3, 3> corners;  ///< [m]
  TriangleId triangle;
  bool front = true;
  Spectrum radiance;  ///< Of its zone along the normal, on average over its holes too [W/(m2 sr)].
};

/// Of all faces with emissive textures and of luminous cut-outs, those cells whose zones emit; patches of
/// round shapes have none.
std::vector<LuminaireCell> luminaire_cells(const Room& room);

/// The flat emitting parts of a room in pieces as large as they come: faces that are convex polygons and of
/// which the mesh covers everything are one piece, others one for each base triangle. Without those whose
/// emission differs from point to point, and cut-outs.
std::vector<LuminaireFace> luminaire_faces(const Room& room);

}  // namespace reemit

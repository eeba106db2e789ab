#pragma once
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

/// The flat emitting parts of a room in pieces as large as they come: faces that are convex polygons and of
/// which the mesh covers everything are one piece, others one for each base triangle.
std::vector<LuminaireFace> luminaire_faces(const Room& room);

}  // namespace reemit

#pragma once
#include <vector>

#include "mesh/zones/zone_mesh.h"
#include "scenes/model/scene.h"

namespace reemit {

/// A flat piece of an emitting surface [m].
struct LuminaireFace {
  std::vector<Vec3> corners;  ///< Convex, 3 or more.
  Vec3 normal;                ///< Unit, of the front.
  SurfaceId surface;
  bool two_sided;  ///< Its back has zones.
};

/// The flat emitting parts of a room in pieces as large as they come: faces that are convex polygons and of
/// which the mesh covers everything are one piece, others one for each base triangle.
std::vector<LuminaireFace> luminaire_faces(const Scene& scene, const ZoneMesh& mesh);

}  // namespace reemit

#include "mesh/pieces/back_to_back.h"

namespace reemit {

bool may_be_back_to_back(const Scene& scene, const FacePiece& a, const FacePiece& b) {
  if (!a.is_matt || !b.is_matt || a.outside_of_solid || b.outside_of_solid) return false;
  if (!(a.plane.normal.dot(b.plane.normal) < 0)) return false;
  const MaterialId of_a = scene.surfaces[a.surface.index()].material;
  const MaterialId of_b = scene.surfaces[b.surface.index()].material;
  return of_a != of_b || !scene.materials[of_a.index()].two_sided;
}

}  // namespace reemit

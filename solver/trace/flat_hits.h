#pragma once
#include "scenes/model/vec.h"

namespace reemit {

struct Ray16;
struct Hit16;

/// What every hit on a base triangle is asked for, side by side in memory.
struct FacePlane {
  Vec3f normal;      ///< RayTracer::normal
  float edge_share;  ///< RayTracer::edge_share
};

/// Sets on which side the hits are (hits.front), at which angle (hits.cosine) and which lie near an edge
/// (hits.near_edge), as if all were on flat triangles. Pre: all 16 lanes have a triangle of `faces`, which is
/// not empty, or none.
void read_flat_hits(const FacePlane* faces, const Ray16& rays, Hit16& hits);

}  // namespace reemit

#pragma once
#include <cstdint>

#include "mesh/zones/zone_mesh.h"
#include "scenes/model/vec.h"

namespace reemit {

/// 16 rays in the layout that packet tracing wants (normalised space, unit directions).
struct alignas(64) Ray16 {
  float ox[16], oy[16], oz[16];
  float dx[16], dy[16], dz[16];
  /// What decides at cut-outs, where a ray is one that was turned (RayTracer::cut_out_key); 0 for others.
  std::uint32_t key[16] = {};

  void set(int lane, const Vec3f& origin, const Vec3f& direction, std::uint32_t cut_out_key = 0) {
    key[lane] = cut_out_key;
    ox[lane] = origin.x();
    oy[lane] = origin.y();
    oz[lane] = origin.z();
    dx[lane] = direction.x();
    dy[lane] = direction.y();
    dz[lane] = direction.z();
  }
  Vec3f origin(int lane) const { return {ox[lane], oy[lane], oz[lane]}; }
  Vec3f direction(int lane) const { return {dx[lane], dy[lane], dz[lane]}; }
};

/// What 16 rays met. Lanes beyond the count of rays are as those of rays that left the room.
struct alignas(64) Hit16 {
  std::uint32_t triangle[16];  ///< RayTracer::kMiss where the ray left the room.
  float u[16], v[16];          ///< 0 where the ray left the room.
  float distance[16];
  float cosine[16];    ///< Between the ray and the normal of the side that it met; anything where it left.
  bool front[16];      ///< False where the ray left the room.
  bool near_edge[16];  ///< Below edge_share: the hit may be RayTracer::is_at_edge.
  TrianglePoints16 points() const { return {triangle, u, v, front}; }
};

}  // namespace reemit

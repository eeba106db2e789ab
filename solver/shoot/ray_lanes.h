#pragma once
#include <bit>
#include <cstdint>

#include "scenes/model/vec.h"
#include "solver/trace/ray_tracer.h"

namespace reemit {

/// Geometry of the zones that 16 packets leave from, component by component, so that all rays are made at
/// once. A point of the zone is corner + a edge1 + b edge2 with a, b >= 0 and a + b <= 1.
struct alignas(64) ZoneLanes {
  float corner[3][16], edge1[3][16], edge2[3][16];
  float middle[3][16];  ///< Of the parent triangle: rays are drawn towards it.
  float tangent[3][16], bitangent[3][16], normal[3][16];
  std::uint32_t zone[16];  ///< Of lanes one by one; else, at feet, the triangle that it is in.
  std::uint32_t one_by_one =
      0;                     ///< Lanes of curved zones and groups as bits; the geometry above is not theirs.
  std::uint32_t points = 0;  ///< Of these, lanes of given points: zone is the triangle, corner u, v and side.
  std::uint32_t feet = 0;    ///< Lanes of flat zones that rays leave clear of shapes (RayTracer::is_foot).
  // What need not be written again:
  std::uint32_t of_all = ZoneMesh::kNone;  ///< Flat side whose middle, tangents and normal are in all lanes.
  std::uint32_t without_edges = 0;         ///< Lanes whose edges are 0.
};

/// Four uniform numbers of each of 16 packets: u[dimension][lane].
struct alignas(64) UniformLanes {
  float u[4][16];
};

/// Lanes first .. last-1 as bits.
inline std::uint32_t lane_bits(int first, int last) {
  return ((1U << last) - 1) & ~((1U << first) - 1);
}

/// Calls `visit(lane)` for every bit of `lanes`.
template <class Visit>
void for_lanes(std::uint32_t lanes, const Visit& visit) {
  for (; lanes != 0; lanes &= lanes - 1) visit(std::countr_zero(lanes));
}

/// Makes 16 rays from uniform points of the zones (u[0], u[1]) in cosine-distributed directions (u[2], u[3]).
/// Returns, as bits, the lanes whose rays start on the other side of the triangle than that which they leave,
/// because rounding took more than the lift. Lane by lane the same as sample_triangle, RayTracer::lifted and
/// sample_cosine_hemisphere.
std::uint32_t start_rays(const ZoneLanes& zones, const UniformLanes& numbers, Ray16& rays);

}  // namespace reemit

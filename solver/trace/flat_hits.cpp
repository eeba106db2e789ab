#include "solver/trace/flat_hits.h"

#include <cstdint>

#include "scenes/model/instruction_sets.h"
#include "solver/trace/ray_tracer.h"

namespace reemit {

REEMIT_FOR_INSTRUCTION_SETS
void read_flat_hits(const FacePlane* __restrict faces, const Ray16& __restrict rays, Hit16& __restrict hits) {
  static_assert(sizeof(FacePlane) == 4 * sizeof(float));
  const auto* __restrict const numbers = reinterpret_cast<const float*>(faces);
  alignas(64) std::uint32_t front[16];
  alignas(64) std::uint32_t near_edge[16];
  for (int i = 0; i < 16; ++i) {
    const std::uint32_t t = hits.triangle[i];
    const std::uint32_t is_hit = t == RayTracer::kMiss ? 0U : 1U;
    const std::uint32_t face = t & (0U - is_hit);
    const float height = numbers[4 * std::size_t{face}] * rays.dx[i] +
                         numbers[4 * std::size_t{face} + 1] * rays.dy[i] +
                         numbers[4 * std::size_t{face} + 2] * rays.dz[i];
    const float w = 1 - hits.u[i] - hits.v[i];
    const float least = hits.u[i] < hits.v[i] ? hits.u[i] : hits.v[i];
    const float nearest = least < w ? least : w;
    hits.cosine[i] = height < 0 ? -height : height;
    front[i] = (height < 0 ? 1U : 0U) & is_hit;
    near_edge[i] = (nearest < numbers[4 * std::size_t{face} + 3] ? 1U : 0U) & is_hit;
  }
  for (int i = 0; i < 16; ++i) {
    hits.front[i] = front[i] != 0;
    hits.near_edge[i] = near_edge[i] != 0;
  }
}

}  // namespace reemit

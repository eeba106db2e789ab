#include "solver/shoot/ray_lanes.h"

#include <cmath>
#include <numbers>

#include "scenes/model/instruction_sets.h"

namespace reemit {
namespace {

/// Of the start of a ray over the plane of its triangle, on the side that it leaves; 0 where a lane has no
/// geometry.
inline float height_of(const ZoneLanes& zones, const Ray16& rays, int i) {
  return (rays.ox[i] - zones.middle[0][i]) * zones.normal[0][i] +
         (rays.oy[i] - zones.middle[1][i]) * zones.normal[1][i] +
         (rays.oz[i] - zones.middle[2][i]) * zones.normal[2][i];
}

}  // namespace

REEMIT_FOR_INSTRUCTION_SETS
std::uint32_t start_rays(const ZoneLanes& __restrict zones, const UniformLanes& __restrict numbers,
                         Ray16& __restrict rays) {
  constexpr float kQuarter = std::numbers::pi_v<float> / 4;
  std::uint32_t any_behind = 0;
  for (int i = 0; i < 16; ++i) {
    const float s = std::sqrt(numbers.u[0][i]);
    const float a = s * (1 - numbers.u[1][i]);
    const float b = s * numbers.u[1][i];
    const float px = zones.corner[0][i] + a * zones.edge1[0][i] + b * zones.edge2[0][i];
    const float py = zones.corner[1][i] + a * zones.edge1[1][i] + b * zones.edge2[1][i];
    const float pz = zones.corner[2][i] + a * zones.edge1[2][i] + b * zones.edge2[2][i];

    const float mx = zones.middle[0][i] - px;
    const float my = zones.middle[1][i] - py;
    const float mz = zones.middle[2][i] - pz;
    const float distance = std::sqrt(mx * mx + my * my + mz * mz);
    const float inset = RayTracer::inset_share(distance);
    rays.ox[i] = px + RayTracer::kLift * zones.normal[0][i] + inset * mx;
    rays.oy[i] = py + RayTracer::kLift * zones.normal[1][i] + inset * my;
    rays.oz[i] = pz + RayTracer::kLift * zones.normal[2][i] + inset * mz;
    any_behind |= height_of(zones, rays, i) < 0 ? 1U : 0U;

    // Concentric map [SC97]: the angle stays within a quarter of pi, where short polynomials give sine and
    // cosine to the last bits of a float.
    const float c = 2 * numbers.u[2][i] - 1;
    const float d = 2 * numbers.u[3][i] - 1;
    const bool wide = std::fabs(c) > std::fabs(d);
    const float r = wide ? c : d;
    const float q = wide ? d : c;
    const float t = kQuarter * (q / (r == 0 ? 1.0F : r));
    const float t2 = t * t;
    const float sine = t * (1 + t2 * (-1.6666667e-1F + t2 * (8.3333310e-3F - t2 * 1.9840874e-4F)));
    const float cosine = 1 + t2 * (-0.5F + t2 * (4.1666638e-2F + t2 * (-1.3888378e-3F + t2 * 2.4760495e-5F)));
    const float x = r * (wide ? cosine : sine);
    const float y = r * (wide ? sine : cosine);
    const float up = 1 - x * x - y * y;
    const float z = std::sqrt(up > 0 ? up : 0.0F);
    rays.dx[i] = x * zones.tangent[0][i] + y * zones.bitangent[0][i] + z * zones.normal[0][i];
    rays.dy[i] = x * zones.tangent[1][i] + y * zones.bitangent[1][i] + z * zones.normal[1][i];
    rays.dz[i] = x * zones.tangent[2][i] + y * zones.bitangent[2][i] + z * zones.normal[2][i];
  }
  std::uint32_t behind = 0;
  for (int i = 0; any_behind != 0 && i < 16; ++i) behind |= (height_of(zones, rays, i) < 0 ? 1U : 0U) << i;
  return behind;
}

}  // namespace reemit

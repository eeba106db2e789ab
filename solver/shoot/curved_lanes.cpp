#include "solver/shoot/curved_lanes.h"

#include <cmath>

#include "scenes/model/instruction_sets.h"
#include "solver/sampling/warp.h"

namespace reemit {
namespace {

/// Barycentric coordinates of starts within a patch.
struct alignas(64) PatchPlaces {
  double u[16], v[16];
};

/// Uniform points of a cell with these corners, drawn towards the middle of the patch.
REEMIT_FOR_INSTRUCTION_SETS
void find_places(const float* __restrict u0, const float* __restrict u1, const double* __restrict corner_u,
                 const double* __restrict corner_v, const PatchChord& chord, PatchPlaces& __restrict to) {
  for (int i = 0; i < 16; ++i) {
    const float s = std::sqrt(u0[i]);
    const float a = s * (1 - u1[i]);
    const float b = s * u1[i];
    const auto u = static_cast<float>((1 - a - b) * corner_u[0] + a * corner_u[1] + b * corner_u[2]);
    const auto v = static_cast<float>((1 - a - b) * corner_v[0] + a * corner_v[1] + b * corner_v[2]);
    const float inset = RayTracer::inset_share(chord.distance(u, v));
    to.u[i] = static_cast<double>(u + inset * (RayTracer::kMiddle - u));
    to.v[i] = static_cast<double>(v + inset * (RayTracer::kMiddle - v));
  }
}

/// Points lifted off the shape on the side that `side`, 1 or -1, says, in single precision.
REEMIT_FOR_INSTRUCTION_SETS
void lift(const CurvedPatches::Points16& __restrict at, float side, CurvedStarts& __restrict to) {
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 16; ++i) {
      const auto normal = static_cast<float>(at.normal[k][i]);
      to.normal[k][i] = side * normal;
      to.origin[k][i] = static_cast<float>(at.position[k][i] + static_cast<double>(side * RayTracer::kLift) *
                                                                   static_cast<double>(normal));
    }
}

}  // namespace

void curved_starts(const RayTracer& rays, const SideCell& cell, const UniformLanes& numbers,
                   CurvedStarts& to) {
  const auto corners = cell.corners.corners();
  const double corner_u[3] = {corners[0].u, corners[1].u, corners[2].u};
  const double corner_v[3] = {corners[0].v, corners[1].v, corners[2].v};
  PatchPlaces places;
  find_places(numbers.u[0], numbers.u[1], corner_u, corner_v, rays.patch_chord(cell.triangle), places);
  CurvedPatches::Points16 at;
  rays.patches(cell.triangle).at16(rays.mesh().triangle(cell.triangle).patch, places.u, places.v, at);
  lift(at, cell.front ? 1.0F : -1.0F, to);
}

void put_normals(const CurvedStarts& starts, int first, int last, ZoneLanes& lanes) {
  lanes.of_all = ZoneMesh::kNone;
  for (int lane = first; lane < last; ++lane) {
    const Frame frame({starts.normal[0][lane], starts.normal[1][lane], starts.normal[2][lane]});
    for (int k = 0; k < 3; ++k) {
      lanes.tangent[k][lane] = frame.tangent[k];
      lanes.bitangent[k][lane] = frame.bitangent[k];
      lanes.normal[k][lane] = frame.normal[k];
    }
  }
}

}  // namespace reemit

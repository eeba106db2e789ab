#include "solver/trace/face_sieve.h"

#include <algorithm>

#include "solver/trace/embree_queries.h"

namespace reemit {

FaceSieve::FaceSieve(const RayTracer& rays, const std::vector<bool>& chosen)
    : embree_(std::make_unique<EmbreeTree>()) {
  const ZoneMesh& mesh = rays.mesh();
  std::vector<Vec3f> vertices;
  std::vector<BaseTriangle> triangles;
  std::vector<bool> shape_is_chosen(mesh.base().shapes.size());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (!chosen[i]) continue;
    const TriangleId t(i);
    if (mesh.triangle(t).is_curved()) {
      shape_is_chosen[mesh.triangle(t).shape] = true;
      continue;
    }
    BaseTriangle& triangle = triangles.emplace_back();
    for (std::uint32_t k = 0; k < 3; ++k) {
      triangle.vertex[k] = static_cast<std::uint32_t>(vertices.size());
      vertices.push_back(rays.corner(t, static_cast<int>(k)));
    }
  }
  std::vector<CurvedShape> shapes;
  for (std::size_t s = 0; s < shape_is_chosen.size(); ++s)
    if (shape_is_chosen[s]) shapes.push_back(rays.normalised(mesh.base().shapes[s]));
  embree_->add_triangles(vertices, triangles, {}, nullptr);
  if (!shapes.empty()) embree_->add_shapes(shapes);
  embree_->commit();
}

FaceSieve::~FaceSieve() = default;
FaceSieve::FaceSieve(FaceSieve&&) noexcept = default;
FaceSieve& FaceSieve::operator=(FaceSieve&&) noexcept = default;

std::uint32_t FaceSieve::crossed16(const Ray16& rays, int count) const {
  alignas(64) int valid[16];
  alignas(64) RTCRay16 query;
  for (int i = 0; i < 16; ++i) {
    // Lanes of no ray have no length: Embree may pass over `valid`.
    const bool is_ray = i < count;
    valid[i] = is_ray ? -1 : 0;
    query.org_x[i] = is_ray ? rays.ox[i] : 0;
    query.org_y[i] = is_ray ? rays.oy[i] : 0;
    query.org_z[i] = is_ray ? rays.oz[i] : 0;
    query.dir_x[i] = is_ray ? rays.dx[i] : 0;
    query.dir_y[i] = is_ray ? rays.dy[i] : 0;
    query.dir_z[i] = is_ray ? rays.dz[i] : 0;
    query.tnear[i] = 0;
    query.tfar[i] = is_ray ? kInfinity : -kInfinity;
    query.time[i] = 0;
    query.mask[i] = 0xffffffffU;
    query.id[i] = 0;
    query.flags[i] = 0;
  }
  occluded16(valid, embree_->scene(), query);
  std::uint32_t crossed = 0;
  for (int i = 0; i < 16; ++i) crossed |= (i < count && query.tfar[i] < 0 ? 1U : 0U) << i;
  return crossed;
}

}  // namespace reemit

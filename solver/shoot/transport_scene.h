#pragma once
#include <cstdint>
#include <vector>

#include "mesh/zone_mesh.h"
#include "scenes/model/scene.h"
#include "solver/sampling/warp.h"
#include "solver/shoot/ray_lanes.h"
#include "solver/trace/ray_scene.h"

namespace reemit {

/// What packets need of the room, laid out for the inner loop: one cache-friendly record per base triangle
/// and the reflectances per surface. The room, mesh and ray scene must outlive it.
class TransportScene {
 public:
  TransportScene(const Scene& scene, const ZoneMesh& mesh, const RayScene& rays);

  const Scene& scene() const { return *scene_; }
  const ZoneMesh& mesh() const { return *mesh_; }
  const RayScene& rays() const { return *rays_; }
  std::size_t bands() const { return bands_; }
  std::size_t zones() const { return mesh_->zone_count(); }
  std::size_t surfaces() const { return scene_->surfaces.size(); }

  /// Reflectance of a surface, one number per band [0,1].
  const double* reflectance(SurfaceId s) const { return &reflectance_[s.index() * bands_]; }
  double largest_reflectance(SurfaceId s) const { return largest_reflectance_[s.index()]; }

  /// Puts the geometry of a zone into one lane.
  void put_zone(ZoneId z, ZoneLanes& lanes, int lane) const {
    const TriangleId t = mesh_->zone_triangle(z);
    const TrianglePatch& p = patches_[t.index()];
    std::size_t in_side = z.index() - p.first_zone;
    const std::size_t per_side = std::size_t{p.divisions} * p.divisions;
    const float side = in_side < per_side ? 1.0F : -1.0F;
    if (in_side >= per_side) in_side -= per_side;
    const ZoneCell cell = zone_cell(p.divisions, static_cast<std::uint32_t>(in_side));
    // An upper zone is a lower one turned about the middle of their cell.
    const float turn = cell.upper ? -1.0F : 1.0F;
    const auto i = static_cast<float>(cell.i + (cell.upper ? 1 : 0));
    const auto j = static_cast<float>(cell.j + (cell.upper ? 1 : 0));
    for (int k = 0; k < 3; ++k) {
      lanes.corner[k][lane] = p.corner[k] + i * p.edge1[k] + j * p.edge2[k];
      lanes.edge1[k][lane] = turn * p.edge1[k];
      lanes.edge2[k][lane] = turn * p.edge2[k];
      lanes.middle[k][lane] = p.middle[k];
      lanes.tangent[k][lane] = p.frame.tangent[k];
      lanes.bitangent[k][lane] = p.frame.bitangent[k];
      lanes.normal[k][lane] = side * p.frame.normal[k];
    }
  }

  /// Zone that a hit belongs to; not valid when it is the back of a one-sided face.
  ZoneId zone_of(std::uint32_t triangle, float u, float v, bool front) const {
    const TriangleId t(triangle);
    if (!front && !mesh_->triangle(t).two_sided) return ZoneId();
    return mesh_->zone_at(t, u, v, front);
  }

 private:
  /// A base triangle with the edges of one of its zones (normalised space).
  struct TrianglePatch {
    Vec3f corner, edge1, edge2, middle;
    Frame frame;  // about the front normal
    std::uint32_t divisions;
    std::size_t first_zone;
  };

  const Scene* scene_;
  const ZoneMesh* mesh_;
  const RayScene* rays_;
  std::size_t bands_;
  std::vector<TrianglePatch> patches_;
  std::vector<double> reflectance_;
  std::vector<double> largest_reflectance_;
};

}  // namespace reemit

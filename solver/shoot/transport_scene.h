#pragma once
#include <cstdint>
#include <vector>

#include "mesh/zone_mesh.h"
#include "scenes/model/scene.h"
#include "solver/sampling/warp.h"
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

  /// The part of a base triangle that one zone covers, ready to be sampled.
  struct ZonePatch {
    Vec3f corner, edge1, edge2;  ///< Normalised space; a point is corner + a edge1 + b edge2.
    Vec3f towards_middle;        ///< Middle of the parent triangle.
    Frame frame;                 ///< About the normal of the side the zone is on.
  };
  ZonePatch zone_patch(ZoneId z) const;

  /// Starts lane `lane` of a ray block at a uniform point of a zone in a cosine-distributed direction.
  static void start_ray(const ZonePatch& patch, float u0, float u1, float u2, float u3, Ray16& rays,
                        int lane);

  /// Zone that a hit belongs to; not valid when it is the back of a one-sided face.
  ZoneId zone_of(std::uint32_t triangle, float u, float v, bool front) const {
    const TriangleId t(triangle);
    if (!front && !mesh_->triangle(t).two_sided) return ZoneId();
    return mesh_->zone_at(t, u, v, front);
  }

 private:
  const Scene* scene_;
  const ZoneMesh* mesh_;
  const RayScene* rays_;
  std::size_t bands_;
  std::vector<double> reflectance_;
  std::vector<double> largest_reflectance_;
};

}  // namespace reemit

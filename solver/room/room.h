#pragma once
#include <memory>

#include "mesh/zones/zone_mesh.h"
#include "scenes/model/scene.h"
#include "solver/reflect/surface_model.h"
#include "solver/sky/sky_light.h"
#include "solver/texture/room_textures.h"
#include "solver/trace/ray_tracer.h"

namespace reemit {

/// The room as every stage meets it: what was read, its zones, the rays in it and what its surfaces do with
/// light. Does not change but by believe_misses. Const members may be called from any thread.
class Room {
 public:
  /// Builds the tree for rays. Scene and mesh must outlive the room. `means`: of textures, over its zones.
  Room(const Scene& scene, const ZoneMesh& mesh, TextureMeans means = TextureMeans::kFound)
      : scene_(&scene),
        mesh_(&mesh),
        textures_(scene, mesh),
        rays_(mesh, textures_),
        surfaces_(scene, mesh, textures_, rays_.metres_per_unit(), means),
        sky_(make_sky_light(scene, mesh, rays_, surfaces_)) {}
  Room(const Scene&&, const ZoneMesh&, TextureMeans = {}) = delete;
  Room(const Scene&, const ZoneMesh&&, TextureMeans = {}) = delete;
  Room(const Room&) = delete;
  Room& operator=(const Room&) = delete;

  const Scene& scene() const { return *scene_; }
  const ZoneMesh& mesh() const { return *mesh_; }
  const RayTracer& rays() const { return rays_; }
  const SurfaceModel& surfaces() const { return surfaces_; }
  /// What stands around the room; null if nothing does.
  const SkyLight* sky() const { return sky_.get(); }
  /// As RayTracer::believe_misses: for rooms that are open (is_open).
  void believe_misses() { rays_.believe_misses(); }
  std::size_t band_count() const { return scene_->bands.count(); }
  /// Diffuse reflectance of a zone, one number per band [0,1].
  const float* zone_reflectance(ZoneId z) const {
    return surfaces_.reflectance_float(z, mesh_->zone_triangle(z), mesh_->zone_is_front(z));
  }

 private:
  const Scene* scene_;
  const ZoneMesh* mesh_;
  RoomTextures textures_;
  RayTracer rays_;
  SurfaceModel surfaces_;
  std::shared_ptr<const SkyLight> sky_;
};

}  // namespace reemit

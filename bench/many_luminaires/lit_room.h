#pragma once
#include <optional>
#include <string>
#include <vector>

#include "mesh/build_mesh.h"
#include "scenes/model/scene.h"
#include "solver/emit/selection.h"
#include "solver/gather/direct_light.h"
#include "solver/trace/ray_tracer.h"
#include "solver/trace/surface_point.h"

namespace reemit::bench {

/// A room ready for rays. Stays where it is: its parts point to each other.
class LitRoom {
 public:
  explicit LitRoom(Scene scene);
  LitRoom(const LitRoom&) = delete;
  LitRoom& operator=(const LitRoom&) = delete;

  const Scene& scene() const { return scene_; }
  const RayTracer& rays() const { return room_.rays(); }
  /// Unset: the selection that the program takes by default.
  DirectLight light(std::optional<Selection> selection) const;

 private:
  Scene scene_;
  MeshResult mesh_;
  Room room_;
};

/// Throws std::runtime_error if the room has no camera of this name.
const Camera& camera_named(const Scene& scene, const std::string& name);

/// What the middles of the pixels of a picture see, row by row; pixels that see nothing are left out.
std::vector<SurfacePoint> seen_points(const LitRoom& room, const Camera& camera, int width, int height);

/// Every so manyeth of them, the first included.
std::vector<SurfacePoint> every(const std::vector<SurfacePoint>& points, std::size_t stride);

/// Weights that make illuminance [lx] of irradiance per band.
std::vector<float> illuminance_weights(const Scene& scene);

}  // namespace reemit::bench

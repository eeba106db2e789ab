#pragma once
#include <random>

#include "bench/hit_paths/polygon_room.h"
#include "scenes/model/camera.h"
#include "scenes/model/scene.h"

namespace reemit::hit_paths {

/// Radiance of pixels by paths that go on by cosine-distributed chance until they leave or are absorbed, and
/// count emission where they hit it: no luminaire is ever sampled. Only lights that no path can hit (points,
/// spots, parallel light) are asked for with one shadow ray each. Slow, and without anything in common with
/// what it checks.
class HitPathTracer {
 public:
  using Random = std::mt19937_64;

  /// Throws std::invalid_argument for luminaires it does not know: measured ones with an opening.
  HitPathTracer(const Scene& scene, const Camera& camera, int width, int height);

  /// Adds the radiance [W/(m2 sr)] of one path through a uniform point of pixel (x, y) to sum[band].
  void add_path(int x, int y, Random& random, double* sum) const;

 private:
  void add_emission(const RoomHit& hit, const Vec3& direction, const Spectrum& weight, double* sum) const;
  void add_lights(const RoomHit& hit, const Spectrum& weight, double* sum) const;

  const Scene* scene_;
  PolygonRoom room_;
  Vec3 eye_, corner_, right_, down_;  // a pixel (x, y) looks along corner_ + x right_ + y down_
};

}  // namespace reemit::hit_paths

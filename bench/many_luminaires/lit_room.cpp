#include "bench/many_luminaires/lit_room.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "viewer_export/still/camera.h"

namespace reemit::bench {

LitRoom::LitRoom(Scene scene)
    : scene_(std::move(scene)), mesh_(build_mesh(scene_)), room_(scene_, mesh_.mesh) {}

DirectLight LitRoom::light(std::optional<Selection> selection) const {
  return DirectLight(room_, DirectLightSettings{.selection = selection});
}

const Camera& camera_named(const Scene& scene, const std::string& name) {
  const auto it = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                               [&](const Camera& c) { return c.name == name; });
  if (it == scene.cameras.end()) throw std::runtime_error("'" + scene.name + "' has no camera " + name);
  return *it;
}

std::vector<SurfacePoint> seen_points(const LitRoom& room, const Camera& camera, int width, int height) {
  const PinholeCamera pinhole(camera, width, height, room.rays());
  std::vector<SurfacePoint> points;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const PinholeCamera::Ray ray = pinhole.ray(x + 0.5, y + 0.5);
      Hit hit;
      if (room.rays().closest_for_camera(ray.origin, ray.direction, hit))
        points.push_back(surface_point(room.rays(), hit, ray.direction));
    }
  return points;
}

std::vector<SurfacePoint> every(const std::vector<SurfacePoint>& points, std::size_t stride) {
  std::vector<SurfacePoint> chosen;
  for (std::size_t i = 0; i < points.size(); i += stride) chosen.push_back(points[i]);
  return chosen;
}

std::vector<float> illuminance_weights(const Scene& scene) {
  const Spectrum& efficacy = scene.bands.efficacy_lm_per_w();
  std::vector<float> weights;
  for (const double k : efficacy) weights.push_back(static_cast<float>(k));
  return weights;
}

}  // namespace reemit::bench

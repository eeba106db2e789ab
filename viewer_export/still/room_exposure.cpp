#include "viewer_export/still/room_exposure.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/gather/radiance_field.h"
#include "viewer_export/still/camera.h"
#include "viewer_export/still/default_cameras.h"

namespace reemit {
namespace {

constexpr std::size_t kMostCameras = 16;
constexpr double kRays = 3072;  // of a camera: 64 x 48

/// Appends what a camera sees in linear Rec.709, as a still of zones would show it.
void append_view(const Camera& camera, const Scene& scene, const RadianceField& field, const RayScene& rays,
                 std::vector<float>& rgb) {
  const double shrink = std::sqrt(kRays / (static_cast<double>(camera.width) * camera.height));
  const int width = std::max(1, static_cast<int>(std::lround(shrink * camera.width)));
  const int height = std::max(1, static_cast<int>(std::lround(shrink * camera.height)));
  const PinholeCamera pinhole(camera, width, height, rays);
  Spectrum radiance(static_cast<Eigen::Index>(field.band_count()));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const PinholeCamera::Ray ray = pinhole.ray(x + 0.5, y + 0.5);
      Hit hit;
      if (!rays.closest_for_camera(ray.origin, ray.direction, hit)) continue;
      const std::size_t t = hit.triangle.index();
      const float towards_eye = std::fabs(rays.normal(hit.triangle, hit.u, hit.v).dot(ray.direction));
      const float emission = field.emission_shape(t, towards_eye);
      const float* emitted = field.emitted(t, hit.front);
      const float* reflected = field.reflected(t, hit.u, hit.v, hit.front);
      for (std::size_t b = 0; b < field.band_count(); ++b)
        radiance[static_cast<Eigen::Index>(b)] = emission * emitted[b] + reflected[b];
      for (const double c : scene.bands.to_rgb(radiance)) rgb.push_back(static_cast<float>(c));
    }
}

}  // namespace

ToneMap tone_map_of_room(const Scene& scene, const Solution& solution, const RayScene& rays,
                         const ToneMapSettings& settings) {
  if (settings.exposure_ev) return make_tone_map({}, settings);
  std::vector<Camera> cameras = scene.cameras.empty() ? default_cameras(scene, rays) : scene.cameras;
  cameras.resize(std::min(cameras.size(), kMostCameras));
  const RadianceField field(scene, solution, rays);
  std::vector<float> rgb;
  for (const Camera& camera : cameras) append_view(camera, scene, field, rays, rgb);
  return make_tone_map(rgb, settings);
}

}  // namespace reemit

#include "bench/many_luminaires/direct_picture.h"

#include <algorithm>
#include <array>
#include <bit>
#include <functional>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "bench/convergence/jobs.h"
#include "solver/gather/point_sampler.h"
#include "solver/reflect/lambert.h"

namespace reemit::bench {
namespace {

/// Emission and reflection of the surfaces, side by side in memory.
struct SurfaceLight {
  std::vector<float> emitted;  // radiance
  std::vector<float> brdf;
  bool back_emits = false;
  bool back_reflects = false;
};

std::vector<SurfaceLight> surface_lights(const Scene& scene) {
  std::vector<SurfaceLight> lights;
  for (const Surface& s : scene.surfaces) {
    const Material& m = scene.material_of(s);
    SurfaceLight& light = lights.emplace_back();
    for (const double e : m.emitted_radiance) light.emitted.push_back(static_cast<float>(e));
    for (const double rho : m.reflectance) light.brdf.push_back(lambert_brdf_per_sr(static_cast<float>(rho)));
    light.back_emits = m.emits_both_sides;
    light.back_reflects = m.two_sided;
  }
  return lights;
}

class PixelRenderer {
 public:
  PixelRenderer(const LitRoom& room, const DirectLight& light, const PinholeCamera& camera, int samples,
                std::uint64_t seed)
      : room_(&room),
        light_(&light),
        camera_(&camera),
        surfaces_(surface_lights(room.scene())),
        samples_(samples),
        log2_samples_(std::bit_width(static_cast<unsigned>(samples - 1))),
        seed_(seed) {}

  void render(int x, int y, DirectPicture& picture) const {
    const std::size_t bands = light_->band_count();
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x);
    const PointSampler sampler(seed_, RngPurpose::kPixel, pixel, 0, log2_samples_);
    std::vector<float> emitted(bands), reflected(bands);
    for (int s = 0; s < samples_; ++s) {
      const std::array<float, 2> u = sampler.place(s);
      const PinholeCamera::Ray ray = camera_->ray(static_cast<double>(x) + static_cast<double>(u[0]),
                                                  static_cast<double>(y) + static_cast<double>(u[1]));
      Hit hit;
      if (!room_->rays().closest_for_camera(ray.origin, ray.direction, hit)) continue;
      const SurfaceLight& surface = surfaces_[room_->rays().mesh().triangle(hit.triangle).surface.index()];
      if (hit.front || surface.back_emits)
        for (std::size_t b = 0; b < bands; ++b) emitted[b] += surface.emitted[b];
      if (hit.front || surface.back_reflects)
        light_->add_sample(surface_point(room_->rays(), hit, ray.direction), sampler.light(s, 0, 1),
                           surface.brdf.data(), reflected.data());
    }
    store(emitted, &picture.emitted[3 * pixel]);
    store(reflected, &picture.reflected[3 * pixel]);
  }

 private:
  void store(const std::vector<float>& sum, float* rgb) const {
    Spectrum mean(static_cast<Eigen::Index>(sum.size()));
    for (std::size_t b = 0; b < sum.size(); ++b)
      mean[static_cast<Eigen::Index>(b)] = static_cast<double>(sum[b]) / samples_;
    const Eigen::Array3d colour = room_->scene().bands.to_rgb(mean);
    for (Eigen::Index c = 0; c < 3; ++c) rgb[c] = static_cast<float>(colour[c]);
  }

  const LitRoom* room_;
  const DirectLight* light_;
  const PinholeCamera* camera_;
  std::vector<SurfaceLight> surfaces_;
  int samples_;
  int log2_samples_;
  std::uint64_t seed_;
};

}  // namespace

std::vector<float> DirectPicture::sum() const {
  std::vector<float> all(emitted.size());
  std::transform(emitted.begin(), emitted.end(), reflected.begin(), all.begin(), std::plus<>());
  return all;
}

DirectPicture render_direct(const LitRoom& room, const DirectLight& light, const Camera& camera, int width,
                            int height, int samples, std::uint64_t seed, int threads) {
  DirectPicture picture{.width = width, .height = height, .emitted = {}, .reflected = {}};
  picture.emitted.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  picture.reflected.resize(picture.emitted.size());
  const PinholeCamera pinhole(camera, width, height, room.rays());
  const PixelRenderer renderer(room, light, pinhole, samples, seed);
  tbb::task_arena arena(threads);
  picture.seconds = seconds_of([&] {
    arena.execute([&] {
      tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) renderer.render(x, y, picture);
      });
    });
  });
  return picture;
}

}  // namespace reemit::bench

#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "solver/gather/direct_light.h"
#include "solver/gather/gather_batch.h"
#include "solver/gather/point_sampler.h"
#include "solver/sampling/warp.h"

namespace reemit {

/// A point of a zone, uniform over it for uniform u.
inline SurfacePoint point_in_zone(const Room& room, ZoneId zone, const std::array<float, 2>& u) {
  float u0 = u[0];
  const SideCell cell = room.mesh().pick_cell(zone, u0);
  const auto [a, b] = sample_triangle(u0, u[1]);
  const SidePoint x = cell_point(cell, a, b);
  return surface_point(room.rays(), x.triangle, static_cast<float>(x.at.u), static_cast<float>(x.at.v),
                       x.front);
}

/// How many rays one replicate of the light at a place takes.
struct ReplicateEffort {
  int points = 1;   ///< Places, each with one shadow ray.
  int gathers = 1;  ///< Gather rays from each of them.
  int first = 0;    ///< Places that this replicate had before; best a multiple of points, a power of two.
  bool with_shadow_rays = true;  ///< Else nothing is added to what is direct.

  /// Of each of `replicates` that together send so many rays, each number rounded up; places are a power of
  /// two. All >= 1.
  static ReplicateEffort of(int gather_rays, int light_samples, int replicates) {
    const int points =
        static_cast<int>(std::bit_ceil(static_cast<unsigned>((light_samples + replicates - 1) / replicates)));
    const int all_points = points * replicates;
    return {points, (gather_rays + all_points - 1) / all_points};
  }
};

/// One replicate of the light around a place. `place(u)` gives the SurfacePoint or MeasuringPoint for two
/// uniform numbers. Adds
/// the mean direct irradiance [W/m2] to direct[b] and the mean reflected radiance over cosine-distributed
/// rays [W/(m2 sr)] to indirect[b] (pi times it is the indirect irradiance; complete after batch.flush()), of
/// it that of luminaires over mirrors, glass and gloss to caustic[b] unless that is null. Each place has a
/// ray to bright zones of its own where the batch aims. The sampler must have been made for first + points
/// samples.
template <class Place>
void add_replicate(const DirectLight& light, const PointSampler& sampler, const ReplicateEffort& effort,
                   PathKey key, Place&& place, GatherBatch& batch, float* direct, float* indirect,
                   float* caustic = nullptr) {
  const std::vector<float> light_weight(light.band_count(), 1.0F / static_cast<float>(effort.points));
  const std::vector<float> ray_weight(light.band_count(),
                                      1.0F / static_cast<float>(effort.points * effort.gathers));
  const std::uint32_t first_path = key.path;
  for (int i = effort.first; i < effort.first + effort.points; ++i) {
    const auto x = place(sampler.place(i));
    if (effort.with_shadow_rays) light.add_sample(x, sampler.light(i, 0, 1), light_weight.data(), direct);
    if (batch.aims()) {
      key.path = first_path + static_cast<std::uint32_t>(i);
      batch.aim(x, sampler.bright(i), key, ray_weight.data(), indirect, caustic);
    }
    for (int j = 0; j < effort.gathers; ++j) {
      const std::array<float, 2> u = sampler.hemisphere(i, j, effort.gathers);
      key.path = first_path + static_cast<std::uint32_t>(i * effort.gathers + j);
      batch.add(x, u[0], u[1], key, ray_weight.data(), indirect, caustic);
    }
  }
}

}  // namespace reemit

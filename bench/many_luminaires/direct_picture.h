#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bench/many_luminaires/lit_room.h"
#include "solver/gather/direct_light.h"
#include "viewer_export/still/camera.h"

namespace reemit::bench {

/// A still of luminaires and their first reflection: what a selection has to do with, and nothing else.
struct DirectPicture {
  int width = 0;                 ///< [px]
  int height = 0;                ///< [px]
  std::vector<float> emitted;    ///< Linear Rec.709 radiance of luminaires [W/(m2 sr)], 3 values per pixel.
  std::vector<float> reflected;  ///< The same of surfaces, without what they emit.
  double seconds = 0;            ///< Wall time.

  std::vector<float> sum() const;
};

/// `samples` camera rays per pixel, each with one shadow ray, from the Sobol' points that stills take. Pre:
/// emission is Lambertian.
DirectPicture render_direct(const LitRoom& room, const DirectLight& light, const Camera& camera, int width,
                            int height, int samples, std::uint64_t seed, int threads);

}  // namespace reemit::bench

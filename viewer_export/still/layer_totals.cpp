#include "viewer_export/still/layer_totals.h"

#include <cmath>
#include <cstddef>

namespace reemit {

/// Calls use(index as of StillPlanes::irradiance) for the pixels that count.
template <class Use>
void LayerTotals::for_each_pixel(const StillPlanes& planes, std::size_t band, const Use& use) {
  for (std::size_t p = 0; p < planes.pixels(); ++p)
    if (planes.sees_luminaire[p] == 0) use(band * planes.pixels() + p);
}

LayerTotals::LayerTotals(const StillPlanes& planes) : total_(planes.bands) {
  for (std::size_t b = 0; b < planes.bands; ++b)
    for_each_pixel(planes, b, [&](std::size_t at) {
      const std::array<double, kLayers> light = light_at(planes, at);
      for (std::size_t l = 0; l < kLayers; ++l)
        total_[b][l] += static_cast<double>(planes.scale[at]) * light[l];
    });
}

std::array<double, LayerTotals::kLayers> LayerTotals::light_at(const StillPlanes& planes, std::size_t at) {
  const auto all =
      0.5 * (static_cast<double>(planes.irradiance[0][at]) + static_cast<double>(planes.irradiance[1][at]));
  const auto direct = static_cast<double>(planes.direct[at]);
  const double caustic = planes.caustic.empty() ? 0 : static_cast<double>(planes.caustic[at]);
  return {direct, caustic, all - direct - caustic};
}

void LayerTotals::give_back_to(StillPlanes& planes) const {
  const LayerTotals now(planes);
  for (std::size_t b = 0; b < planes.bands; ++b) {
    std::array<double, kLayers> more{};
    for (std::size_t l = 0; l < kLayers; ++l) {
      const double share = total_[b][l] / now.total_[b][l] - 1;
      if (std::abs(share) < kMost) more[l] = share;
    }
    for_each_pixel(planes, b, [&](std::size_t at) {
      const std::array<double, kLayers> light = light_at(planes, at);
      const double all = light[kDirect] + light[kCaustic] + light[kRest];
      if (!(all > 0)) return;
      double gain = 1;
      for (std::size_t l = 0; l < kLayers; ++l) gain += more[l] * light[l] / all;
      for (std::vector<float>& half : planes.irradiance)
        half[at] = static_cast<float>(gain * static_cast<double>(half[at]));
      planes.direct[at] = static_cast<float>((1 + more[kDirect]) * light[kDirect]);
      if (!planes.caustic.empty())
        planes.caustic[at] = static_cast<float>((1 + more[kCaustic]) * light[kCaustic]);
    });
  }
}

}  // namespace reemit

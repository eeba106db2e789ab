#pragma once
#include <type_traits>
#include <variant>

#include "scenes/model/luminaire.h"

namespace reemit {

/// Intensity [W/sr], of a measured luminaire that per candela, or irradiance [W/m2], whichever the light has.
/// Light is PunctualLight or const PunctualLight.
template <class Light>
auto& strength_of(Light& light) {
  return std::visit(
      [](auto& l) -> std::conditional_t<std::is_const_v<Light>, const Spectrum&, Spectrum&> {
        using Kind = std::remove_cvref_t<decltype(l)>;
        if constexpr (std::is_same_v<Kind, DirectionalLight>)
          return l.irradiance;
        else if constexpr (std::is_same_v<Kind, PhotometricLight>)
          return l.intensity_per_candela;
        else
          return l.intensity;
      },
      light);
}

}  // namespace reemit

#pragma once
#include <string>
#include <variant>

#include "scenes/model/bands.h"
#include "scenes/model/vec.h"

namespace reemit {

/// Luminaires without area. Emissive surfaces are luminaires by their Material and are not listed here.
struct PointLight {
  std::string name;
  Vec3 position;       ///< [m]
  Spectrum intensity;  ///< [W/sr] per band, the same in all directions.
};

/// Intensity falls from full inside the inner cone to 0 at the outer cone as KHR_lights_punctual states it.
struct SpotLight {
  std::string name;
  Vec3 position;              ///< [m]
  Vec3 direction;             ///< Unit, away from the lamp.
  Spectrum intensity;         ///< [W/sr] per band on the axis.
  double inner_angle = 0;     ///< Half angle [rad], 0 <= inner < outer.
  double outer_angle = 0.78;  ///< Half angle [rad], <= pi/2.
};

/// Parallel light from infinitely far away.
struct DirectionalLight {
  std::string name;
  Vec3 direction;       ///< Unit, the way the light travels.
  Spectrum irradiance;  ///< [W/m2] per band on a plane across the beam.
};

using PunctualLight = std::variant<PointLight, SpotLight, DirectionalLight>;

}  // namespace reemit

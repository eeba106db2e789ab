#pragma once
#include <string>

#include "scenes/model/bands.h"

namespace reemit {

/// What a material of a MTL file says about light, in linear Rec.709.
struct MtlLight {
  Spectrum kd, ks;        ///< Diffuse and specular colour [0,1].
  Spectrum tf;            ///< Transmission filter [0,1]; all 0: not given.
  double opacity = 1;     ///< d, or 1 - Tr [0,1].
  double refraction = 1;  ///< Ni.
  int illumination = 0;   ///< illum, 0 to 10.
};

/// Where the light goes that meets the material: shares per band [0,1]. The rest is absorbed.
struct ObjLightShares {
  Spectrum diffuse, specular, transmitted;
  bool is_sharp = false;  ///< Mirror or glass, whatever the exponent of its highlights.
  bool is_glass = false;  ///< Of the index of refraction: Fresnel's equations say what it reflects.
  bool is_metal = false;  ///< Its mirror follows Schlick's law.
  std::string doubt;  ///< What the file calls for that the shares do not show, or empty; begins with "it is".
};

/// Transmitted: (1 - d) Tf, and Tf of glass that is opaque by its d, as programs that trace rays write it
/// (illum 6 and 7, or 4 and 9 with Ni above 1). Kd is the colour of the opaque share only, and mirrors (illum
/// 3, 5, 8) reflect diffusely only what their Ks leaves: beside glass and mirrors Kd is often a placeholder.
ObjLightShares obj_light_shares(const MtlLight& light);

}  // namespace reemit

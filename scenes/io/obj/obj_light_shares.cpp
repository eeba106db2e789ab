#include "scenes/io/obj/obj_light_shares.h"

#include <fmt/format.h>

namespace reemit {

ObjLightShares obj_light_shares(const MtlLight& light) {
  const int model = light.illumination;
  const bool glass_on = model == 4 || model == 9;
  const bool refracts = model == 6 || model == 7 || (glass_on && light.refraction > 1);
  const bool mirrors = model == 3 || model == 5 || model == 8;
  const bool opaque = light.opacity >= 1;
  const Spectrum filter = (light.tf > 0).any() ? light.tf : Spectrum::Ones(light.kd.size());
  // Glass that is opaque by its d lets Tf through, by definition of these models; else d is the say of it.
  const Spectrum open = opaque ? (refracts ? filter : Spectrum::Zero(light.kd.size()))
                               : Spectrum::Constant(light.kd.size(), 1 - light.opacity);
  ObjLightShares shares;
  shares.transmitted = opaque ? open : Spectrum(open * filter);
  shares.is_sharp = mirrors || refracts || glass_on;
  shares.is_glass = refracts && light.refraction > 1 && (shares.transmitted > 0).any();
  shares.is_metal = model == 5;
  shares.specular = shares.is_glass ? Spectrum(Spectrum::Zero(light.kd.size())) : light.ks;
  shares.diffuse = (1 - open) * light.kd;
  if (mirrors) shares.diffuse = shares.diffuse.min((1 - light.ks).max(0));
  if (mirrors && !(light.ks > 0).any() && (light.kd > 0).any())
    shares.doubt =
        fmt::format("it is a mirror (illum {}) without Ks, and its Kd is reflected diffusely", model);
  else if (glass_on && opaque && !refracts && (shares.diffuse > 0).any())
    shares.doubt = fmt::format(
        "it is glass by illum {}, but opaque by its d and Ni, and its Kd is reflected diffusely", model);
  return shares;
}

}  // namespace reemit

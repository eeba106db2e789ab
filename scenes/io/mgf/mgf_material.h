#pragma once
#include <string>
#include <vector>

#include "scenes/io/mgf/mgf_contexts.h"
#include "scenes/model/material.h"

namespace reemit {

/// An MGF material in linear Rec.709: luminance weights of a reflectance give exactly its photometric value,
/// and (1/3, 1/3) is grey. Emittance M [lm/m2] becomes the radiance M / (pi 179 lm/W). A two-sided surface
/// looks the same from both sides ("sides" in [MGF]), so with `sides 2` both sides emit; with `sides 1` only
/// the front does, and the back absorbs. Adds a warning, at most one per cause, for what had to be changed or
/// is not kept. Throws InputError, at the line of the `ed`, for an emission beyond the limits of a room.
Material convert_mgf_material(const MgfMaterial& material, const std::string& name, const std::string& where,
                              std::vector<std::string>& warnings);

}  // namespace reemit

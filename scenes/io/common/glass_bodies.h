#pragma once
#include "scenes/model/scene.h"

namespace reemit {

/// Looks which surfaces of solid glass (NonDiffusePart::is_solid) enclose a body: faces of one material that
/// share corners, with every edge between two of them, or a sphere. Where they do, fronts are turned towards
/// the air: outwards, but inwards where a body lies within another of the same glass, which it hollows out.
/// Where they do not, light that came in would find no way out, so the surface gets a material of thin panes,
/// with a warning. Another warning tells of bodies within other glass and of bodies that overlap, between
/// which light is not bent as it should be.
void settle_glass_bodies(Scene& scene);

}  // namespace reemit

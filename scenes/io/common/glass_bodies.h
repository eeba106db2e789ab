#pragma once
#include "scenes/model/scene.h"

namespace reemit {

/// Looks which surfaces of solid glass (NonDiffusePart::is_solid) enclose a body: faces of one material that
/// share corners, with every edge between two of them. Where they do, fronts are turned outwards; where they
/// do not, light that came in would find no way out, so the surface gets a material of thin panes, with a
/// warning.
void settle_glass_bodies(Scene& scene);

}  // namespace reemit

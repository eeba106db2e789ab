#pragma once
#include "scenes/model/photometry.h"

namespace reemit {

/// Largest value of n.p over the points p of the opening [m], relative to its centre; n is a unit vector in
/// luminaire coordinates.
double opening_reach(const LuminousOpening& opening, const Vec3& n);

}  // namespace reemit

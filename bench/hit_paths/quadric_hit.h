#pragma once
#include <optional>

#include "scenes/model/shape.h"

namespace reemit::hit_paths {

/// Distance in (near, far) at which a ray of unit direction first meets a shape, and the unit normal of its
/// front there. Plain quadratics in double precision, apart from what the solver uses.
std::optional<double> nearest_on_shape(const CurvedShape& shape, const Vec3& origin, const Vec3& direction,
                                       double near, double far, Vec3& normal);

}  // namespace reemit::hit_paths

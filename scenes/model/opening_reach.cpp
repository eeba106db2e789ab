#include "scenes/model/opening_reach.h"

#include <cmath>

namespace reemit {

double opening_reach(const LuminousOpening& opening, const Vec3& n) {
  const Vec3 reach = 0.5 * opening.size().cwiseProduct(n).cwiseAbs();
  switch (opening.shape) {
    case LuminousOpening::Shape::kPoint:
      break;
    case LuminousOpening::Shape::kBox:
      return reach.sum();
    case LuminousOpening::Shape::kCylinder: {
      const int axis = static_cast<int>(opening.axis);
      return reach[axis] + std::hypot(reach[(axis + 1) % 3], reach[(axis + 2) % 3]);
    }
    case LuminousOpening::Shape::kEllipsoid:
      return reach.norm();
  }
  return 0;
}

}  // namespace reemit

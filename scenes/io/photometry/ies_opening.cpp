#include "scenes/io/photometry/ies_opening.h"

#include <algorithm>
#include <cmath>

namespace reemit {
namespace {

using Shape = LuminousOpening::Shape;
using Axis = LuminousOpening::Axis;

int sign_of(double x) {
  return x > 0 ? 1 : (x < 0 ? -1 : 0);
}

}  // namespace

LuminousOpening ies_opening(double width, double length, double height, double metres, bool before_2002,
                            bool& known) {
  LuminousOpening o;
  o.width = std::fabs(width) * metres;
  o.length = std::fabs(length) * metres;
  o.height = std::fabs(height) * metres;
  const int w = sign_of(width);
  const int l = sign_of(length);
  const int h = sign_of(height);
  known = true;
  const auto shaped = [&o](Shape shape, Axis axis = Axis::kHeight) {
    o.shape = shape;
    o.axis = axis;
    return o;
  };
  if (w == 0 && l == 0 && h == 0) return shaped(Shape::kPoint);
  if (w >= 0 && l >= 0 && h >= 0) return shaped(Shape::kBox);
  // One horizontal size stands for the diameter where the other is 0.
  if (h >= 0 && (w == 0 || l == 0)) {
    o.width = o.length = std::max(o.width, o.length);
    return shaped(Shape::kCylinder);
  }
  if (h >= 0) return shaped(Shape::kCylinder);
  // Height below 0: round seen from the side.
  if (w < 0 && l < 0) return shaped(Shape::kEllipsoid);
  if (w == 0 && l == 0) {
    o.width = o.length = o.height;
    return shaped(Shape::kEllipsoid);
  }
  if (l == 0 && w < 0) {
    if (!before_2002) return shaped(Shape::kCylinder, Axis::kLength);
    o.length = o.width;
    return shaped(Shape::kEllipsoid);
  }
  if (w == 0 && l < 0) return shaped(Shape::kCylinder, Axis::kWidth);
  if (w == 0 && l > 0) {
    o.width = o.height;
    return shaped(Shape::kCylinder, Axis::kLength);
  }
  if (l == 0 && w > 0) {
    o.length = o.height;
    return shaped(Shape::kCylinder, Axis::kWidth);
  }
  if (w < 0 || l < 0) {
    if (before_2002) return shaped(Shape::kEllipsoid);
    return shaped(Shape::kCylinder, w < 0 ? Axis::kLength : Axis::kWidth);
  }
  known = false;
  return shaped(Shape::kBox);
}

}  // namespace reemit

#pragma once
#include "solver/matrix/convex_polygon.h"

namespace reemit {

/// Two polygons cut down to the parts that can see each other if nothing is in the way: each lies in front of
/// the plane of the other. Both have count 0 if there are none, as for polygons in one plane.
struct FacingPair {
  ConvexPolygon a, b;
  bool empty() const { return a.count == 0 || b.count == 0; }
};
/// Pre: both have corners, less than ConvexPolygon::kMostCorners.
FacingPair facing_parts(const ConvexPolygon& a, const ConvexPolygon& b);

/// Area times form factor A_a F_ab = A_b F_ba [m2] of two facing parts with nothing between them: the double
/// contour integral (1/2 pi) sum over edge pairs of (direction . direction) times the integral of ln r
/// ([GOR84] eq. 14, [SH93] sec. 2). Exact to about 1e-12 of the smaller area; never negative.
double unoccluded_exchange_area(const FacingPair& pair);

}  // namespace reemit

#include "solver/matrix/polygon_form_factor.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/matrix/edge_integral.h"

namespace reemit {
namespace {

/// Corners nearer to a plane than this fraction of the extent of the pair lie in it.
constexpr double kOnPlane = 1e-11;

/// Edges in units of `scale` about `origin`; those without length are left out.
struct Edges {
  std::array<Edge, ConvexPolygon::kMostCorners> edge;
  std::size_t count = 0;

  Edges(const ConvexPolygon& polygon, const Vec3& origin, double scale) {
    for (std::size_t k = 0; k < polygon.count; ++k) {
      const Vec3 start = (polygon.corner[k] - origin) / scale;
      const Vec3 along = (polygon.corner[(k + 1) % polygon.count] - polygon.corner[k]) / scale;
      const double length = along.norm();
      if (length > 0) edge[count++] = {start, along / length, length};
    }
  }
};

double extent(const ConvexPolygon& a, const ConvexPolygon& b) {
  double largest = 0;
  for (const ConvexPolygon* polygon : {&a, &b})
    for (std::size_t k = 0; k < polygon->count; ++k)
      largest = std::max(largest, (polygon->corner[k] - a.corner[0]).squaredNorm());
  return std::sqrt(largest);
}

}  // namespace

FacingPair facing_parts(const ConvexPolygon& a, const ConvexPolygon& b) {
  const double tolerance = kOnPlane * extent(a, b);
  FacingPair pair{part_in_front(a, b.corner[0], b.normal, tolerance), {}};
  if (pair.a.count > 0) pair.b = part_in_front(b, a.corner[0], a.normal, tolerance);
  return pair;
}

double unoccluded_exchange_area(const FacingPair& pair) {
  if (pair.empty()) return 0;
  // The contours are closed, so a factor in r changes nothing; with r near 1 its logarithm cancels least.
  const Vec3 origin = pair.a.corner[0];
  const double scale = std::max(extent(pair.a, pair.b), 1e-300);
  const Edges a(pair.a, origin, scale);
  const Edges b(pair.b, origin, scale);
  double sum = 0;
  for (std::size_t i = 0; i < a.count; ++i)
    for (std::size_t j = 0; j < b.count; ++j) {
      const double cosine = a.edge[i].direction.dot(b.edge[j].direction);
      if (std::fabs(cosine) > 1e-15) sum += cosine * integral_of_log_distance(a.edge[i], b.edge[j]);
    }
  return std::max(0.0, sum * scale * scale / (2 * std::numbers::pi));
}

}  // namespace reemit

#include "mesh/pieces/planar_triangulation.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

namespace reemit {
namespace {

double twice_area(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

/// Whether a triangle has the point in its interior, farther from its sides than rounding.
bool lies_within_a_triangle(const PlanarTriangulation& cut, const Vec2& p) {
  for (const auto& [i, j, k] : cut.triangles) {
    const Vec2 &a = cut.points[i], &b = cut.points[j], &c = cut.points[k];
    const double least = 1e-6 * twice_area(a, b, c);
    if (twice_area(a, b, p) > least && twice_area(b, c, p) > least && twice_area(c, a, p) > least)
      return true;
  }
  return false;
}

// From a panel of a machine whose parts overlap: three segments start where the first one passes, to the last
// digit or nearly so. With rounded crossings the third becomes one edge to a point far from it.
TEST(PlanarTriangulation, ExactCrossingsKeepSegmentsThatStartOnAnotherStraight) {
  const std::vector<Vec2> points = {
      {-0.036488573998212814, 0.14149872461954693}, {-0.036749206483364105, 0.1404934326807652},
      {-0.036502428357573224, 0.14144528663090128}, {-0.039897128958823913, 0.14287463822034674},
      {-0.036588596595838574, 0.14111292500968098}, {-0.040163299419063048, 0.14260846776010716},
      {-0.036598071013149047, 0.14107638100274045}, {-0.03594401478767395, 0.14084325234095196}};
  const std::vector<std::array<std::uint32_t, 2>> segments = {{0, 1}, {2, 3}, {4, 5}, {6, 7}};
  const auto everywhere = [](const Vec2&) { return true; };
  const PlanarTriangulation cut = triangulate_planar(points, segments, everywhere, {}, Crossings::kExact);
  ASSERT_FALSE(cut.triangles.empty());
  for (const auto& [a, b] : segments)
    for (const double t : {0.25, 0.5, 0.75})
      EXPECT_FALSE(lies_within_a_triangle(cut, (1 - t) * points[a] + t * points[b])) << a << ", " << t;
}

}  // namespace
}  // namespace reemit

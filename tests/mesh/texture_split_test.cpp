#include "mesh/pieces/texture_split.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace reemit {
namespace {

/// A face with these corners, whose texture is no affine map of it.
Surface face_with_bent_texture(const std::vector<Vec3>& corners) {
  Surface surface;
  Face face;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    surface.positions.push_back(corners[i]);
    TexturePoint point;
    point.uv[0] = {corners[i].x() * corners[i].x(), corners[i].y() + 0.3 * static_cast<double>(i % 2)};
    surface.texture_points.push_back(point);
    face.outer.push_back(static_cast<std::uint32_t>(i));
    face.texture_points.push_back(static_cast<std::uint32_t>(i));
  }
  surface.faces.push_back(face);
  return surface;
}

double area_of_triangles(const Surface& surface) {
  double area = 0;
  for (const auto& t : texture_triangles(surface, surface.faces[0])) {
    const Vec3& a = surface.positions[t[0]];
    area += 0.5 * (surface.positions[t[1]] - a).cross(surface.positions[t[2]] - a).norm();
  }
  return area;
}

TEST(TextureSplit, CoversAnOutlineAndNoMoreWhereverItBegins) {
  // On a grid the corner that turns back lies on the line between its neighbours' neighbours.
  std::vector<Vec3> l{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  std::vector<Vec3> comb{{0, 0, 0}, {5, 0, 0}, {5, 2, 0}, {4, 2, 0}, {4, 1, 0}, {3, 1, 0},
                         {3, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  std::vector<Vec3> with_middles{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0},
                                 {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  for (const auto& [outline, area] :
       {std::pair(&l, 3.0), std::pair(&comb, 8.0), std::pair(&with_middles, 4.0)})
    for (std::size_t start = 0; start < outline->size(); ++start) {
      std::rotate(outline->begin(), outline->begin() + 1, outline->end());
      EXPECT_NEAR(area_of_triangles(face_with_bent_texture(*outline)), area, 1e-9) << area << ", " << start;
      std::vector<Vec3> turned;
      for (const Vec3& corner : *outline) turned.emplace_back(turn * corner + Vec3(7, -3, 11));
      EXPECT_NEAR(area_of_triangles(face_with_bent_texture(turned)), area, 1e-9)
          << area << ", turned, " << start;
    }
}

}  // namespace
}  // namespace reemit

#include "mesh/pieces/texture_split.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "scenes/model/measures.h"

namespace reemit {
namespace {

using Corners = std::array<std::uint32_t, 3>;

const Vec3& place(const Surface& surface, const Face& face, std::uint32_t corner) {
  return surface.positions[face.outer[corner]];
}

Vec3 twice_area(const Surface& surface, const Face& face, const Corners& t) {
  const Vec3& a = place(surface, face, t[0]);
  return (place(surface, face, t[1]) - a).cross(place(surface, face, t[2]) - a);
}

/// Of three corners that follow each other or not, those that span the most.
Corners widest_triangle(const Surface& surface, const Face& face) {
  Corners best{0, 1, 2};
  double most = -1;
  const auto count = static_cast<std::uint32_t>(face.outer.size());
  for (std::uint32_t i = 1; i + 1 < count; ++i)
    for (const Corners& t : {Corners{0, i, i + 1}, Corners{i - 1, i, i + 1}}) {
      const double size = twice_area(surface, face, t).norm();
      if (size > most) {
        most = size;
        best = t;
      }
    }
  return best;
}

using Values = Eigen::Matrix<double, 7, 1>;

Values values_at(const Surface& surface, const Face& face, std::uint32_t corner) {
  const TexturePoint& p = surface.texture_points[face.texture_points[corner]];
  Values values;
  values << p.uv[0][0], p.uv[0][1], p.uv[1][0], p.uv[1][1], p.colour[0], p.colour[1], p.colour[2];
  return values;
}

/// Whether a corner turns the way of the outline and no other corner lies in its triangle or on its rim: cut
/// off there, an outline that turns back at a point of the cut would be left with area that is not its own.
bool is_ear(const Surface& surface, const Face& face, const Vec3& normal,
            const std::vector<std::uint32_t>& left, const Corners& t) {
  const double size = twice_area(surface, face, t).dot(normal);
  if (!(size > 0)) return false;
  constexpr double kRounding = 1e-9;
  return std::none_of(left.begin(), left.end(), [&](std::uint32_t other) {
    const auto is_at = [&](std::uint32_t corner) {
      return place(surface, face, other) == place(surface, face, corner);  // holes are joined by such
    };
    if (std::any_of(t.begin(), t.end(), is_at)) return false;
    for (std::size_t k = 0; k < 3; ++k)
      if (!(twice_area(surface, face, {t[k], t[(k + 1) % 3], other}).dot(normal) >= -kRounding * size))
        return false;
    return true;
  });
}

}  // namespace

bool has_affine_texture(const Surface& surface, const Face& face) {
  if (face.texture_points.empty() || face.outer.size() <= 3) return true;
  const Corners t = widest_triangle(surface, face);
  const Vec3& a = place(surface, face, t[0]);
  const Vec3 n = twice_area(surface, face, t);
  if (!(n.squaredNorm() > 0)) return true;
  const Vec3 e1 = place(surface, face, t[1]) - a;
  const Vec3 e2 = place(surface, face, t[2]) - a;
  const Values at_a = values_at(surface, face, t[0]);
  const Values d1 = values_at(surface, face, t[1]) - at_a;
  const Values d2 = values_at(surface, face, t[2]) - at_a;
  // What coordinates printed with five digits round to.
  constexpr double kSlack = 1e-4;
  const Values size = d1.cwiseAbs() + d2.cwiseAbs() + Values::Constant(1e-2);
  for (std::uint32_t i = 0; i < face.outer.size(); ++i) {
    const Vec3 p = place(surface, face, i) - a;
    const double u = n.dot(p.cross(e2)) / n.squaredNorm();
    const double v = n.dot(e1.cross(p)) / n.squaredNorm();
    const Values off = values_at(surface, face, i) - (at_a + u * d1 + v * d2);
    if ((off.cwiseAbs().array() > kSlack * size.array()).any()) return false;
  }
  return true;
}

std::vector<Corners> texture_triangles(const Surface& surface, const Face& face) {
  if (face.outer.size() <= 3) return {{0, 1, 2}};
  if (has_affine_texture(surface, face)) return {widest_triangle(surface, face)};
  const Vec3 normal = outline_area(surface.positions, face.outer);
  std::vector<std::uint32_t> left(face.outer.size());
  for (std::uint32_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<Corners> triangles;
  while (left.size() > 3) {
    std::size_t ear = 1;
    const auto corners = [&](std::size_t k) {
      return Corners{left[k - 1], left[k], left[(k + 1) % left.size()]};
    };
    while (ear < left.size() && !is_ear(surface, face, normal, left, corners(ear))) ++ear;
    if (ear == left.size()) ear = 1;  // an outline that crosses itself has no good ones
    triangles.push_back(corners(ear));
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

}  // namespace reemit

#include "mesh/zone_mesh.h"

#include <limits>
#include <stdexcept>
#include <utility>

namespace reemit {

ZoneMesh::ZoneMesh(BaseMesh base) : base_(std::move(base)) {
  const std::size_t count = base_.triangles.size();
  triangle_area_.reserve(count);
  triangle_normal_.reserve(count);
  first_zone_.reserve(2 * count);
  std::size_t zones = 0;
  for (const BaseTriangle& t : base_.triangles) {
    for (const std::uint32_t v : t.vertex)
      if (v >= base_.vertices.size()) throw std::invalid_argument("base triangle with a vertex out of range");
    for (const std::uint32_t n : t.normal)
      if (n != BaseTriangle::kFlat && n >= base_.normals.size())
        throw std::invalid_argument("base triangle with a normal out of range");
    if (t.divisions == 0) throw std::invalid_argument("base triangle without zones");
    const Vec3& p0 = base_.vertices[t.vertex[0]];
    const Vec3 cross = (base_.vertices[t.vertex[1]] - p0).cross(base_.vertices[t.vertex[2]] - p0);
    const double length = cross.stableNorm();
    triangle_area_.push_back(0.5 * length);
    triangle_normal_.push_back(length > 0 ? Vec3(cross / length) : Vec3(Vec3::UnitZ()));
    const std::size_t per_side = std::size_t{t.divisions} * t.divisions;
    first_zone_.emplace_back(zones);
    first_zone_.push_back(t.two_sided ? ZoneId(zones + per_side) : ZoneId());
    zones += (t.two_sided ? 2 : 1) * per_side;
    if (zones >= std::numeric_limits<std::uint32_t>::max())
      throw std::invalid_argument("more than 2^32-2 zones");
  }
  zone_triangle_.reserve(zones);
  for (std::size_t i = 0; i < count; ++i) {
    const BaseTriangle& t = base_.triangles[i];
    zone_triangle_.insert(zone_triangle_.end(),
                          (t.two_sided ? 2 : 1) * std::size_t{t.divisions} * t.divisions, TriangleId(i));
  }
}

double ZoneMesh::zone_area(ZoneId z) const {
  const TriangleId t = zone_triangle(z);
  const double n = triangle(t).divisions;
  return triangle_area(t) / (n * n);
}

Vec3 ZoneMesh::zone_normal(ZoneId z) const {
  const Vec3& n = triangle_normal(zone_triangle(z));
  return zone_is_front(z) ? n : Vec3(-n);
}

std::array<Barycentric, 3> ZoneMesh::zone_barycentrics(ZoneId z) const {
  const TriangleId t = zone_triangle(z);
  const ZoneId first = first_zone(t, zone_is_front(z));
  return zone_corners(triangle(t).divisions, static_cast<std::uint32_t>(z.index() - first.index()));
}

Vec3 ZoneMesh::point(TriangleId t, double u, double v) const {
  return (1 - u - v) * corner(t, 0) + u * corner(t, 1) + v * corner(t, 2);
}

Vec3 ZoneMesh::zone_centroid(ZoneId z) const {
  const auto c = zone_barycentrics(z);
  return point(zone_triangle(z), (c[0].u + c[1].u + c[2].u) / 3, (c[0].v + c[1].v + c[2].v) / 3);
}

}  // namespace reemit

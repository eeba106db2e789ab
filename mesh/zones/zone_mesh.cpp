#include "mesh/zones/zone_mesh.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace reemit {

void ZoneMesh::add_shapes() {
  const auto is_curved = [](const BaseTriangle& t) { return t.is_curved(); };
  const auto first = std::find_if(base_.triangles.begin(), base_.triangles.end(), is_curved);
  flat_count_ = static_cast<std::size_t>(first - base_.triangles.begin());
  std::size_t next = flat_count_;
  for (std::uint32_t s = 0; s < base_.shapes.size(); ++s) {
    curved_.emplace_back(base_.shapes[s]);
    first_patch_.emplace_back(next);
    for (std::uint32_t p = 0; p < curved_.back().count(); ++p, ++next)
      if (next >= base_.triangles.size() || base_.triangles[next].shape != s ||
          base_.triangles[next].patch != p)
        throw std::invalid_argument("patches of a curved shape that are missing or out of order");
  }
  if (next != base_.triangles.size()) throw std::invalid_argument("patches without a shape");
}

ZoneMesh::ZoneMesh(BaseMesh base) : base_(std::move(base)) {
  add_shapes();
  const std::size_t count = base_.triangles.size();
  triangle_area_.reserve(count);
  triangle_normal_.reserve(count);
  sides_.reserve(2 * count);
  std::size_t zones = 0;
  for (const BaseTriangle& t : base_.triangles) {
    for (const std::uint32_t v : t.vertex)
      if (v >= base_.vertices.size()) throw std::invalid_argument("base triangle with a vertex out of range");
    for (const std::uint32_t n : t.normal)
      if (n != BaseTriangle::kFlat && n >= base_.normals.size())
        throw std::invalid_argument("base triangle with a normal out of range");
    if (t.divisions == 0) throw std::invalid_argument("base triangle without zones");
    if (t.is_curved()) {
      const CurvedPatches& shape = curved_[t.shape];
      triangle_area_.push_back(shape.patch_area());
      triangle_normal_.push_back(shape.normal(t.patch, 1.0 / 3, 1.0 / 3));
    } else {
      const Vec3& p0 = base_.vertices[t.vertex[0]];
      const Vec3 cross = (base_.vertices[t.vertex[1]] - p0).cross(base_.vertices[t.vertex[2]] - p0);
      const double length = cross.stableNorm();
      triangle_area_.push_back(0.5 * length);
      triangle_normal_.push_back(length > 0 ? Vec3(cross / length) : Vec3(Vec3::UnitZ()));
    }
    const std::size_t per_side = std::size_t{t.divisions} * t.divisions;
    sides_.push_back({ZoneId(zones), t.divisions});
    sides_.push_back({t.two_sided ? ZoneId(zones + per_side) : ZoneId(), t.divisions});
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
  const auto c = zone_barycentrics(z);
  const Vec3 n = normal(zone_triangle(z), (c[0].u + c[1].u + c[2].u) / 3, (c[0].v + c[1].v + c[2].v) / 3);
  return zone_is_front(z) ? n : Vec3(-n);
}

std::array<Barycentric, 3> ZoneMesh::zone_barycentrics(ZoneId z) const {
  const TriangleId t = zone_triangle(z);
  const ZoneId first = first_zone(t, zone_is_front(z));
  return zone_corners(triangle(t).divisions, static_cast<std::uint32_t>(z.index() - first.index()));
}

Vec3 ZoneMesh::point(TriangleId t, double u, double v) const {
  const BaseTriangle& tri = triangle(t);
  if (tri.is_curved()) return curved_[tri.shape].point(tri.patch, u, v);
  return (1 - u - v) * corner(t, 0) + u * corner(t, 1) + v * corner(t, 2);
}

Barycentric ZoneMesh::barycentric_of(TriangleId t, const Vec3& p) const {
  const BaseTriangle& tri = triangle(t);
  if (tri.is_curved()) return curved_[tri.shape].in_patch(tri.patch, p);
  const Vec3 e1 = corner(t, 1) - corner(t, 0);
  const Vec3 e2 = corner(t, 2) - corner(t, 0);
  const Vec3 d = p - corner(t, 0);
  const Vec3 n = e1.cross(e2);
  const double n2 = n.squaredNorm();
  return {d.cross(e2).dot(n) / n2, e1.cross(d).dot(n) / n2};
}

Vec3 ZoneMesh::zone_centroid(ZoneId z) const {
  const auto c = zone_barycentrics(z);
  return point(zone_triangle(z), (c[0].u + c[1].u + c[2].u) / 3, (c[0].v + c[1].v + c[2].v) / 3);
}

}  // namespace reemit

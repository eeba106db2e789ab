#include "solver/shoot/packet_room.h"

#include <algorithm>
#include <utility>

#include "solver/emit/light_places.h"
#include "solver/shoot/curved_lanes.h"
#include "solver/trace/surface_point.h"

namespace reemit {

PacketRoom::PacketRoom(const Room& room, Channels channels)
    : room_(&room), mesh_(&room.mesh()), rays_(&room.rays()), channels_(channels) {
  const ZoneMesh& mesh = *mesh_;
  const RayTracer& rays = *rays_;
  for (const PunctualLight& light : lights_before_faces(room.scene(), rays))
    emitters_.push_back(make_punctual_emitter(light, rays));
  patches_.reserve(mesh.triangle_count());
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const TriangleId t(i);
    const std::uint32_t n = mesh.triangle(t).divisions;
    const Vec3f p0 = rays.corner(t, 0);
    const Vec3f e1 = rays.corner(t, 1) - p0;
    const Vec3f e2 = rays.corner(t, 2) - p0;
    const auto scale = 1.0F / static_cast<float>(n);
    patches_.push_back({p0, scale * e1, scale * e2, p0 + (e1 + e2) / 3.0F, Frame(rays.normal(t)), n,
                        rays.edge_share(t), rays.is_foot(t)});
  }
  needs_ = needs_of_zones();
}

std::vector<std::uint8_t> PacketRoom::needs_of_zones() const {
  std::vector<std::uint8_t> needs;
  const SkyLight* sky = room_->sky();
  if (sky == nullptr) return needs;
  for (std::size_t z = 0; z < mesh_->zone_count(); ++z) {
    float pick = 0.5F;
    const SidePoint x = cell_point(mesh_->pick_cell(ZoneId(z), pick), 1.0F / 3, 1.0F / 3);
    const auto u = static_cast<float>(x.at.u);
    const auto v = static_cast<float>(x.at.v);
    needs.push_back(
        sky->need(rays_->point(x.triangle, u, v), side_normal(*rays_, x.triangle, u, v, x.front)));
  }
  return needs;
}

void PacketRoom::put_zone(ZoneId z, ZoneLanes& lanes, int first, int last) const {
  const TriangleId t = mesh_->zone_triangle(z);
  if (t.index() >= mesh_->flat_count() || mesh_->is_group(z)) {
    const std::uint32_t bits = lane_bits(first, last);
    lanes.one_by_one |= bits;
    lanes.points &= ~bits;
    lanes.feet &= ~bits;
    std::fill(lanes.zone + first, lanes.zone + last, static_cast<std::uint32_t>(z.index()));
    return;
  }
  const TrianglePatch& p = patches_[t.index()];
  const SideCell zone = mesh_->zone_cell(z);
  put_flat_side(static_cast<std::uint32_t>(t.index()), zone.front, lanes, first, last);
  lanes.without_edges &= ~lane_bits(first, last);
  const auto& [from, a, b] = zone.corners.at;
  // Of the grid of its corners, in edges of the cells that the triangle is divided into.
  const float size = static_cast<float>(p.divisions) / static_cast<float>(zone.corners.divisions);
  const auto along = [&](const GridPoint& to, const GridPoint& of) {
    return std::pair(size * static_cast<float>(to.i - of.i), size * static_cast<float>(to.j - of.j));
  };
  const auto [i, j] = along(from, {0, 0});
  const auto [i1, j1] = along(a, from);
  const auto [i2, j2] = along(b, from);
  for (int k = 0; k < 3; ++k) {
    std::fill(lanes.corner[k] + first, lanes.corner[k] + last, p.corner[k] + i * p.edge1[k] + j * p.edge2[k]);
    std::fill(lanes.edge1[k] + first, lanes.edge1[k] + last, i1 * p.edge1[k] + j1 * p.edge2[k]);
    std::fill(lanes.edge2[k] + first, lanes.edge2[k] + last, i2 * p.edge1[k] + j2 * p.edge2[k]);
  }
}

bool PacketRoom::start_from(ZoneId z, float u0, float u1, const Vec3f& local, Ray16& rays, int lane) const {
  const SideCell cell = mesh_->pick_cell(z, u0);
  const auto [a, b] = sample_triangle(u0, u1);
  const SidePoint x = cell_point(cell, a, b);
  return start_at(x.triangle, static_cast<float>(x.at.u), static_cast<float>(x.at.v), x.front, local, rays,
                  lane);
}

bool PacketRoom::start_at(TriangleId t, float u, float v, bool front, const Vec3f& local, Ray16& rays,
                          int lane) const {
  Vec3f normal;
  const Vec3f origin = rays_->ray_origin(t, u, v, front, normal);
  const Vec3f direction = Frame(front ? normal : Vec3f(-normal)).to_world(local);
  rays.set(lane, origin, direction);
  return rays_->starts_behind(t, front, origin);
}

bool PacketRoom::starts_together(const ZoneLanes& lanes, int lane) const {
  if ((lanes.one_by_one & ~lanes.points & 1U << lane) == 0) return false;
  const ZoneId zone(lanes.zone[lane]);
  return !mesh_->is_group(zone) && !rays_->touches_others(mesh_->zone_triangle(zone));
}

std::uint32_t PacketRoom::start_with_others(ZoneLanes& lanes, const UniformLanes& numbers,
                                            Ray16& rays) const {
  constexpr int kEnough = 4;  // lanes of one zone to start together
  CurvedStarts starts;
  std::uint32_t together = 0;
  float origin[3][16];
  for (int lane = 0; lane < 16;) {
    const int first = lane++;
    if (!starts_together(lanes, first)) continue;
    while (lane < 16 && lanes.zone[lane] == lanes.zone[first] && starts_together(lanes, lane)) ++lane;
    if (lane - first < kEnough) continue;
    curved_starts(*rays_, mesh_->zone_cell(ZoneId(lanes.zone[first])), numbers, starts);
    put_normals(starts, first, lane, lanes);
    for (int k = 0; k < 3; ++k)
      std::copy(starts.origin[k] + first, starts.origin[k] + lane, origin[k] + first);
    together |= lane_bits(first, lane);
  }
  std::uint32_t behind = start_rays(lanes, numbers, rays) & ~lanes.one_by_one;
  for (int lane = 0; lane < 16; ++lane)
    if ((together >> lane & 1U) != 0)
      rays.set(lane, {origin[0][lane], origin[1][lane], origin[2][lane]}, rays.direction(lane));
  behind |= start_one_by_one(lanes, lanes.one_by_one & ~together, numbers, rays);
  if (lanes.feet != 0) start_at_feet(lanes, rays);
  return behind;
}

std::uint32_t PacketRoom::start_one_by_one(const ZoneLanes& lanes, std::uint32_t which,
                                           const UniformLanes& numbers, Ray16& rays) const {
  std::uint32_t behind = 0;
  for (int lane = 0; lane < 16; ++lane) {
    if ((which >> lane & 1U) == 0) continue;
    const Vec3f local = sample_cosine_hemisphere(numbers.u[2][lane], numbers.u[3][lane]);
    const bool is_behind =
        (lanes.points >> lane & 1U) != 0
            ? start_at(TriangleId(lanes.zone[lane]), lanes.corner[0][lane], lanes.corner[1][lane],
                       lanes.corner[2][lane] > 0, local, rays, lane)
            : start_from(ZoneId(lanes.zone[lane]), numbers.u[0][lane], numbers.u[1][lane], local, rays, lane);
    behind |= (is_behind ? 1U : 0U) << lane;
  }
  return behind;
}

void PacketRoom::start_at_feet(const ZoneLanes& lanes, Ray16& rays) const {
  for (int lane = 0; lane < 16; ++lane) {
    if ((lanes.feet >> lane & 1U) == 0) continue;
    const Vec3f start = rays_->clear_of_shapes(TriangleId(lanes.zone[lane]), rays.origin(lane));
    rays.set(lane, start, rays.direction(lane));
  }
}

}  // namespace reemit

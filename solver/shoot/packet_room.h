#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/zones/zone_mesh.h"
#include "scenes/model/scene.h"
#include "solver/emit/punctual_emitter.h"
#include "solver/room/room.h"
#include "solver/sampling/warp.h"
#include "solver/shoot/ray_lanes.h"
#include "solver/tally/batch_books.h"
#include "solver/trace/ray_tracer.h"

namespace reemit {

/// What packets need of the room, laid out for the inner loop: one cache-friendly record per base triangle.
/// The room must outlive it.
class PacketRoom {
 public:
  explicit PacketRoom(const Room& room) : PacketRoom(room, channels_of(room.scene())) {}
  /// With light groups other than those of the scene.
  PacketRoom(const Room& room, Channels channels);

  const Room& room() const { return *room_; }
  const Scene& scene() const { return room_->scene(); }
  /// The lights of the scene as packets start at them (lights_before_faces).
  const std::vector<PunctualEmitter>& emitters() const { return emitters_; }
  /// Starts of packets, 16 at most, of a source that is not a surface (PacketSource::light).
  void start_light(std::uint32_t light, const LightNumbers& u, std::span<LightRay> rays) const {
    if (light < emitters_.size()) {
      start_light_rays(emitters_[light], u, rays);
      return;
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const SkyRay ray = room_->sky()->start(light - emitters_.size(), u[0][i], u[1][i], u[2][i], u[3][i]);
      rays[i] = {ray.origin, ray.direction};
    }
  }
  /// Whether the light of such a source comes from outside the room.
  bool is_from_outside(std::uint32_t light) const {
    return light >= emitters_.size() || is_at_infinity(emitters_[light]);
  }
  /// Whether such a source is a part of the sky whose light gather rays find, the sun not being one.
  bool is_found_by_rays(std::uint32_t light) const {
    return light >= emitters_.size() && !room_->sky()->is_sun(light - emitters_.size());
  }
  /// By zone, how many packets its light is to be carried on by, over that of a zone that sees much of the
  /// sky (SkyLight::need); empty without one.
  const std::vector<std::uint8_t>& needs() const { return needs_; }
  const ZoneMesh& mesh() const { return *mesh_; }
  const RayTracer& rays() const { return *rays_; }
  const SurfaceModel& surface_model() const { return room_->surfaces(); }
  Channels channels() const { return channels_; }
  std::size_t zones() const { return mesh_->zone_count(); }
  std::size_t surfaces() const { return room_->surfaces().surface_count(); }

  /// Empty books of a batch in this room.
  BatchBooks new_books() const { return {zones(), surfaces(), channels(), scene().bends_light()}; }

  /// Puts the geometry of a zone into lanes first .. last-1.
  void put_zone(ZoneId z, ZoneLanes& lanes, int first, int last) const;
  /// Puts a side of a base triangle into lanes first .. last-1, for put_point.
  void put_side(std::uint32_t triangle, bool front, ZoneLanes& lanes, int first, int last) const {
    if (triangle >= mesh_->flat_count()) {
      const std::uint32_t bits = lane_bits(first, last);
      lanes.one_by_one |= bits;
      lanes.points |= bits;
      lanes.feet &= ~bits;
      std::fill(lanes.zone + first, lanes.zone + last, triangle);
      std::fill(lanes.corner[2] + first, lanes.corner[2] + last, front ? 1.0F : -1.0F);
      return;
    }
    put_flat_side(triangle, front, lanes, first, last);
    const std::uint32_t bits = lane_bits(first, last);
    if ((lanes.without_edges & bits) == bits) return;
    lanes.without_edges |= bits;
    for (int k = 0; k < 3; ++k) {
      std::fill(lanes.edge1[k] + first, lanes.edge1[k] + last, 0.0F);
      std::fill(lanes.edge2[k] + first, lanes.edge2[k] + last, 0.0F);
    }
  }
  /// Makes the ray of a lane leave from (u,v), whatever the uniform numbers of its point are.
  void put_point(std::uint32_t triangle, float u, float v, ZoneLanes& lanes, int lane) const {
    if (triangle >= mesh_->flat_count()) {
      lanes.corner[0][lane] = u;
      lanes.corner[1][lane] = v;
      return;
    }
    const TrianglePatch& p = patches_[triangle];
    if (std::min({u, v, 1 - u - v}) < p.edge_share) rays_->move_off_edges(TriangleId(triangle), u, v);
    const float un = u * static_cast<float>(p.divisions);
    const float vn = v * static_cast<float>(p.divisions);
    for (int k = 0; k < 3; ++k) lanes.corner[k][lane] = p.corner[k] + un * p.edge1[k] + vn * p.edge2[k];
  }
  /// Makes the ray of a lane leave from where another met a side.
  void put_hit(std::uint32_t triangle, float u, float v, bool front, ZoneLanes& lanes, int lane) const {
    put_side(triangle, front, lanes, lane, lane + 1);
    put_point(triangle, u, v, lanes, lane);
  }

  /// start_rays for zones that may be curved or groups; also returns the lanes that start behind.
  std::uint32_t start(ZoneLanes& lanes, const UniformLanes& numbers, Ray16& rays) const {
    if (lanes.one_by_one != 0) return start_with_others(lanes, numbers, rays);
    const std::uint32_t behind = start_rays(lanes, numbers, rays);
    if (lanes.feet != 0) start_at_feet(lanes, rays);
    return behind;
  }
  /// Starts one ray from a uniform point of a zone with a direction given in the frame of its normal (z up).
  /// True if it starts behind (RayTracer::starts_behind).
  bool start_from(ZoneId z, float u0, float u1, const Vec3f& local, Ray16& rays, int lane) const;

  /// Zone that a hit belongs to; not valid when it is the back of a one-sided face.
  ZoneId zone_of(std::uint32_t triangle, float u, float v, bool front) const {
    return mesh_->zone_at(TriangleId(triangle), u, v, front);
  }
  /// Numbers of the zones of 16 hits, ZoneMesh::kNone where a ray left the room as well.
  void zones_of(const Hit16& hits, std::uint32_t* zone) const { mesh_->zones_at16(hits.points(), zone); }

 private:
  /// Packets of walks have a lane each, for which a loop takes several times as long.
  template <class Value>
  static void fill(Value* lanes, int first, int last, Value value) {
    lanes[first] = value;
    for (int lane = first + 1; lane < last; ++lane) lanes[lane] = value;
  }
  /// What the zones on a side of a flat triangle have in common.
  void put_flat_side(std::uint32_t triangle, bool front, ZoneLanes& lanes, int first, int last) const {
    const std::uint32_t bits = lane_bits(first, last);
    const TrianglePatch& p = patches_[triangle];
    lanes.one_by_one &= ~bits;
    lanes.feet &= ~bits;
    if (p.is_foot) {
      lanes.feet |= bits;
      fill(lanes.zone, first, last, triangle);
    }
    const auto number = static_cast<std::uint32_t>(side_of(TriangleId(triangle), front).index());
    if (lanes.of_all == number) return;
    lanes.of_all = first == 0 && last == 16 ? number : ZoneMesh::kNone;
    const float side = front ? 1.0F : -1.0F;
    for (int k = 0; k < 3; ++k) {
      fill(lanes.middle[k], first, last, p.middle[k]);
      fill(lanes.tangent[k], first, last, p.frame.tangent[k]);
      fill(lanes.bitangent[k], first, last, p.frame.bitangent[k]);
      fill(lanes.normal[k], first, last, side * p.frame.normal[k]);
    }
  }

  std::vector<std::uint8_t> needs_of_zones() const;
  bool start_at(TriangleId t, float u, float v, bool front, const Vec3f& local, Ray16& rays, int lane) const;
  std::uint32_t start_with_others(ZoneLanes& lanes, const UniformLanes& numbers, Ray16& rays) const;
  /// Whether curved_starts may be asked for starts on the zone of a lane that goes one by one.
  bool starts_together(const ZoneLanes& lanes, int lane) const;
  std::uint32_t start_one_by_one(const ZoneLanes& lanes, std::uint32_t which, const UniformLanes& numbers,
                                 Ray16& rays) const;
  void start_at_feet(const ZoneLanes& lanes, Ray16& rays) const;

  /// A base triangle with the edges of one of its cells (normalised space).
  struct TrianglePatch {
    Vec3f corner, edge1, edge2, middle;
    Frame frame;  // about the front normal
    std::uint32_t divisions;
    float edge_share;  // RayTracer::edge_share
    bool is_foot;
  };

  const Room* room_;
  const ZoneMesh* mesh_;
  const RayTracer* rays_;
  Channels channels_;
  std::vector<PunctualEmitter> emitters_;
  std::vector<std::uint8_t> needs_;
  std::vector<TrianglePatch> patches_;
};

}  // namespace reemit

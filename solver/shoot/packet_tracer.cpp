#include "solver/shoot/packet_tracer.h"

namespace reemit {
namespace {

/// Lanes, as bits, of the first `count` packets that met a zone and need no second look.
std::uint32_t lanes_in_zones(const RayTracer& scene, const Hit16& hits, const std::uint32_t* zones, int count,
                             bool second_look) {
  std::uint32_t in_zones = 0;
  std::uint32_t near_edge = 0;
  for (int lane = 0; lane < 16; ++lane) {
    in_zones |= (zones[lane] != ZoneMesh::kNone ? 1U : 0U) << lane;
    near_edge |= (hits.near_edge[lane] ? 1U : 0U) << lane;
  }
  in_zones &= lane_bits(0, count);
  if (!second_look)
    for_lanes(in_zones & near_edge, [&](int lane) {
      if (scene.is_at_edge(hits, lane)) in_zones &= ~(1U << lane);
    });
  return in_zones;
}

}  // namespace

PacketTracer::PacketTracer(const BatchTask& task, BatchBooks& books)
    : transport_(task.transport),
      observer_(task.ray_observer),
      books_(books),
      local_(books),
      specular_(task, books),
      doubtful_(task.transport.channels()),
      carried_(task.transport.channels()),
      waiting_(task.transport.channels()) {}

PacketArrivals PacketTracer::look(PacketBlock& block, bool second_look) {
  PacketArrivals arrived{block, hits_};
  transport_.rays().closest16(block.rays, block.count, hits_);
  transport_.zones_of(hits_, arrived.zones);
  arrived.in_zones = lanes_in_zones(transport_.rays(), hits_, arrived.zones, block.count, second_look);
  if (specular_.any()) arrived.specular = specular_.lanes(block, hits_) & arrived.in_zones;
  for_lanes(lane_bits(0, block.count) & ~arrived.in_zones,
            [&](int lane) { settle_outside_zones(block, lane, second_look); });
  for_lanes(arrived.specular,
            [&](int lane) { specular_.attenuate(block.way[lane], hits_, lane, block.power_of(lane)); });
  return arrived;
}

/// Leaves a packet that met no zone for its second look, or books it where it ended.
void PacketTracer::settle_outside_zones(PacketBlock& block, int lane, bool second_look) {
  const std::uint32_t met = hits_.triangle[lane];
  if (!second_look && !transport_.rays().has_left(met)) {
    doubtful_.add_doubtful(transport_.rays(), block, hits_, lane);
    local_.count_second_look();
    return;
  }
  std::int64_t* quanta = block.power_of(lane);
  const std::size_t values = books_.channels.count();
  if (met == RayTracer::kMiss) {
    for (std::size_t c = 0; c < values; ++c)
      local_.escape(block.rays.dx[lane], block.rays.dy[lane], block.rays.dz[lane], c, quanta[c]);
    return;
  }
  count_event(books_.events.back_hits);
  if (specular_.any()) specular_.attenuate(block.way[lane], hits_, lane, quanta);
  const SurfaceId surface = transport_.surface_model().surface(TriangleId(met), hits_.front[lane]);
  for (std::size_t c = 0; c < values; ++c)
    book(books_.absorbed_on_backs[surface.index() * values + c], quanta[c]);
}

}  // namespace reemit

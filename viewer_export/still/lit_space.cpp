#include "viewer_export/still/lit_space.h"

#include <algorithm>
#include <cstddef>

#include "solver/losses/probe_flight.h"
#include "solver/sampling/warp.h"
#include "solver/shoot/flight.h"
#include "solver/shoot/packet_room.h"
#include "solver/shoot/packet_sources.h"

namespace reemit {
namespace {

constexpr std::uint32_t kPackets = 2048;
constexpr std::uint32_t kReflections = 5;
constexpr std::uint64_t kSeed = 0;
/// How far light that leaves the room is followed: half its size.
constexpr float kEscape = 1;

/// Packets over sources in proportion to weight, by systematic sampling: each gets its share to within one.
Flight spread_packets(const PacketSources& emission, const std::vector<double>& weights) {
  double total = 0;
  for (const double w : weights) total += w;
  Flight flight;
  double sum = 0;
  std::uint32_t sent = 0;
  for (std::size_t s = 0; s < weights.size(); ++s) {
    sum += weights[s];
    const double due = total > 0 ? kPackets * (sum / total) + 0.5 : 0;
    const auto until = std::min(kPackets, static_cast<std::uint32_t>(due));
    if (until <= sent) continue;
    flight.add(emission.sources[s], until - sent);
    const auto quanta = emission.quanta_of(s);
    flight.quanta.insert(flight.quanta.end(), quanta.begin(), quanta.end());
    sent = until;
  }
  return flight;
}

/// Notes a leg; true if the side it ends on reflects.
bool note(const PacketRoom& transport, const ProbeRay& probe, LitSpace& space) {
  space.legs.push_back({probe.origin, probe.direction, probe.met ? probe.hit.distance : kEscape});
  if (!probe.met || is_back(transport, probe.hit)) return false;
  const Vec3f normal = transport.rays().normal(probe.hit.triangle, probe.hit.u, probe.hit.v);
  space.lit_points.push_back(probe.origin + probe.hit.distance * probe.direction);
  space.lit_normals.push_back(probe.hit.front ? normal : Vec3f(-normal));
  return true;
}

/// One more reflection of packets, from where they fell: the zones of a coarse mesh may reach through walls.
std::vector<Hit> reflect(const PacketRoom& transport, const std::vector<Hit>& hits, std::uint32_t stream,
                         LitSpace& space) {
  const FlightNumbers numbers(SamplingKind::kSobol, kSeed, 0, stream);
  std::vector<Hit> next;
  for (std::size_t first = 0; first < hits.size(); first += 16) {
    const int count = static_cast<int>(std::min<std::size_t>(16, hits.size() - first));
    UniformLanes uniform;
    numbers.get16(static_cast<std::uint32_t>(first), uniform);
    Ray16 rays;
    for (int lane = 0; lane < count; ++lane) {
      const Hit& hit = hits[first + static_cast<std::size_t>(lane)];
      const Vec3f front = transport.rays().normal(hit.triangle, hit.u, hit.v);
      const Frame frame(hit.front ? front : Vec3f(-front));
      const Vec3f direction =
          frame.to_world(sample_cosine_hemisphere(uniform.u[2][lane], uniform.u[3][lane]));
      rays.set(lane, transport.rays().ray_origin(hit.triangle, hit.u, hit.v, hit.front), direction);
    }
    trace_probes(transport.rays(), rays, count, [&](int, const ProbeRay& probe) {
      if (note(transport, probe, space)) next.push_back(probe.hit);
    });
  }
  return next;
}

LitSpace follow(const PacketRoom& transport, const Flight& flight) {
  LitSpace space;
  std::vector<Hit> hits;
  std::uint32_t stream = 0;
  trace_probes(transport, flight, stream++, [&](const ProbeRay& probe) {
    if (note(transport, probe, space)) hits.push_back(probe.hit);
  });
  while (stream <= kReflections && !hits.empty()) hits = reflect(transport, hits, stream++, space);

  // Half of the way of light goes along legs that are longer than the typical one: packets caught in a lamp
  // or between leaves make many legs, but little way.
  std::vector<float> lengths;
  double way = 0;
  for (const LightLeg& leg : space.legs) {
    lengths.push_back(leg.length);
    way += static_cast<double>(leg.length);
  }
  std::sort(lengths.begin(), lengths.end());
  double sum = 0;
  for (const float length : lengths) {
    sum += static_cast<double>(length);
    space.width = length;
    if (sum >= way / 2) break;
  }
  return space;
}

}  // namespace

LitSpace trace_light(const Room& room) {
  const PacketRoom transport(room);
  const PacketSources emission = collect_packet_sources(transport);
  std::vector<double> weights;
  for (std::size_t s = 0; s < emission.sources.size(); ++s) weights.push_back(emission.watts_of(s));
  return follow(transport, spread_packets(emission, weights));
}

LitSpace trace_from_all_surfaces(const Room& room) {
  const PacketRoom transport(room);
  PacketSources all(transport.channels());
  std::vector<double> weights;
  for (std::size_t z = 0; z < transport.zones(); ++z) {
    all.sources.push_back({ZoneId(z)});
    weights.push_back(room.mesh().zone_area(ZoneId(z)));
  }
  all.quanta.assign(all.sources.size() * transport.channels().count(), 1);
  return follow(transport, spread_packets(all, weights));
}

}  // namespace reemit

#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/model/stop_check.h"
#include "solver/shoot/flight.h"
#include "solver/trace/ray_tracer.h"

namespace reemit {

/// The way of one packet of a flight, in the normalised space.
struct ProbeRay {
  std::size_t source = 0;  ///< Of the flight.
  Vec3f origin{0, 0, 0};
  Vec3f direction{0, 0, 1};
  Hit hit;
  bool met = false;  ///< Else the packet left the room, and `hit` says nothing.
};

/// Traces up to 16 rays as packets are traced, second looks included, and calls visit(lane, ProbeRay) for
/// each; `source` is left 0.
template <class Visit>
void trace_probes(const RayTracer& scene, const Ray16& rays, int count, const Visit& visit) {
  Hit16 hits;
  scene.closest16(rays, count, hits);
  scene.look_again16(rays, count, hits);
  for (int lane = 0; lane < count; ++lane) {
    ProbeRay probe;
    probe.origin = rays.origin(lane);
    probe.direction = rays.direction(lane);
    probe.met = hits.triangle[lane] != RayTracer::kMiss;
    if (probe.met)
      probe.hit = {TriangleId(hits.triangle[lane]), hits.u[lane], hits.v[lane], hits.distance[lane],
                   hits.front[lane]};
    visit(lane, probe);
  }
}

/// Traces the packets of `flight` in one thread and shows each to `visit`, in order. The same room gives the
/// same rays always: the random numbers are fixed. `stream` tells flights apart. Throws Interrupted when
/// `stop` (may be null) is requested.
template <class Visit>
void trace_probes(const PacketRoom& transport, const Flight& flight, std::uint32_t stream, const Visit& visit,
                  const StopToken* stop = nullptr) {
  constexpr std::uint64_t kSeed = 0;
  const FlightNumbers numbers(SamplingKind::kSobol, kSeed, 0, stream);
  std::vector<std::int64_t> quanta(16 * transport.channels().count());
  if (flight.packets() == 0) return;
  FlightCursor cursor(transport, flight, 0);
  std::size_t source = 0;
  for (std::uint32_t first = 0; first < flight.packets(); first += 16) {
    constexpr std::uint32_t kNowAndThen = 4096;
    if (first % kNowAndThen == 0) end_if_requested(stop);
    const int count = static_cast<int>(std::min<std::uint32_t>(16, flight.packets() - first));
    Ray16 rays;
    cursor.start16(first, count, numbers, rays, quanta.data());
    trace_probes(transport.rays(), rays, count, [&](int lane, ProbeRay& probe) {
      while (first + static_cast<std::uint32_t>(lane) >= flight.first_packet[source + 1]) ++source;
      probe.source = source;
      visit(probe);
    });
  }
}

/// "'wall'", or "surface 3" for one without a name.
std::string quoted_name(const Scene& scene, SurfaceId surface);
/// "12.3 %"
std::string share_text(double share);
/// "(1.25, 0, 3)" of a point [m].
std::string place_text(const Vec3& point);

/// True if a ray that ended in `hit` met the back of a one-sided face, which absorbs everything.
inline bool is_back(const PacketRoom& transport, const Hit& hit) {
  return !transport.mesh().has_zones(hit.triangle, hit.front);
}

}  // namespace reemit

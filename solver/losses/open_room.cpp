#include "solver/losses/open_room.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "solver/losses/probe_flight.h"

namespace reemit {
namespace {

constexpr double kOpenShare = 0.01;
constexpr std::uint32_t kWanderers = 4096;
constexpr std::uint32_t kMostSurfaces = 16;
constexpr std::uint32_t kWandererStream = 2;  // of random numbers of flights

/// Packets of luminaires on their ways from surface to surface.
class Wanderers {
 public:
  explicit Wanderers(const PacketRoom& transport)
      : transport_(transport), rng_(0, RngPurpose::kOpenRoom), at_surface_(transport.channels().bands()) {}

  bool empty() const { return waiting_.empty(); }
  std::uint32_t left() const { return left_; }

  /// What becomes of packet `id` that came over so many surfaces: it leaves, ends, or waits to go on.
  void arrive(const ProbeRay& probe, std::uint32_t id, std::uint32_t surfaces) {
    if (!probe.met) {
      ++left_;
      return;
    }
    const ZoneId zone = transport_.zone_of(static_cast<std::uint32_t>(probe.hit.triangle.index()),
                                           probe.hit.u, probe.hit.v, probe.hit.front);
    if (!zone.valid()) return;
    const auto [back, across] = chances(zone, probe);
    const std::array<float, 4> u = rng_.uniform4(id, 0, surfaces);
    if (!(u[0] < back + across)) return;
    Start start{probe.hit, {u[2], u[3]}, id};
    if (u[1] * (back + across) >= back) start.from.front = !start.from.front;
    waiting_.push_back(start);
  }

  void go_on(std::uint32_t surfaces) {
    const std::vector<Start> starts = std::exchange(waiting_, {});
    for (std::size_t first = 0; first < starts.size(); first += 16) {
      const int count = static_cast<int>(std::min<std::size_t>(16, starts.size() - first));
      ZoneLanes lanes{};
      UniformLanes numbers{};
      for (int lane = 0; lane < count; ++lane) {
        const auto& [from, u, id] = starts[first + static_cast<std::size_t>(lane)];
        transport_.put_hit(static_cast<std::uint32_t>(from.triangle.index()), from.u, from.v, from.front,
                           lanes, lane);
        numbers.u[2][lane] = u[0];
        numbers.u[3][lane] = u[1];
      }
      Ray16 rays;
      transport_.start(lanes, numbers, rays);
      trace_probes(transport_.rays(), rays, count, [&](int lane, const ProbeRay& probe) {
        arrive(probe, starts[first + static_cast<std::size_t>(lane)].id, surfaces);
      });
    }
  }

 private:
  struct Start {
    Hit from;
    std::array<float, 2> u;  // of the direction
    std::uint32_t id;
  };

  /// That light goes on from the side that it met, and from the other.
  std::array<float, 2> chances(ZoneId zone, const ProbeRay& probe) {
    const SurfaceModel& surfaces = transport_.surface_model();
    const TriangleId t = probe.hit.triangle;
    auto back = static_cast<float>(surfaces.largest_reflectance(zone, t, probe.hit.front));
    if (!surfaces.is_specular(t, probe.hit.front)) return {back, 0};
    const float cosine =
        -side_normal(transport_.rays(), t, probe.hit.u, probe.hit.v, probe.hit.front).dot(probe.direction);
    if (!(cosine > 0)) return {back, 0};
    surfaces.specular(t).shares(cosine, probe.hit.front, at_surface_);
    const auto largest = [](const std::vector<float>& shares) {
      return *std::max_element(shares.begin(), shares.end());
    };
    back += largest(at_surface_.reflected);
    return {back, largest(at_surface_.transmitted) + largest(at_surface_.diffuse)};
  }

  const PacketRoom& transport_;
  CounterRng rng_;
  SpecularStep at_surface_;
  std::vector<Start> waiting_;
  std::uint32_t left_ = 0;
};

}  // namespace

bool is_open(const PacketRoom& transport, const PacketSources& emission) {
  if (emission.sources.empty()) return false;
  const Flight flight = plan_first_flight(emission, kWanderers, 0.5);
  Wanderers packets(transport);
  std::uint32_t id = 0;
  trace_probes(transport, flight, kWandererStream,
               [&](const ProbeRay& probe) { packets.arrive(probe, id++, 0); });
  for (std::uint32_t surfaces = 1; surfaces <= kMostSurfaces && !packets.empty(); ++surfaces)
    packets.go_on(surfaces);
  return packets.left() >= kOpenShare * flight.packets();
}

bool is_open(const EnergyAudit& audit) {
  return std::any_of(audit.bands.begin(), audit.bands.end(), [](const BandAudit& band) {
    return static_cast<double>(band.total_escaped()) > kOpenShare * static_cast<double>(band.emitted);
  });
}

}  // namespace reemit

#include "solver/shoot/closed_room_check.h"

#include <algorithm>
#include <vector>

#include "scenes/model/error.h"
#include "solver/shoot/flight.h"

namespace reemit {
namespace {

constexpr std::uint32_t kProbes = 4096;
constexpr std::uint32_t kMostBounces = 64;

}  // namespace

void refuse_closed_perfect_reflector(const TransportScene& transport, const Emission& emission,
                                     std::uint64_t seed) {
  const Scene& scene = transport.scene();
  for (std::size_t b = 0; b < transport.bands(); ++b) {
    if (!(emission.watts[b] > 0)) continue;
    const bool all_perfect = std::all_of(scene.surfaces.begin(), scene.surfaces.end(), [&](const Surface& s) {
      return scene.material_of(s).reflectance[static_cast<Eigen::Index>(b)] >= 1;
    });
    if (!all_perfect) continue;

    // Nothing absorbs but the backs of one-sided faces and the world outside: look whether packets find
    // either.
    const Flight flight = plan_emission_flight(emission, transport.bands(), kProbes, 0.5);
    const FlightNumbers numbers(SamplingKind::kSobol, seed, 0, 0);
    const CounterRng rng(seed, RngPurpose::kProbe);
    FlightCursor cursor(transport, flight, 0);
    std::vector<std::int64_t> power(16 * transport.bands());
    for (std::uint32_t first = 0; first < flight.packets(); first += 16) {
      const int count = static_cast<int>(std::min<std::uint32_t>(16, flight.packets() - first));
      Ray16 rays;
      Hit16 hits;
      ZoneLanes lanes{};
      UniformLanes numbers_of_bounce{};
      cursor.start16(first, count, numbers, rays, power.data());
      for (std::uint32_t bounce = 0; bounce < kMostBounces; ++bounce) {
        transport.rays().closest16(rays, count, hits);
        transport.rays().look_again16(rays, count, hits);
        for (int lane = 0; lane < count; ++lane) {
          if (hits.triangle[lane] == RayScene::kMiss) return;
          const ZoneId zone =
              transport.zone_of(hits.triangle[lane], hits.u[lane], hits.v[lane], hits.front[lane]);
          if (!zone.valid()) return;
          const auto x = rng.uniform4(first + static_cast<std::uint32_t>(lane), 0, bounce);
          for (std::size_t d = 0; d < 4; ++d) numbers_of_bounce.u[d][lane] = x[d];
          transport.put_zone(zone, lanes, lane, lane + 1);
        }
        transport.start(lanes, numbers_of_bounce, rays);
      }
    }
    throw InputError(scene.source,
                     "every surface reflects all light of band '" + scene.bands.name(b) +
                         "' and none can leave: the radiosity has no finite value",
                     "Give at least one surface a reflectance below 1, or open the room.");
  }
}

}  // namespace reemit

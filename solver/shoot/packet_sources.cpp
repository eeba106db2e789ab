#include "solver/shoot/packet_sources.h"

#include <cmath>

#include "solver/emit/punctual_emitter.h"

namespace reemit {

PacketSources collect_packet_sources(const PacketRoom& transport) {
  const ZoneMesh& mesh = transport.mesh();
  const Scene& scene = transport.scene();
  const SurfaceModel& surfaces = transport.surface_model();
  const std::size_t bands = transport.bands();
  PacketSources emission;
  std::vector<double> watts;  // [source * bands + band]
  const auto add = [&](PacketSource source, const Spectrum& power) {
    if (!(power > 0).any()) return;
    emission.sources.push_back(source);
    watts.insert(watts.end(), power.begin(), power.end());
  };
  for (std::size_t z = 0; z < mesh.zone_count(); ++z) {
    const ZoneId zone(z);
    if (!surfaces.emits(mesh.zone_triangle(zone), mesh.zone_is_front(zone))) continue;
    const SurfaceId surface = mesh.zone_surface(zone);
    add({zone, 0, static_cast<float>(surfaces.emission_exponent(surface))},
        mesh.zone_area(zone) * surfaces.exitance(zone, surface));
  }
  for (std::size_t l = 0; l < scene.lights.size(); ++l)
    add({ZoneId(), static_cast<std::uint32_t>(l), 0},
        light_power(scene.lights[l], transport.rays().metres_per_unit()));

  const std::size_t count = emission.sources.size();
  emission.quanta.assign(count * bands, 0);
  emission.watts.assign(bands, 0);
  emission.watts_per_quantum.assign(bands, 0);
  for (std::size_t b = 0; b < bands; ++b) {
    double& total = emission.watts[b];
    for (std::size_t s = 0; s < count; ++s) total += watts[s * bands + b];
    if (!(total > 0)) continue;
    emission.watts_per_quantum[b] = total / static_cast<double>(kBatchQuanta);
    // Rounding the running sum, not the terms, makes the quanta add up exactly.
    double running = 0;
    std::int64_t given = 0;
    for (std::size_t s = 0; s < count; ++s) {
      running += watts[s * bands + b];
      const std::int64_t until =
          s + 1 == count ? kBatchQuanta : std::llround(running / total * static_cast<double>(kBatchQuanta));
      emission.quanta[s * bands + b] = until - given;
      given = until;
    }
  }
  return emission;
}

}  // namespace reemit

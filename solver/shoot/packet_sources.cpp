#include "solver/shoot/packet_sources.h"

#include <cmath>
#include <utility>

#include "solver/emit/punctual_emitter.h"

namespace reemit {

double PacketSources::watts_of(std::size_t source) const {
  double sum = 0;
  for (std::size_t c = 0; c < channels.count(); ++c)
    sum += static_cast<double>(quanta_of(source)[c]) * watts_per_quantum[c];
  return sum;
}

PacketSources make_packet_sources(std::vector<PacketSource> sources, const std::vector<double>& watts,
                                  Channels channels) {
  PacketSources emission(channels);
  emission.sources = std::move(sources);
  const std::size_t count = emission.sources.size();
  emission.quanta.assign(count * channels.count(), 0);
  emission.watts_per_quantum.assign(channels.count(), 0);
  for (std::size_t group = 0; group < channels.groups(); ++group)
    for (std::size_t band = 0; band < channels.bands(); ++band) {
      const std::size_t c = channels.channel(group, band);
      std::size_t last = count;
      double total = 0;
      for (std::size_t s = 0; s < count; ++s) {
        if (emission.sources[s].group != group) continue;
        total += watts[s * channels.bands() + band];
        last = s;
      }
      if (!(total > 0)) continue;
      emission.watts_per_quantum[c] = total / static_cast<double>(kBatchQuanta);
      // Rounding the running sum, not the terms, makes the quanta add up exactly.
      double running = 0;
      std::int64_t given = 0;
      for (std::size_t s = 0; s <= last; ++s) {
        if (emission.sources[s].group != group) continue;
        running += watts[s * channels.bands() + band];
        const std::int64_t until =
            s == last ? kBatchQuanta : std::llround(running / total * static_cast<double>(kBatchQuanta));
        emission.quanta[s * channels.count() + c] = until - given;
        given = until;
      }
    }
  return emission;
}

PacketSources collect_packet_sources(const PacketRoom& transport) {
  const ZoneMesh& mesh = transport.mesh();
  const Scene& scene = transport.scene();
  const SurfaceModel& surfaces = transport.surface_model();
  std::vector<PacketSource> sources;
  std::vector<double> watts;
  const auto add = [&](PacketSource source, const Spectrum& power) {
    if (!(power > 0).any()) return;
    sources.push_back(source);
    watts.insert(watts.end(), power.begin(), power.end());
  };
  for (std::size_t z = 0; z < mesh.zone_count(); ++z) {
    const ZoneId zone(z);
    if (!surfaces.emits(mesh.zone_triangle(zone), mesh.zone_is_front(zone))) continue;
    const SurfaceId surface = mesh.zone_surface(zone);
    add({zone, 0, static_cast<float>(surfaces.emission_exponent(surface))},
        mesh.zone_area(zone) * surfaces.exitance(surface));
  }
  for (std::size_t l = 0; l < scene.lights.size(); ++l)
    add({ZoneId(), static_cast<std::uint32_t>(l), 0},
        light_power(scene.lights[l], transport.rays().metres_per_unit()));
  return make_packet_sources(std::move(sources), watts, transport.channels());
}

}  // namespace reemit

#include "solver/shoot/packet_sources.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "solver/emit/punctual_emitter.h"

namespace reemit {
namespace {

/// Shares of the packets [1]: lamps, the first `lamps` sources, together and sky each have what their light
/// is worth (SkyLight::worth), neither less than kLeast; within them by power, and as the sky wants it.
std::vector<double> shares_with_sky(const PacketSources& emission, const std::vector<double>& watts,
                                    std::size_t lamps, std::size_t lights, const SkyLight& sky) {
  constexpr double kLeast = 0.1;
  const std::size_t bands = watts.size() / emission.sources.size();
  std::vector<double> shares;
  double of_lamps = 0;
  for (std::size_t s = 0; s < emission.sources.size(); ++s) {
    if (s < lamps) {
      shares.push_back(std::accumulate(&watts[s * bands], &watts[s * bands] + bands, 0.0));
      of_lamps += shares.back();
    } else {
      shares.push_back(sky.packet_share(emission.sources[s].light - lights));
    }
  }
  double to_lamps = 0;
  if (of_lamps > 0) {
    const double worth = of_lamps * sky.mean_need();
    to_lamps = std::clamp(worth / (worth + sky.worth()), kLeast, 1 - kLeast);
  }
  for (std::size_t s = 0; s < shares.size(); ++s) shares[s] *= s < lamps ? to_lamps / of_lamps : 1 - to_lamps;
  return shares;
}

}  // namespace

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
        mesh.zone_area(zone) * surfaces.exitance(zone, surface));
  }
  for (std::size_t l = 0; l < scene.lights.size(); ++l)
    add({ZoneId(), static_cast<std::uint32_t>(l), 0},
        light_power(scene.lights[l], transport.rays().metres_per_unit()));
  const std::size_t lamps = sources.size();
  const SkyLight* sky = transport.room().sky();
  if (sky != nullptr)
    for (std::size_t c = 0; c < sky->cell_count(); ++c)
      add({ZoneId(), static_cast<std::uint32_t>(scene.lights.size() + c), 0}, sky->power(c));
  PacketSources emission = make_packet_sources(std::move(sources), watts, transport.channels());
  if (sky != nullptr && emission.sources.size() > lamps)
    emission.packet_share = shares_with_sky(emission, watts, lamps, scene.lights.size(), *sky);
  return emission;
}

}  // namespace reemit

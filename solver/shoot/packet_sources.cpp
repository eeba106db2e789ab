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
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const TriangleId id(t);
    const BaseTriangle& triangle = mesh.triangle(id);
    if (!surfaces.emits(triangle.surface)) continue;
    const std::size_t per_side = std::size_t{triangle.divisions} * triangle.divisions;
    const Spectrum power =
        mesh.triangle_area(id) / static_cast<double>(per_side) * surfaces.exitance(triangle.surface);
    const auto exponent = static_cast<float>(surfaces.emission_exponent(triangle.surface));
    for (const bool front : {true, false}) {
      if (!surfaces.emits(id, front)) continue;
      const std::size_t first = mesh.first_zone(id, front).index();
      for (std::size_t z = 0; z < per_side; ++z) add({ZoneId(first + z), 0, exponent}, power);
    }
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

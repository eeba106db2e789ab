#include "solver/shoot/closed_room_check.h"

#include <algorithm>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "scenes/model/error.h"
#include "solver/shoot/flight.h"

namespace reemit {
namespace {

constexpr std::uint32_t kClosedRoomProbes = 4096;
constexpr std::uint32_t kMostProbeBounces = 64;

/// Follows light of one band from luminaires until it meets anything that takes some of it.
class WayOut {
 public:
  WayOut(const PacketRoom& transport, std::size_t band, std::uint64_t seed)
      : transport_(transport),
        band_(band),
        numbers_(SamplingKind::kSobol, seed, 0, 0),
        rng_(seed, RngPurpose::kClosedRoom),
        open_(transport.zones(), false) {}

  /// True if light of this source is absorbed or gets out; else surfaces() are those that it met.
  bool exists(const PacketSource& source) {
    if (source.zone.valid() && open_[source.zone.index()]) return true;
    Flight flight;
    flight.add(source, kClosedRoomProbes);
    flight.quanta.assign(transport_.channels().count(), 0);
    met_.clear();
    for (std::uint32_t first = 0; first < kClosedRoomProbes; first += 16)
      if (block_ends(flight, first)) {
        // Light goes both ways between zones: from each of those that it met it finds the same way out.
        for (const ZoneId zone : met_) open_[zone.index()] = true;
        if (source.zone.valid()) open_[source.zone.index()] = true;
        return true;
      }
    return false;
  }

  std::set<std::size_t> surfaces() const {
    std::set<std::size_t> surfaces;
    for (const ZoneId zone : met_) surfaces.insert(transport_.mesh().zone_surface(zone).index());
    return surfaces;
  }

 private:
  bool block_ends(const Flight& flight, std::uint32_t first) {
    Ray16 rays;
    Hit16 hits;
    ZoneLanes lanes{};
    UniformLanes numbers{};
    FlightCursor cursor(transport_, flight, first);
    std::vector<std::int64_t> power(16 * transport_.channels().count());
    cursor.start16(first, 16, numbers_, rays, power.data());
    for (std::uint32_t bounce = 0; bounce < kMostProbeBounces; ++bounce) {
      transport_.rays().closest16(rays, 16, hits);
      transport_.rays().look_again16(rays, 16, hits);
      for (int lane = 0; lane < 16; ++lane) {
        if (hits.triangle[lane] == RayTracer::kMiss) return true;
        const ZoneId zone =
            transport_.zone_of(hits.triangle[lane], hits.u[lane], hits.v[lane], hits.front[lane]);
        if (!zone.valid() || open_[zone.index()]) return true;
        const auto x = rng_.uniform4(first + static_cast<std::uint32_t>(lane), 0, bounce);
        ZoneId next = zone;
        if (takes_light(hits, lane, x[0] < 0.5F, next)) return true;
        met_.push_back(zone);
        for (std::size_t d = 0; d < 4; ++d) numbers.u[d][lane] = x[d];
        transport_.put_zone(next, lanes, lane, lane + 1);
      }
      transport_.start(lanes, numbers, rays);
    }
    return false;
  }

  /// Whether what a lane met keeps some of the light; else `next` is the zone that it goes on from, as if the
  /// surface scattered it: mirrors and glass send it elsewhere, but nothing that this light can reach is out
  /// of reach of that. `crosses` chooses between the two sides where light may go to either.
  bool takes_light(const Hit16& hits, int lane, bool crosses, ZoneId& next) {
    const SurfaceModel& surfaces = transport_.surface_model();
    const TriangleId t(hits.triangle[lane]);
    const double kept = surfaces.mean_reflectance(t, hits.front[lane])[band_];
    if (!surfaces.is_specular(t, hits.front[lane])) return kept < 1;
    if (surfaces.specular(t).is_rough()) return true;  // no lobe keeps all light
    SpecularStep at_normal(transport_.channels().bands());
    surfaces.specular(t).shares(1, hits.front[lane], at_normal);
    const auto mirrored = static_cast<double>(at_normal.reflected[band_]);
    const auto crossing =
        static_cast<double>(at_normal.transmitted[band_]) + static_cast<double>(at_normal.diffuse[band_]);
    constexpr double kRounding = 1e-6;
    if (surfaces.specular(t).absorbs_inside() || kept + mirrored + crossing < 1 - kRounding) return true;
    if (crossing > 0 && crosses)
      next = transport_.zone_of(hits.triangle[lane], hits.u[lane], hits.v[lane], !hits.front[lane]);
    return !next.valid();
  }

  const PacketRoom& transport_;
  std::size_t band_;
  FlightNumbers numbers_;
  CounterRng rng_;
  std::vector<bool> open_;
  std::vector<ZoneId> met_;
};

std::string name_of(const PacketSource& source, const PacketRoom& transport) {
  const Scene& scene = transport.scene();
  if (source.zone.valid()) return scene.surfaces[transport.mesh().zone_surface(source.zone).index()].name;
  if (source.light >= scene.lights.size()) return "sky";
  return std::visit([](const auto& light) { return light.name; }, scene.lights[source.light]);
}

/// "'floor', 'lid' and 4 more".
std::string list_of(const std::set<std::size_t>& surfaces, const Scene& scene) {
  constexpr std::size_t kMostNames = 6;
  std::string list;
  std::size_t named = 0;
  for (const std::size_t s : surfaces) {
    if (named == kMostNames) return list + " and " + std::to_string(surfaces.size() - named) + " more";
    list += (named++ == 0 ? "'" : ", '") + scene.surfaces[s].name + "'";
  }
  return list;
}

}  // namespace

void refuse_closed_perfect_reflector(const PacketRoom& transport, const PacketSources& emission,
                                     std::uint64_t seed) {
  const Scene& scene = transport.scene();
  emission.channels.for_each([&](std::size_t channel, std::size_t b) {
    bool any_perfect = false;
    for (std::size_t s = 0; s < transport.surfaces(); ++s)
      for (const bool front : {true, false})
        any_perfect = any_perfect || transport.surface_model().reflectance(SurfaceId(s), front)[b] >= 1;
    any_perfect = any_perfect || transport.surface_model().any_specular();
    if (!any_perfect) return;
    WayOut way_out(transport, b, seed);
    for (std::size_t s = 0; s < emission.sources.size(); ++s) {
      if (emission.quanta_of(s)[channel] == 0 || way_out.exists(emission.sources[s])) continue;
      throw InputError(
          scene.source,
          "the luminaire '" + name_of(emission.sources[s], transport) +
              "' shines into a sealed part of the room, and all that it meets reflects the light of band '" +
              scene.bands.name(b) + "' entirely (" + list_of(way_out.surfaces(), scene) +
              "): the radiosity there has no finite value",
          "Give at least one of these surfaces a reflectance below 1, or open the part.");
    }
  });
}

}  // namespace reemit

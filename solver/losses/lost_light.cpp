#include "solver/losses/lost_light.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <variant>

#include <fmt/format.h>

#include "solver/losses/dark_space.h"
#include "solver/losses/exit_place.h"
#include "solver/losses/probe_flight.h"

namespace reemit {
namespace {

constexpr double kLeastShareLost = 1e-5;      // of the emitted power; less is below any error target
constexpr double kClosedShare = 0.01;         // a room that loses less through openings counts as closed
constexpr double kMostlyClosedShare = 0.05;   // the same where most of the loss goes through gaps
constexpr double kAllButNothing = 1 - 1e-9;   // leaves a room whose luminaires look away from it
constexpr double kOutdoorShare = 0.3;         // a room that loses more from places outside is meant to
constexpr double kLuminaireBackShare = 0.01;  // on backs of one luminaire; less is no mistake
constexpr double kDarkShare = 0.5;            // of the space enclosed; walls and furniture have less in them
constexpr double kNarrow = 0.01;              // width of a gap, of the diagonal of the room
constexpr double kOnePlace = 0.05;  // distance within which losses are in one place, of the diagonal
constexpr std::uint32_t kProbes = 1U << 16;
constexpr std::size_t kMostLosses = 512;
constexpr std::size_t kMostPlaces = 3;

/// Probes with the power that each stands for [W].
struct ProbeSet {
  Flight flight;
  std::vector<double> watts;  // of one probe of a source
};

/// As luminaires send out their light, sky and directional ones excepted: theirs comes from outside.
ProbeSet emitted_probes(const PacketRoom& transport, const PacketSources& emission) {
  ProbeSet probes;
  probes.flight = plan_first_flight(emission, kProbes, 0.5);
  for (std::size_t s = 0; s < emission.sources.size(); ++s) {
    const PacketSource& source = emission.sources[s];
    const bool outside = !source.zone.valid() && transport.is_from_outside(source.light);
    const double power = outside ? 0 : emission.watts_of(s);
    probes.watts.push_back(power / (probes.flight.first_packet[s + 1] - probes.flight.first_packet[s]));
  }
  return probes;
}

/// As zones reflect what the solution says they catch.
ProbeSet reflected_probes(const Solution& solution) {
  const ZoneMesh& mesh = solution.mesh;
  const std::size_t bands = solution.bands.count();
  std::vector<double> power(mesh.zone_count());
  for (std::size_t z = 0; z < power.size(); ++z) {
    for (std::size_t b = 0; b < bands; ++b)
      power[z] += solution.zone_reflectance(ZoneId(z), b) * solution.irradiance(ZoneId(z), b).mean;
    power[z] *= mesh.zone_area(ZoneId(z));
  }
  const double total = std::accumulate(power.begin(), power.end(), 0.0);
  ProbeSet probes;
  if (!(total > 0)) return probes;
  double running = 0;
  double before = 0;
  for (std::size_t z = 0; z < power.size(); ++z) {
    running += power[z];
    const double upto = std::floor(running / total * kProbes + 0.5);
    if (upto > before) {
      probes.flight.add({ZoneId(z), 0, 0}, static_cast<std::uint32_t>(upto - before));
      probes.watts.push_back(total / kProbes);
    }
    before = upto;
  }
  probes.flight.quanta.assign(probes.watts.size() * solution.sums.channels.count(), 0);
  return probes;
}

/// Shows every probe with its power [W] and the surface it left; no surface for lights without area.
template <class Visit>
void visit_probes(const PacketRoom& transport, const PacketSources& emission, const Solution& solution,
                  const StopToken* stop, const Visit& visit) {
  std::uint32_t stream = 1;
  for (const ProbeSet& probes : {emitted_probes(transport, emission), reflected_probes(solution)}) {
    const auto visit_one = [&](const ProbeRay& probe) {
      const ZoneId zone = probes.flight.sources[probe.source].zone;
      const double watts = probes.watts[probe.source];
      if (watts > 0) visit(probe, watts, zone.valid() ? transport.mesh().zone_surface(zone) : SurfaceId());
    };
    trace_probes(transport, probes.flight, stream++, visit_one, stop);
  }
}

/// Something lost, before those in one place are put together.
struct Loss {
  double watts = 0;
  Vec3 place{0, 0, 0};
  double width = 0;
  LightLoss::Way way = LightLoss::Way::kGap;
  std::vector<SurfaceId> surfaces;
};

/// The surfaces that most of the power has to do with, two at most.
std::vector<SurfaceId> main_surfaces(const std::map<SurfaceId, double>& watts) {
  std::vector<SurfaceId> order;
  for (const auto& [surface, power] : watts) order.push_back(surface);
  std::stable_sort(order.begin(), order.end(),
                   [&](SurfaceId a, SurfaceId b) { return watts.at(a) > watts.at(b); });
  if (order.size() > 2) order.resize(2);
  return order;
}

/// Of very many every n-th, which stands for all.
template <class T>
void thin_out(std::vector<T>& losses) {
  const std::size_t stride = 1 + losses.size() / kMostLosses;
  std::vector<T> kept;
  for (std::size_t i = 0; i < losses.size(); i += stride) {
    kept.push_back(std::move(losses[i]));
    kept.back().watts *= static_cast<double>(stride);
  }
  losses = std::move(kept);
}

std::vector<LightLoss> places_of(std::vector<Loss> losses, double distance, double emitted) {
  std::vector<LightLoss> places;
  while (!losses.empty()) {
    const Loss first = losses.front();
    const auto apart = [&](const Loss& l) {
      return l.way != first.way || (l.place - first.place).norm() > distance;
    };
    const auto rest = std::stable_partition(losses.begin(), losses.end(), apart);
    LightLoss place{first.way, 0, 0, Vec3::Zero(), {}};
    double watts = 0;
    std::map<SurfaceId, double> surfaces;
    for (auto l = rest; l != losses.end(); ++l) {
      watts += l->watts;
      place.place += l->watts * l->place;
      place.width = std::max(place.width, l->width);
      for (const SurfaceId s : l->surfaces) surfaces[s] += l->watts;
    }
    place.place /= watts;
    place.share = watts / emitted;
    place.surfaces = main_surfaces(surfaces);
    places.push_back(std::move(place));
    losses.erase(rest, losses.end());
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const LightLoss& a, const LightLoss& b) { return a.share > b.share; });
  return places;
}

std::string names_of(const std::vector<SurfaceId>& surfaces, const Scene& scene) {
  std::string text;
  for (const SurfaceId s : surfaces) text += (text.empty() ? "" : " and ") + quoted_name(scene, s);
  return text;
}

/// `lost`: the sum over all places.
std::string text_of(const LightLoss& loss, double lost, const Scene& scene) {
  std::string text = fmt::format("near {} m", place_text(loss.place));
  const std::string names = names_of(loss.surfaces, scene);
  if (loss.way == LightLoss::Way::kGap)
    text += fmt::format(" through a gap of about {:.1g} m{}{}", loss.width, names.empty() ? "" : " beside ",
                        names);
  else if (!names.empty())
    text += fmt::format("{} from {}{}", loss.way == LightLoss::Way::kOutside ? " outside" : "", names,
                        scene.material_of(scene.surfaces[loss.surfaces[0].index()]).emits()
                            ? ", a luminaire (does it lie in a face, or behind one?)"
                            : "");
  return text + fmt::format(" ({} of that)", share_text(loss.share / lost));
}

double room_diagonal(const Scene& scene) {
  return bounds(scene).size().norm();
}

/// Whether light may leave a room whose faces close as it should.
bool has_windows(const PacketRoom& transport) {
  const SurfaceModel& surfaces = transport.surface_model();
  const std::vector<Material>& materials = transport.scene().materials;
  return surfaces.any_transmits() || surfaces.any_cut_outs() ||
         std::any_of(materials.begin(), materials.end(),
                     [](const Material& m) { return m.non_diffuse.transmits_diffusely(); });
}

bool is_lit_from_outside(const Scene& scene) {
  if (scene.sky) return true;
  return std::any_of(scene.lights.begin(), scene.lights.end(),
                     [](const PunctualLight& l) { return is_at_infinity(l); });
}

/// True if it had reason to.
bool warn_of_the_dark(const PacketRoom& transport, const Solution& solution, const StopToken* stop,
                      std::vector<std::string>& warnings) {
  const Scene& scene = transport.scene();
  if (solution.record.cut_off) return false;  // what it leaves dark may be lit by what it has not shot
  const bool from_outside = is_lit_from_outside(scene);
  const DarkSpace dark = find_dark_space(transport, solution, stop);
  if (!(dark.share > kDarkShare)) return false;
  // Houses seen from outside are dark inside.
  if (from_outside && !scene.cameras.empty() && !dark.is_looked_at) return false;
  std::string text = fmt::format("no light gets into {} of the space that surfaces enclose; dark are",
                                 share_text(dark.share));
  for (std::size_t i = 0; i < std::min(kMostPlaces, dark.faces.size()); ++i) {
    const DarkSpace::Face& face = dark.faces[i];
    text += fmt::format("{} {} ({}{:.3g} m2)", i == 0 ? "" : ",", quoted_name(scene, face.surface),
                        face.front ? "" : "back, ", face.area);
  }
  if (dark.faces.size() > kMostPlaces) text += fmt::format(" and {} more", dark.faces.size() - kMostPlaces);
  if (from_outside)
    text +=
        "; is a window opaque that should let daylight in? Give it a material of glass, or one that "
        "transmits, or leave it out";
  else
    text +=
        "; is a luminaire outside the room, shut in or turned away? Move or turn it so that it shines into "
        "the room";
  warnings.push_back(text);
  return true;
}

void warn_of_escapes(const PacketRoom& transport, const PacketSources& emission, const Solution& solution,
                     const StopToken* stop, std::vector<std::string>& warnings) {
  const EnergyAudit& audit = solution.audit;
  double escaped = 0;
  for (const BandAudit& band : audit.bands) escaped += audit.watts(band, band.total_escaped());
  double share = escaped / audit.emitted_watts();
  if (share > kAllButNothing) {
    warnings.emplace_back(
        "no light meets a surface, all of it leaves the room: do its luminaires look away from it? "
        "Turn their faces, or solve with --two-sided");
    return;
  }
  if (!(share > kLeastShareLost)) return;
  const EscapedLight found = find_escapes(transport, emission, solution, stop);
  // The books do not know what went out through windows.
  if (has_windows(transport)) share = found.share;
  if (!(share > kLeastShareLost)) return;
  const bool by_gaps = 2 * found.through_gaps > share && found.through_openings < kMostlyClosedShare;
  const bool closed = found.through_openings < kClosedShare && share < kOutdoorShare &&
                      !is_lit_from_outside(transport.scene());
  if (!by_gaps && !closed) return;
  std::string text =
      fmt::format("{} of the light leaves the room, whose faces nearly close", share_text(share));
  // Probes find places, but know the share less well than the books do.
  double lost = 0;
  for (const LightLoss& place : found.places) lost += place.share;
  for (std::size_t i = 0; i < std::min(kMostPlaces, found.places.size()); ++i)
    text += (i == 0 ? ": " : "; ") + text_of(found.places[i], lost, transport.scene());
  if (found.places.size() > kMostPlaces)
    text += fmt::format("; and {} more place(s)", found.places.size() - kMostPlaces);
  warnings.push_back(text);
}

void warn_of_backs(const PacketRoom& transport, const PacketSources& emission, const Solution& solution,
                   const StopToken* stop, std::vector<std::string>& warnings) {
  const Scene& scene = transport.scene();
  const EnergyAudit& audit = solution.audit;
  std::vector<double> watts(scene.surfaces.size(), 0.0);
  for (const BandAudit& band : audit.bands)
    for (std::size_t s = 0; s < watts.size(); ++s) watts[s] += audit.watts(band, band.absorbed_on_backs[s]);
  const double emitted = audit.emitted_watts();
  // The back of a lamp is dark, and a little light gets there.
  for (std::size_t s = 0; s < watts.size(); ++s)
    if (watts[s] < kLuminaireBackShare * emitted && scene.material_of(scene.surfaces[s]).emits())
      watts[s] = 0;
  const double lost = std::accumulate(watts.begin(), watts.end(), 0.0);
  if (!(lost > kLeastShareLost * emitted) || is_lit_from_outside(scene)) return;
  std::vector<std::size_t> order(watts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return watts[a] > watts[b]; });
  if (order.size() > kMostPlaces) order.resize(kMostPlaces);

  std::vector<std::vector<Loss>> hits(order.size());
  visit_probes(transport, emission, solution, stop, [&](const ProbeRay& probe, double power, SurfaceId from) {
    if (!probe.met || !is_back(transport, probe.hit)) return;
    const auto at =
        std::find(order.begin(), order.end(), transport.mesh().triangle(probe.hit.triangle).surface.index());
    if (at == order.end()) return;
    Loss loss{power,
              transport.rays().in_room(probe.origin + probe.hit.distance * probe.direction),
              0,
              LightLoss::Way::kOpening,
              {}};
    if (from.valid()) loss.surfaces.push_back(from);
    hits[static_cast<std::size_t>(at - order.begin())].push_back(std::move(loss));
  });
  std::string text = fmt::format("{} of the light ends on backs of one-sided faces, which absorb it",
                                 share_text(lost / emitted));
  bool from_faces = false;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double share = watts[order[i]] / emitted;
    if (!(share > 0)) continue;
    text += fmt::format("{} {} ({})", i == 0 ? ":" : ",", quoted_name(scene, SurfaceId(order[i])),
                        share_text(share));
    thin_out(hits[i]);
    const std::vector<LightLoss> places =
        places_of(std::move(hits[i]), kOnePlace * room_diagonal(scene), emitted);
    if (places.empty()) continue;
    text += fmt::format(" near {} m", place_text(places[0].place));
    const std::string from = names_of(places[0].surfaces, scene);
    if (from.empty()) continue;  // from a light without area, which has a warning of its own
    text += " from " + from;
    from_faces = true;
  }
  if (from_faces) text += "; turn the faces round, or solve with --two-sided";
  warnings.push_back(text);
}

}  // namespace

EscapedLight find_escapes(const PacketRoom& transport, const PacketSources& emission,
                          const Solution& solution, const StopToken* stop) {
  struct Escape {
    Vec3f origin, direction;
    double watts;
    SurfaceId from;
  };
  std::optional<RayTracer> without_holes;
  if (transport.surface_model().any_cut_outs()) without_holes.emplace(transport.mesh());
  const RayTracer& rays = without_holes ? *without_holes : transport.rays();
  std::vector<Escape> escapes;
  visit_probes(transport, emission, solution, stop, [&](const ProbeRay& probe, double watts, SurfaceId from) {
    if (!probe.met && (!without_holes || rays.escapes(probe.origin, probe.direction)))
      escapes.push_back({probe.origin, probe.direction, watts, from});
  });
  const double diagonal = room_diagonal(transport.scene());
  const double emitted = solution.audit.emitted_watts();
  thin_out(escapes);
  EscapedLight found;
  std::vector<Loss> losses;
  for (const Escape& escape : escapes) {
    end_if_requested(stop);
    const ExitPlace exit = find_exit(rays, escape.origin, escape.direction);
    Loss loss{escape.watts, exit.point, exit.width, LightLoss::Way::kGap, {}};
    found.share += loss.watts / emitted;
    if (exit.found && exit.width < kNarrow * diagonal) {
      loss.surfaces.assign(exit.surfaces.begin(), exit.surfaces.end());
      found.through_gaps += loss.watts / emitted;
    } else {
      const bool outside = is_outside(rays, escape.origin, escape.direction);
      loss.way = outside ? LightLoss::Way::kOutside : LightLoss::Way::kOpening;
      loss.place = rays.in_room(escape.origin);
      if (escape.from.valid()) loss.surfaces.push_back(escape.from);
      if (!outside) found.through_openings += loss.watts / emitted;
    }
    losses.push_back(std::move(loss));
  }
  found.places = places_of(std::move(losses), kOnePlace * diagonal, emitted);
  return found;
}

std::vector<std::string> lost_light_warnings(const PacketRoom& transport, const PacketSources& emission,
                                             const Solution& solution, const StopToken* stop) {
  end_if_requested(stop);
  std::vector<std::string> warnings;
  if (!(solution.audit.emitted_watts() > 0)) return warnings;
  // What goes astray outside of a dark room is not what its faces lose.
  if (!warn_of_the_dark(transport, solution, stop, warnings))
    warn_of_escapes(transport, emission, solution, stop, warnings);
  warn_of_backs(transport, emission, solution, stop, warnings);
  return warnings;
}

}  // namespace reemit

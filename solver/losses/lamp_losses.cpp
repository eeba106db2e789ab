#include "solver/losses/lamp_losses.h"

#include <algorithm>
#include <map>

#include "mesh/geometry/disjoint_sets.h"
#include "solver/losses/probe_flight.h"

namespace reemit {
namespace {

constexpr double kLeastKept = 0.25;
constexpr double kLeastOutside = 0.05;
constexpr double kMostBetween = 0.2;
/// Packets of a zone that say whether it sees nothing, or hardly anything, but the open.
constexpr std::uint32_t kPacketsToJudgeBy = 8;
constexpr double kMostlyMet = 0.8;
constexpr double kSmallerThanRoom = 0.9;  // diagonals

Box box_of(const Surface& surface) {
  Scene alone;
  alone.surfaces.push_back(surface);
  return bounds(alone);
}

/// What a surface does not let through, as a share of what it meets [0,1]: the mean over the bands.
double kept_by(const Material& material) {
  double kept = 1;
  for (const Spectrum* through :
       {&material.non_diffuse.diffuse_transmittance, &material.non_diffuse.specular_transmittance})
    if (through->size() > 0) kept -= through->mean();
  return std::max(0.0, kept);
}

/// Luminous surfaces as lamps: those of one material whose boxes touch belong together. A lamp is known by
/// its first surface.
class LampGroups {
 public:
  LampGroups(const Scene& scene, const std::vector<bool>& emits, const StopToken* stop)
      : sets_(scene.surfaces.size()) {
    const Vec3 slack = Vec3::Constant(1e-6 * bounds(scene).size().norm());
    std::vector<Box> boxes;
    for (std::size_t s = 0; s < emits.size(); ++s) {
      if (!emits[s]) continue;
      end_if_requested(stop);
      const Box box = box_of(scene.surfaces[s]);
      for (std::size_t k = 0; k < luminous_.size(); ++k) {
        const bool touch = ((box.min - slack - boxes[k].max).array() <= 0).all() &&
                           ((boxes[k].min - slack - box.max).array() <= 0).all();
        if (touch && scene.surfaces[s].material == scene.surfaces[luminous_[k]].material)
          sets_.join(s, luminous_[k]);
      }
      luminous_.push_back(s);
      boxes.push_back(box);
    }
    for (std::size_t k = 0; k < luminous_.size(); ++k) {
      Box& extent = extents_.try_emplace(of(luminous_[k]), boxes[k]).first->second;
      extent.min = extent.min.cwiseMin(boxes[k].min);
      extent.max = extent.max.cwiseMax(boxes[k].max);
    }
  }

  std::size_t of(std::size_t surface) { return sets_.find(surface); }
  const std::map<std::size_t, Box>& extents() const { return extents_; }
  std::vector<SurfaceId> surfaces_of(std::size_t lamp) {
    std::vector<SurfaceId> surfaces;
    for (const std::size_t s : luminous_)
      if (of(s) == lamp) surfaces.emplace_back(s);
    return surfaces;
  }

 private:
  DisjointSets sets_;
  std::vector<std::size_t> luminous_;
  std::map<std::size_t, Box> extents_;
};

}  // namespace

std::vector<LampLoss> lamp_losses(const PacketRoom& transport, const PacketSources& emission,
                                  const StopToken* stop) {
  const Scene& scene = transport.scene();
  const ZoneMesh& mesh = transport.mesh();
  PacketSources surfaces(emission.channels);  // without the lights that have no area
  std::vector<double> watts;
  std::vector<bool> emits(scene.surfaces.size(), false);
  for (std::size_t s = 0; s < emission.sources.size(); ++s) {
    if (!emission.sources[s].zone.valid()) continue;
    surfaces.sources.push_back(emission.sources[s]);
    const auto quanta = emission.quanta_of(s);
    surfaces.quanta.insert(surfaces.quanta.end(), quanta.begin(), quanta.end());
    watts.push_back(emission.watts_of(s));
    emits[mesh.zone_surface(emission.sources[s].zone).index()] = true;
  }
  LampGroups lamps(scene, emits, stop);
  if (lamps.extents().empty()) return {};
  const auto packets = static_cast<std::uint32_t>(std::clamp<std::size_t>(
      std::max(1024 * lamps.extents().size(), 2 * kPacketsToJudgeBy * surfaces.sources.size()), 4096, 65536));
  const Flight flight = plan_first_flight(surfaces, packets, 0.5);
  std::map<std::size_t, double> sent;
  std::map<std::size_t, double> kept;
  std::vector<std::uint32_t> met(surfaces.sources.size(), 0);  // packets
  const auto visit = [&](const ProbeRay& probe) {
    const std::size_t lamp = lamps.of(mesh.zone_surface(flight.sources[probe.source].zone).index());
    const double power = watts[probe.source] / static_cast<double>(flight.first_packet[probe.source + 1] -
                                                                   flight.first_packet[probe.source]);
    sent[lamp] += power;
    if (!probe.met) return;
    ++met[probe.source];
    const std::size_t to = mesh.surface(probe.hit.triangle, probe.hit.front).index();
    if (emits[to] && lamps.of(to) == lamp)
      kept[lamp] += power * kept_by(scene.materials[scene.surfaces[to].material.index()]);
  };
  trace_probes(transport, flight, 0, visit, stop);
  std::map<std::size_t, double> outside, inside;
  for (std::size_t z = 0; z < surfaces.sources.size(); ++z) {
    const std::uint32_t of_zone = flight.first_packet[z + 1] - flight.first_packet[z];
    const std::size_t lamp = lamps.of(mesh.zone_surface(flight.sources[z].zone).index());
    if (of_zone >= kPacketsToJudgeBy && met[z] == 0) outside[lamp] += watts[z];
    if (of_zone >= kPacketsToJudgeBy && met[z] >= kMostlyMet * of_zone) inside[lamp] += watts[z];
  }
  const double room = bounds(scene).size().norm();
  std::vector<LampLoss> found;
  for (const auto& [lamp, box] : lamps.extents()) {
    LampLoss loss{{}, kept[lamp] / sent[lamp], outside[lamp] / sent[lamp]};
    const bool is_smaller = box.size().norm() < kSmallerThanRoom * room;
    loss.shines_onto_itself = is_smaller && loss.onto_itself > kLeastKept;
    loss.stands_across = loss.outside > kLeastOutside && inside[lamp] > kLeastOutside * sent[lamp] &&
                         outside[lamp] + inside[lamp] > (1 - kMostBetween) * sent[lamp];
    if (!loss.shines_onto_itself && !loss.stands_across) continue;
    loss.surfaces = lamps.surfaces_of(lamp);
    found.push_back(std::move(loss));
  }
  return found;
}

}  // namespace reemit

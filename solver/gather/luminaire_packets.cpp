#include "solver/gather/luminaire_packets.h"

#include <algorithm>
#include <numeric>

#include <tbb/task_arena.h>

#include "mesh/zones/surface_side.h"
#include "scenes/model/stop_token.h"
#include "solver/shoot/packet_batch.h"

namespace reemit {
namespace {

constexpr std::uint64_t kLuminaireBatch = std::uint64_t{1} << 22;

double direct_irradiance_of(const Solution& solution, ZoneId zone) {
  double sum = 0;
  for (std::size_t b = 0; b < solution.bands.count(); ++b) sum += solution.direct_irradiance(zone, b).mean;
  return sum;
}

/// Of packets of weights w.
struct WeightSums {
  double weights = 0;
  double squares = 0;

  void add(const WeightSums& more) {
    weights += more.weights;
    squares += more.squares;
  }
  /// sum w^2 / sum w; `of_none` if none came.
  double mean_weight(double of_none) const { return weights > 0 ? squares / weights : of_none; }
};

/// The same sources, each with its power times that of one of `packets` packets [W2].
PacketSources weighted_by_packets(const PacketSources& emission, double packets) {
  const Channels channels = emission.channels;
  std::vector<double> watts;
  for (std::size_t s = 0; s < emission.sources.size(); ++s) {
    const double of_packet = emission.watts_of(s) / (emission.packet_share[s] * packets);
    for (std::size_t c = 0; c < channels.count(); ++c)
      watts.push_back(static_cast<double>(emission.quanta_of(s)[c]) * emission.watts_per_quantum[c] *
                      of_packet);
  }
  PacketSources result = make_packet_sources(emission.sources, watts, channels);
  result.packet_share = emission.packet_share;
  return result;
}

}  // namespace

bool LuminairePackets::are_shot_for(const Solution& solution) {
  const SolverSettings& settings = solution.settings;
  return settings.method == SolveMethod::kShooting && settings.direct == DirectSource::kBest;
}

LuminairePackets::LuminairePackets(const Room& room, const Solution& solution,
                                   const std::atomic<bool>& interrupt)
    : solution_(solution),
      mean_watts_(solution.audit.emitted_watts() / static_cast<double>(solution.record.packets)) {
  if (!are_shot_for(solution))
    for (std::size_t z = 0; z < solution.mesh.zone_count(); ++z)
      irradiance_.push_back(direct_irradiance_of(solution, ZoneId(z)));
  const bool may_be_unlike = room.sky() != nullptr;
  if (!are_shot_for(solution) && !may_be_unlike) return;
  tbb::task_arena().execute([&] {
    const PacketRoom transport(room, Channels(solution.bands.count()));
    const PacketSources emission = collect_packet_sources(transport);
    if (are_shot_for(solution)) irradiance_ = shoot(transport, emission, interrupt);
    if (!emission.packet_share.empty()) weigh(transport, emission, interrupt);
  });
}

std::vector<double> LuminairePackets::shoot(const PacketRoom& transport, const PacketSources& emission,
                                            const std::atomic<bool>& interrupt) const {
  const StopToken stop(interrupt);
  const std::uint64_t wanted = solution_.record.packets;
  const std::uint64_t batches = (wanted + kLuminaireBatch - 1) / kLuminaireBatch;
  const std::size_t bands = emission.channels.count();
  std::vector<double> irradiance(transport.zones(), 0.0);
  BatchBooks books = transport.new_books();
  for (std::uint64_t k = 0; k < batches && !interrupt; ++k) {
    books.clear();
    shoot_first_flight({transport, emission, solution_.settings, static_cast<std::uint32_t>(k),
                        static_cast<std::uint32_t>(wanted / batches), &stop},
                       books);
    for (std::size_t z = 0; z < irradiance.size(); ++z)
      for (std::size_t b = 0; b < bands; ++b)
        irradiance[z] += static_cast<double>(books.direct[z * bands + b]) * emission.watts_per_quantum[b] /
                         (solution_.mesh.zone_area(ZoneId(z)) * static_cast<double>(batches));
  }
  return irradiance;
}

void LuminairePackets::weigh(const PacketRoom& transport, const PacketSources& emission,
                             const std::atomic<bool>& interrupt) {
  const ZoneMesh& mesh = solution_.mesh;
  const PacketSources weighted = weighted_by_packets(emission, static_cast<double>(solution_.record.packets));
  const std::vector<double> squares = shoot(transport, weighted, interrupt);
  const std::vector<double> powers =
      are_shot_for(solution_) ? irradiance_ : shoot(transport, emission, interrupt);
  const std::size_t surfaces = solution_.surface_names.size();
  std::vector<WeightSums> of_side(2 * surfaces);
  std::vector<WeightSums> of_surface(surfaces);
  const auto side_of = [&](ZoneId z) { return surface_side(mesh, mesh.zone_side(z)); };
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const ZoneId z(i);
    const WeightSums sums{mesh.zone_area(z) * powers[i], mesh.zone_area(z) * squares[i]};
    of_side[side_of(z)].add(sums);
    of_surface[mesh.zone_surface(z).index()].add(sums);
  }
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const double of_others = of_side[side_of(ZoneId(i))].mean_weight(mean_watts_);
    of_zone_.push_back(std::max(of_others, WeightSums{powers[i], squares[i]}.mean_weight(of_others)));
  }
  largest_sky_irradiance_ = *std::max_element(powers.begin(), powers.end());
  for (const WeightSums& sums : of_surface) of_surface_.push_back(sums.mean_weight(mean_watts_));
}

double LuminairePackets::irradiance(ZoneId zone) const {
  return irradiance_[zone.index()];
}

double LuminairePackets::watts_per_packet(ZoneId zone) const {
  return of_zone_.empty() ? mean_watts_ : of_zone_[zone.index()];
}

double LuminairePackets::watts_per_packet(SurfaceId surface) const {
  return of_surface_.empty() ? mean_watts_ : of_surface_[surface.index()];
}

}  // namespace reemit

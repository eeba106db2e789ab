#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "solver/gather/direct_light.h"
#include "solver/gather/point_sampler.h"
#include "solver/room/room.h"
#include "solver/shoot/packet_room.h"
#include "solver/shoot/packet_sources.h"
#include "solver/solution/solver_settings.h"
#include "solver/tally/batch_books.h"

namespace reemit {

/// Direct light of zones by shadow rays from points of them, in the place of what the packets of luminaires
/// brought. Where few luminaires light much of a room, a shadow ray says as much about the direct light of a
/// zone as several packets do, so that packets can be spent on the light that is reflected. Whether it does
/// in this room, a first look at some of its zones tells. How many shadow rays a zone gets follows from a
/// pilot that looks at all of them, before the first batch that is large enough for it. Both have random
/// numbers of their own: what they find biases nothing.
class SampledDirectLight {
 public:
  /// BatchTask::first_together of a batch whose direct light is sampled. Its first flight only fills the
  /// books and says where light is reflected from, and few packets do that: 4, 8 and 16 end within a tenth of
  /// the same time.
  static constexpr std::uint32_t kFirstTogether = 8;

  /// Takes the first look. `watts`: power of all luminaires and bands together. `unit_packets`: packets of a
  /// batch of weight 1 (BatchPlan), over whose noise that of shadow rays is weighed. The room must outlive
  /// it.
  SampledDirectLight(const Room& room, std::uint64_t seed, double watts, std::uint32_t unit_packets);

  /// Variance of direct light times the work for it, by packets over that by shadow rays, as the first look
  /// foresees; 0 where it met no light.
  double gain() const { return gain_; }
  /// Whether shadow rays are clearly the better way in this room.
  bool pays() const { return gain_ > kLeastGain; }

  /// Whether a batch of this weight is large enough for a shadow ray from every lit zone. Smaller ones, as
  /// large rooms begin with, are those of packets alone.
  bool is_for(std::int64_t weight) const {
    return pays() && weight * std::int64_t{unit_packets_} >= kPacketsPerZone * lit_zones_;
  }

  /// The pilot. Pre: pays().
  void look_at_all();
  bool has_looked_at_all() const { return !samples_.empty(); }
  /// Whether it would leave nothing out: of the direct light that packets brought, nearly all fell on zones
  /// that the pilot found lit, and as much as it found there, as far as their number can tell. Beams that
  /// miss the points of the pilot are left to packets, which are few then. Pre: has_looked_at_all().
  bool finds_what_packets_find(const std::vector<double>& watts_per_quantum, const BatchBooks& books) const;

  /// Replaces books.direct of the zones that the pilot found lit by an estimate that is independent of those
  /// of all other batches. Where packets lost no light on their way, the sum over the zones is kept. Zones
  /// that it did not see any light from keep what packets brought. Returns how many shadow rays were sent.
  /// Pre: is_for(weight), has_looked_at_all().
  std::uint64_t put(std::uint32_t batch, std::int64_t weight, const std::vector<double>& watts_per_quantum,
                    BatchBooks& books) const;

 private:
  /// Below it the foreseen gain was a loss in one room of four; from it on variance at equal time fell by a
  /// quarter at least (docs/performance.md).
  static constexpr double kLeastGain = 2;
  static constexpr std::int64_t kPacketsPerZone = 2;

  /// What the pilot found on one zone.
  struct Look {
    bool lit = false;
    double irradiance = 0;  // all bands together [W/m2]
    double mean = 0;        // of radiosity, dark zones taken as lighter ones, all bands together [W/m2]
    double sigma = 0;       // of one sample of it
  };
  Look look(ZoneId zone, float* weights) const;
  /// By band, at least as much as what counts for one that is dark.
  std::vector<double> reflectance(ZoneId zone) const;
  void plan_samples(const std::vector<Look>& looks, double per_unit);
  /// sqrt(area) sigma: the numbers of samples that leave the least error go by it.
  double need(ZoneId zone, const Look& look) const;
  /// By zone, of those of a batch: its samples are those up to the first one of the next zone.
  std::vector<int> first_samples(std::int64_t weight) const;
  void scale(double factor, std::size_t band, BatchBooks& books) const;
  void add_samples(ZoneId zone, const PointSampler& sampler, int first, int count, float* sum) const;

  const Room* room_;
  DirectLight light_;
  std::uint64_t seed_;
  double watts_;
  std::uint32_t unit_packets_;
  std::size_t bands_;
  std::size_t weighed_;  // luminaires that are weighed once for a zone; 0: anew for every sample
  double gain_ = 0;
  double cost_ = 1;             // of a shadow ray, in rays of packets
  std::int64_t lit_zones_ = 0;  // as the first look tells
  double lit_watts_ = 0;        // on those that the pilot found lit
  std::vector<float> samples_;  // by zone, in a batch of weight 1; 0: left to packets
  std::vector<float> weights_;  // by zone and luminaire
};

/// That of a run with these settings, after its first look. None where packets are to find all light, or find
/// it as well: where luminaires are many or hidden. Nor in rooms with light groups, which shadow rays do not
/// tell apart; with mirrors, glass or gloss, whose caustics take as many packets as direct light; with
/// cut-outs, whose zones have points that are not there; and with more than half a million zones. Must run
/// inside the task arena of the caller.
std::optional<SampledDirectLight> sampled_direct_light(const PacketRoom& transport,
                                                       const PacketSources& emission,
                                                       const SolverSettings& settings,
                                                       std::uint32_t unit_packets);

/// Looks at all zones, and at what `unit_packets` packets find. False where these find what shadow rays do
/// not: where beams are narrow. Must run inside the task arena of the caller.
bool prepare(const PacketRoom& transport, const PacketSources& emission, const SolverSettings& settings,
             std::uint32_t unit_packets, SampledDirectLight& direct);

}  // namespace reemit

#include "solver/gather/sampled_direct_light.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "solver/gather/replicate_gather.h"
#include "solver/sampling/counter_rng.h"
#include "solver/shoot/packet_batch.h"

namespace reemit {
namespace {

/// Points of a zone that the pilot looks from.
constexpr int kPilotPoints = 16;
/// Zones of the first look.
constexpr std::size_t kFirstZones = 1024;
/// Rooms of more zones are left to packets: the pilot, which nothing interrupts, takes a second or two here.
constexpr std::size_t kMostZones = std::size_t{1} << 19;
/// Least standard deviation of a sample over its mean: a few points do not show all there is to see.
constexpr double kLeastSpread = 0.2;
/// Dark surfaces are looked at as if they reflected so much: nobody lives from their light, but their
/// illuminance is asked for.
constexpr double kLeastReflectance = 0.2;
/// Variance of the low-discrepancy packets that a zone meets over that of so many at random.
constexpr double kPacketVariance = 0.6;
/// So that samples_ of a lit zone is not 0.
constexpr float kLeastSamples = 1e-6F;
/// Of a zone in one batch, and of a batch: fewer than the packets in the place of which they are.
constexpr long kMostSamples = 1L << 20;
constexpr int kLog2Samples = 31;
/// Luminaires are weighed once for a zone up to so many weights.
constexpr std::size_t kMostWeights = std::size_t{1} << 22;
/// Direct light that may fall on zones where the pilot found none, as a share: their noise counts several
/// times as much.
constexpr double kMostLeftOut = 0.02;
/// What pilot and packets may differ by, both being noisy.
constexpr double kMostDifference = 0.05;
/// Where lit surfaces are small or far, few packets meet any: standard errors of their light, and packets on
/// other zones, that say nothing against the pilot.
constexpr double kMostErrors = 3;
constexpr double kMostPacketsLeftOut = 3;
/// Work of a shadow ray, and of weighing a luminaire for it, in rays of packets.
constexpr double kShadowRayCost = 2.5;
constexpr double kWeighingCost = 0.5;
/// The pilot's replicate and batch; batches have smaller numbers.
constexpr std::uint32_t kPilot = 0xffffffff;
constexpr std::size_t kSampledPerTask = 64;

template <class Visit>
void for_zones(std::size_t count, const Visit& visit) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kSampledPerTask), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) visit(i);
  });
}

}  // namespace

SampledDirectLight::SampledDirectLight(const Room& room, std::uint64_t seed, double watts,
                                       std::uint32_t unit_packets)
    : room_(&room),
      light_(room),
      seed_(seed),
      watts_(watts),
      unit_packets_(unit_packets),
      bands_(room.band_count()) {
  const std::size_t zones = room.mesh().zone_count();
  weighed_ = light_.is_weighed_by_point() && zones * light_.luminaires_weighed() <= kMostWeights
                 ? light_.luminaires_weighed()
                 : 0;
  cost_ =
      kShadowRayCost + (weighed_ > 0 ? 0 : kWeighingCost * static_cast<double>(light_.luminaires_weighed()));
  const std::size_t stride = std::max<std::size_t>(1, zones / kFirstZones);
  const std::size_t first = (zones + stride - 1) / stride;
  std::vector<Look> looks(first);
  for_zones(first, [&](std::size_t i) { looks[i] = look(ZoneId(i * stride), nullptr); });
  double needs = 0;
  double by_packets = 0;
  for (std::size_t i = 0; i < first; ++i) {
    const ZoneId z(i * stride);
    const std::vector<double> rho = reflectance(z);
    needs += need(z, looks[i]);
    if (looks[i].lit) lit_zones_ += static_cast<std::int64_t>(stride);
    by_packets += looks[i].mean * *std::max_element(rho.begin(), rho.end());
  }
  if (needs > 0)
    gain_ = kPacketVariance * watts * by_packets / (cost_ * needs * needs * static_cast<double>(stride));
}

void SampledDirectLight::look_at_all() {
  const std::size_t zones = room_->mesh().zone_count();
  weights_.resize(zones * weighed_);
  std::vector<Look> looks(zones);
  for_zones(zones, [&](std::size_t z) {
    looks[z] = look(ZoneId(z), weighed_ > 0 ? &weights_[z * weighed_] : nullptr);
  });
  // Where the variance of one way is that of packets over the gain, and as much work goes into each part as
  // leaves the least error for all.
  plan_samples(looks, unit_packets_ / (cost_ * std::sqrt(gain_)));
}

void SampledDirectLight::plan_samples(const std::vector<Look>& looks, double per_unit) {
  double needs = 0;
  for (std::size_t z = 0; z < looks.size(); ++z) needs += need(ZoneId(z), looks[z]);
  samples_.assign(looks.size(), 0.0F);
  for (std::size_t z = 0; z < looks.size(); ++z) {
    if (!looks[z].lit) continue;
    samples_[z] = std::max(kLeastSamples, static_cast<float>(per_unit * need(ZoneId(z), looks[z]) / needs));
    lit_watts_ += looks[z].irradiance * room_->mesh().zone_area(ZoneId(z));
  }
}

double SampledDirectLight::need(ZoneId zone, const Look& look) const {
  return std::sqrt(room_->mesh().zone_area(zone)) * look.sigma;
}

std::vector<double> SampledDirectLight::reflectance(ZoneId zone) const {
  const ZoneMesh& mesh = room_->mesh();
  const double* rho = room_->surfaces().reflectance(zone, mesh.zone_triangle(zone), mesh.zone_is_front(zone));
  std::vector<double> result(rho, rho + bands_);
  for (double& r : result) r = std::max(r, kLeastReflectance);
  return result;
}

SampledDirectLight::Look SampledDirectLight::look(ZoneId zone, float* weights) const {
  const PointSampler sampler(seed_, RngPurpose::kSampledDirect, zone.index(), static_cast<int>(kPilot),
                             std::countr_zero(unsigned{kPilotPoints}));
  const std::vector<double> rho = reflectance(zone);
  const std::vector<float> one(bands_, 1.0F);
  std::vector<float> irradiance(bands_);
  Look result;
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < kPilotPoints; ++i) {
    const SurfacePoint x = point_in_zone(*room_, zone, sampler.place(i));
    std::fill(irradiance.begin(), irradiance.end(), 0.0F);
    light_.add_sample(x, sampler.light(i, 0, 1), one.data(), irradiance.data());
    if (weights != nullptr) light_.weigh(x, weights);
    double radiosity = 0;
    for (std::size_t b = 0; b < bands_; ++b) {
      radiosity += rho[b] * static_cast<double>(irradiance[b]);
      result.irradiance += static_cast<double>(irradiance[b]) / kPilotPoints;
    }
    sum += radiosity;
    squares += radiosity * radiosity;
  }
  result.lit = result.irradiance > 0;
  result.mean = sum / kPilotPoints;
  const double variance = std::max(0.0, squares - sum * result.mean) / (kPilotPoints - 1);
  result.sigma = std::max(std::sqrt(variance), kLeastSpread * result.mean);
  return result;
}

void SampledDirectLight::add_samples(ZoneId zone, const PointSampler& sampler, int first, int count,
                                     float* sum) const {
  const std::vector<float> weight(bands_, 1.0F / static_cast<float>(count));
  for (int i = first; i < first + count; ++i) {
    const SurfacePoint x = point_in_zone(*room_, zone, sampler.place(i));
    if (weighed_ > 0)
      light_.add_sample(x, sampler.light(i, 0, 1), {&weights_[zone.index() * weighed_], weighed_},
                        weight.data(), sum);
    else
      light_.add_sample(x, sampler.light(i, 0, 1), weight.data(), sum);
  }
}

std::uint64_t SampledDirectLight::put(std::uint32_t batch, std::int64_t weight,
                                      const std::vector<double>& watts_per_quantum, BatchBooks& books) const {
  std::vector<std::int64_t> on_all(bands_), by_packets(bands_), by_samples(bands_);
  const std::vector<int> first = first_samples(weight);
  const PointSampler sampler(seed_, RngPurpose::kSampledDirect, 0, static_cast<int>(batch), kLog2Samples);
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, samples_.size(), kSampledPerTask), [&](const auto& range) {
        std::vector<float> found(bands_);
        for (std::size_t z = range.begin(); z != range.end(); ++z) {
          std::int64_t* direct = &books.direct[z * bands_];
          for (std::size_t b = 0; b < bands_; ++b) book(on_all[b], direct[b]);
          if (samples_[z] == 0) continue;
          std::fill(found.begin(), found.end(), 0.0F);
          add_samples(ZoneId(z), sampler, first[z], first[z + 1] - first[z], found.data());
          const double area = room_->mesh().zone_area(ZoneId(z));
          for (std::size_t b = 0; b < bands_; ++b) {
            if (!(watts_per_quantum[b] > 0)) continue;
            book(by_packets[b], direct[b]);
            direct[b] = std::llround(static_cast<double>(found[b]) * area / watts_per_quantum[b]);
            book(by_samples[b], direct[b]);
          }
        }
      });
  for (std::size_t b = 0; b < bands_; ++b)
    if (on_all[b] == books.emitted[b] && by_samples[b] > 0)
      scale(static_cast<double>(by_packets[b]) / static_cast<double>(by_samples[b]), b, books);
  return static_cast<std::uint64_t>(first.back());
}

void SampledDirectLight::scale(double factor, std::size_t band, BatchBooks& books) const {
  for (std::size_t z = 0; z < samples_.size(); ++z) {
    if (samples_[z] == 0) continue;
    std::int64_t& direct = books.direct[z * bands_ + band];
    direct = std::llround(static_cast<double>(direct) * factor);
  }
}

std::vector<int> SampledDirectLight::first_samples(std::int64_t weight) const {
  std::vector<int> first(samples_.size() + 1);
  for (std::size_t z = 0; z < samples_.size(); ++z) {
    const auto wanted = std::lround(samples_[z] * static_cast<float>(weight));
    first[z + 1] = first[z] + (samples_[z] > 0 ? static_cast<int>(std::clamp(wanted, 1L, kMostSamples)) : 0);
  }
  return first;
}

bool SampledDirectLight::finds_what_packets_find(const std::vector<double>& watts_per_quantum,
                                                 const BatchBooks& books) const {
  double lit = 0;
  double others = 0;
  for (std::size_t z = 0; z < samples_.size(); ++z)
    for (std::size_t b = 0; b < bands_; ++b)
      (samples_[z] > 0 ? lit : others) +=
          static_cast<double>(books.direct[z * bands_ + b]) * watts_per_quantum[b];
  const double packet = watts_ / unit_packets_;
  const double most_left_out = std::max(kMostLeftOut * (lit + others), kMostPacketsLeftOut * packet);
  const double error = std::sqrt(std::max(lit, lit_watts_) * packet);
  return others <= most_left_out &&
         std::abs(lit - lit_watts_) <= std::max(kMostDifference * lit, kMostErrors * error);
}

std::optional<SampledDirectLight> sampled_direct_light(const PacketRoom& transport,
                                                       const PacketSources& emission,
                                                       const SolverSettings& settings,
                                                       std::uint32_t unit_packets) {
  if (settings.method != SolveMethod::kShooting || settings.direct != DirectSource::kBest ||
      emission.channels.groups() > 1 || transport.scene().bends_light() ||
      transport.surface_model().any_cut_outs() || transport.zones() > kMostZones)
    return std::nullopt;
  const std::vector<double>& quantum = emission.watts_per_quantum;
  const double watts =
      std::accumulate(quantum.begin(), quantum.end(), 0.0) * static_cast<double>(kBatchQuanta);
  SampledDirectLight sampled(transport.room(), settings.seed, watts, unit_packets);
  if (!sampled.pays()) return std::nullopt;
  return sampled;
}

bool prepare(const PacketRoom& transport, const PacketSources& emission, const SolverSettings& settings,
             std::uint32_t unit_packets, SampledDirectLight& direct) {
  direct.look_at_all();
  BatchBooks books = transport.new_books();
  shoot_first_flight({transport, emission, settings, kPilot, unit_packets}, books);
  return direct.finds_what_packets_find(emission.watts_per_quantum, books);
}

}  // namespace reemit

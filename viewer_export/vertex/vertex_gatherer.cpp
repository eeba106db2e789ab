#include "viewer_export/vertex/vertex_gatherer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "solver/gather/gather_batch.h"
#include "solver/gather/zone_bias_estimate.h"
#include "solver/reflect/lambert.h"
#include "solver/tally/replicates.h"

namespace reemit {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

}  // namespace

VertexGatherer::VertexGatherer(const Room& room, const Solution& solution, const VertexRings& rings,
                               const VertexSettings& settings, int most_points, const StopToken& stop)
    : room_(room),
      rings_(rings),
      settings_(settings),
      stop_(stop),
      field_(room, solution, kReplicates),
      direct_(room),
      gather_(field_, direct_,
              // Means of zones gather nothing; without close hits there is nothing to prepare.
              GatherSettings{.close_hit = settings.average_zones ? 0 : settings.close_hit,
                             .caustics = !settings.average_zones,
                             .seed = settings.seed,
                             .plan = &solution.gather_plan},
              &stop_),
      path_(room, direct_, settings.seed),
      bands_(room.band_count()),
      has_caustics_(room.scene().bends_light()),
      is_translucent_(std::any_of(room.scene().materials.begin(), room.scene().materials.end(),
                                  [](const Material& m) { return m.non_diffuse.transmits_diffusely(); })),
      gathers_per_point_(settings.gathers_per_point()),
      log2_points_(std::countr_zero(static_cast<unsigned>(most_points))) {}

const float* VertexGatherer::emitted(std::size_t v, SurfaceModel::PointValues& here) const {
  return room_.surfaces().emitted(rings_.point(v), here);
}

PointSampler VertexGatherer::sampler_of(std::size_t v, int replicate) const {
  // Smoothing averages neighbours, but those that go to a target have unequal numbers of points; what is not
  // smoothed is for itself.
  const bool shares =
      settings_.smooth && !(settings_.error_target > 0) && diffuse_transmittance(v) == nullptr;
  if (!shares) return {settings_.seed, RngPurpose::kProbe, v, replicate, log2_points_};
  constexpr int kLog2Group = 8;
  const AmongNeighbours place{v >> kLog2Group, static_cast<std::uint32_t>(v) & ((1U << kLog2Group) - 1),
                              kLog2Group};
  return {settings_.seed, RngPurpose::kVertexGroup, place, replicate, log2_points_};
}

bool VertexGatherer::gather(std::size_t first, std::size_t last, const PointBlock& block, float* means,
                            VertexData& data) const {
  std::vector<float> found((last - first) * values_per_vertex(), 0.0F);
  GatherBatch batch(gather_, gathers_per_point_);
  const ReplicateEffort effort{block.count, gathers_per_point_, block.first};
  float* next = found.data();
  for (std::size_t v = first; v < last; ++v)
    for (std::size_t r = 0; r < kReplicates; ++r, next += values_per_replicate()) {
      if (stop_.requested()) return false;
      const PointSampler sampler = sampler_of(v, static_cast<int>(r));
      const PathKey key{v, static_cast<std::uint32_t>(r), 0, static_cast<std::uint32_t>(r % field_.parts())};
      const auto caustic_of = [&](float* side) { return has_caustics_ ? side + 2 * bands_ : nullptr; };
      add_replicate(
          direct_, sampler, effort, key, [&](const std::array<float, 2>& u) { return point_beside(v, u); },
          batch, next, next + bands_, caustic_of(next));
      if (diffuse_transmittance(v) == nullptr) continue;
      float* other = next + values_per_side();
      PathKey behind = key;
      behind.index += rings_.size();  // random numbers that no vertex has
      add_replicate(
          direct_, sampler, effort, behind,
          [&](const std::array<float, 2>& u) { return other_side(room_.rays(), point_beside(v, u)); }, batch,
          other, other + bands_, caustic_of(other));
    }
  batch.flush();
  const float share = static_cast<float>(block.count) / static_cast<float>(block.first + block.count);
  for (std::size_t k = 0; k < found.size(); ++k) means[k] += share * (found[k] - means[k]);
  for (std::size_t v = first; v < last; ++v) store(v, means + (v - first) * values_per_vertex(), data);
  return true;
}

VertexLayers VertexGatherer::new_layers() const {
  VertexLayers layers(has_caustics_ ? 3 : 2);
  for (VertexLayer& layer : layers) {
    for (std::vector<float>& half : layer.half) half.resize(rings_.size() * bands_);
    layer.variance.resize(rings_.size() * bands_);
  }
  return layers;
}

void VertexGatherer::take_apart(std::size_t first, std::size_t last, const float* means,
                                VertexLayers& layers) const {
  for (std::size_t v = first; v < last; ++v, means += values_per_vertex())
    for (std::size_t l = 0; l < layers.size(); ++l)
      for (std::size_t b = 0; b < bands_; ++b) {
        const double scale = l == 0 ? 1 : std::numbers::pi;  // direct light is kept as irradiance
        const auto value = [&](std::size_t r) {
          return scale * static_cast<double>(means[r * values_per_replicate() + l * bands_ + b]);
        };
        const std::size_t k = v * bands_ + b;
        for (std::size_t h = 0; h < 2; ++h) {
          double sum = 0;
          for (std::size_t r = h; r < kReplicates; r += 2) sum += value(r);
          layers[l].half[h][k] = static_cast<float>(2 * sum / kReplicates);
        }
        layers[l].variance[k] =
            static_cast<float>(2 * mean_of_replicates(kReplicates, field_.parts(), value).squared_error);
      }
}

std::optional<ZoneBias> VertexGatherer::zone_bias(const VertexData& data, double rays) const {
  std::vector<double> power(bands_, 0.0);  // reflected radiance times area
  SurfaceModel::PointValues at_vertex;
  std::vector<double> area_up_to;
  double area = 0;
  for (std::size_t v = 0; v < rings_.size(); ++v) {
    area += rings_.area(v);
    area_up_to.push_back(area);
    for (std::size_t b = 0; b < bands_; ++b)
      power[b] += rings_.area(v) * (static_cast<double>(data.radiance[v * bands_ + b]) -
                                    static_cast<double>(emitted(v, at_vertex)[b]));
  }
  if (!(area > 0)) return std::nullopt;
  std::vector<SurfacePoint> points;
  std::vector<double> scale;
  const CounterRng rng(settings_.seed, RngPurpose::kZoneBias);
  for (std::size_t i = 0; i < ZoneBiasEffort::kPoints; ++i) {
    // Evenly along the vertices: those of a surface follow each other.
    const std::array<float, 4> u = rng.uniform4(i, kReplicates, 0);
    const double at = (static_cast<double>(i) + static_cast<double>(u[0])) / ZoneBiasEffort::kPoints * area;
    const auto found = std::upper_bound(area_up_to.begin(), area_up_to.end() - 1, at);
    points.push_back(point_beside(static_cast<std::size_t>(found - area_up_to.begin()), {u[1], u[2]}));
    for (const double p : power) scale.push_back(p > 0 ? area / p : 0);
  }
  return estimate_zone_bias(gather_, path_, points, scale, ZoneBiasEffort::of(rays), settings_.seed);
}

/// A point inside one of the zones around a vertex, zones in proportion to their areas, uniform in the copy
/// of the zone that is shrunk towards the vertex by `reach`.
SurfacePoint VertexGatherer::point_beside(std::size_t v, const std::array<float, 2>& u) const {
  const double total = 3 * rings_.area(v);
  double left = static_cast<double>(u[0]) * total;
  const RingCell* ring = rings_.begin(v);
  while (ring + 1 != rings_.end(v) && left >= ring->area) left -= (ring++)->area;
  const auto stretched = static_cast<float>(std::clamp(left / ring->area, 0.0, 1 - 0x1p-24));
  const auto [s, t] = sample_triangle(stretched, u[1]);
  const SidePoint inside = cell_point(ring->cell, s, t);
  const auto towards = [&](double Barycentric::*k) {
    return static_cast<float>(ring->vertex.*k + settings_.reach * (inside.at.*k - ring->vertex.*k));
  };
  return surface_point(room_.rays(), inside.triangle, towards(&Barycentric::u), towards(&Barycentric::v),
                       inside.front);
}

const Spectrum* VertexGatherer::diffuse_transmittance(std::size_t v) const {
  if (!is_translucent_) return nullptr;
  const Scene& scene = room_.scene();
  const SurfaceId surface = room_.mesh().zone_surface(rings_.begin(v)->zone);
  const NonDiffusePart& part = scene.material_of(scene.surfaces[surface.index()]).non_diffuse;
  return part.transmits_diffusely() ? &part.diffuse_transmittance : nullptr;
}

void VertexGatherer::store(std::size_t v, const float* means, VertexData& data) const {
  SurfaceModel::PointValues emission_here;
  SurfaceModel::PointValues reflectance_here;
  const float* own = emitted(v, emission_here);
  const float* reflectance = room_.surfaces().reflectance(rings_.point(v), reflectance_here);
  const Spectrum* tau = diffuse_transmittance(v);
  for (std::size_t b = 0; b < bands_; ++b) {
    const auto irradiance_of = [&](std::size_t r, std::size_t side) {
      const float* replicate = means + r * values_per_replicate() + side * values_per_side();
      const float indirect = replicate[bands_ + b];
      return static_cast<double>(replicate[b] +
                                 kPi * (has_caustics_ ? indirect + replicate[2 * bands_ + b] : indirect));
    };
    /// Mean over the replicates of one of the values of a side.
    const auto mean_of = [&](std::size_t side, std::size_t value) {
      double sum = 0;
      for (std::size_t r = 0; r < kReplicates; ++r)
        sum += static_cast<double>(
                   means[r * values_per_replicate() + side * values_per_side() + value * bands_ + b]) /
               kReplicates;
      return sum;
    };
    const auto direct_of = [&](std::size_t side) { return mean_of(side, 0); };
    const auto caustic_of = [&](std::size_t side) { return std::numbers::pi * mean_of(side, 2); };
    const auto [mean, squared_error] =
        mean_of_replicates(kReplicates, field_.parts(), [&](std::size_t r) { return irradiance_of(r, 0); });
    const double brdf = lambert_brdf_per_sr(reflectance[b]);
    const std::size_t k = v * bands_ + b;
    data.irradiance[k] = static_cast<float>(mean);
    data.radiance[k] = own[b] + static_cast<float>(brdf * mean);
    data.radiance_stderr[k] = static_cast<float>(brdf * std::sqrt(squared_error));
    data.direct_radiance[k] = static_cast<float>(brdf * direct_of(0));
    if (has_caustics_) data.caustic_radiance[k] = static_cast<float>(brdf * caustic_of(0));
    if (tau == nullptr) continue;
    const double btdf = (*tau)[static_cast<Eigen::Index>(b)] / static_cast<double>(kPi);
    const auto [radiance, squared] = mean_of_replicates(kReplicates, field_.parts(), [&](std::size_t r) {
      return brdf * irradiance_of(r, 0) + btdf * irradiance_of(r, 1);
    });
    data.radiance[k] = own[b] + static_cast<float>(radiance);
    data.radiance_stderr[k] = static_cast<float>(std::sqrt(squared));
    data.direct_radiance[k] = static_cast<float>(brdf * direct_of(0) + btdf * direct_of(1));
    if (has_caustics_)
      data.caustic_radiance[k] = static_cast<float>(brdf * caustic_of(0) + btdf * caustic_of(1));
  }
}

}  // namespace reemit

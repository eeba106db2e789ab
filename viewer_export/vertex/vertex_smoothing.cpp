#include "viewer_export/vertex/vertex_smoothing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "solver/reflect/lambert.h"
#include "viewer_export/output/smoothing_errors.h"
#include "viewer_export/vertex/surrounding_fit.h"
#include "viewer_export/vertex/vertex_neighbours.h"
#include "viewer_export/vertex/vertex_surroundings.h"

namespace reemit {
namespace {

/// Vertices that have the errors of their means looked at together, at most.
constexpr std::size_t kGroup = 64;

/// Fits over surroundings of so many edges to each side, from none on.
constexpr std::size_t kFits = Surrounding::kHops + 1;

/// Fits of a layer: judged at all vertices, then chosen, then kept.
class LayerFits {
 public:
  LayerFits(const VertexLayer& layer, std::size_t vertices, std::size_t bands)
      : layer_(layer),
        bands_(bands),
        noise_(vertices),
        squared_error_(vertices * kFits),
        best_(vertices),
        variance_(vertices * bands),
        covariance_(vertices * bands) {
    for (std::vector<float>& of_half : half_) of_half.resize(vertices * bands);
    for (std::size_t v = 0; v < vertices; ++v) {
      const float* own = &layer.variance[v * bands];
      noise_[v] = std::accumulate(own, own + bands, 0.0F);
    }
  }

  /// By how much the fits over `hops` edges to one half miss the values of the other, less the noise of
  /// these. Here and below, `sums` is room to work in.
  void judge(std::size_t v, std::size_t hops, const Surrounding& around, const SurroundingFit& fit,
             std::vector<float>& sums) {
    fit_values(around, fit, sums);
    float sum = 0;
    for (std::size_t b = 0; b < bands_; ++b) {
      const std::size_t own = v * bands_ + b;
      const float first = sums[b] - layer_.half[1][own];
      const float second = sums[bands_ + b] - layer_.half[0][own];
      sum += 0.5F * (first * first + second * second) - layer_.variance[own];
    }
    squared_error_[v * kFits + hops] = sum;
  }
  /// Chooses the fit whose errors are least in the nearer part of the surrounding, those of vertices as noisy
  /// as those next to it or more in units of their own noise. Where there is no noise values stay: in full
  /// shadow no replicate differs from 0.
  void choose(std::size_t v, const Surrounding& around) {
    float typical_noise = 0;
    for (std::size_t i = 0; i < around.upto[1]; ++i)
      typical_noise += noise_[around.vertices[i]] / static_cast<float>(around.upto[1]);
    if (typical_noise == 0) return;
    std::array<double, kFits> error{};
    for (std::size_t i = 0; i < around.upto[kJudged]; ++i) {
      const std::size_t q = around.vertices[i];
      const float weight = 1 / (typical_noise + noise_[q]);
      for (std::size_t hops = 0; hops < kFits; ++hops)
        error[hops] += static_cast<double>(weight * squared_error_[q * kFits + hops]);
    }
    best_[v] = static_cast<std::uint8_t>(std::min_element(error.begin(), error.end()) - error.begin());
  }
  std::size_t chosen(std::size_t v) const { return best_[v]; }
  void keep(std::size_t v, const Surrounding& around, const SurroundingFit& fit, std::vector<float>& sums) {
    fit_values(around, fit, sums);
    for (std::size_t b = 0; b < bands_; ++b) {
      const std::size_t own = v * bands_ + b;
      for (std::size_t h = 0; h < 2; ++h) half_[h][own] = sums[h * bands_ + b];
      float variance = 0;
      for (std::size_t i = 0; i < fit.weight.size(); ++i)
        variance += fit.weight[i] * fit.weight[i] * layer_.variance[around.vertices[i] * bands_ + b];
      variance_[own] = 0.5F * variance;
      covariance_[own] = 0.5F * fit.own_weight() * layer_.variance[own];
    }
  }

  float half(std::size_t h, std::size_t v, std::size_t band) const { return half_[h][v * bands_ + band]; }
  /// Of the mean of both halves, of noise that vertices do not share.
  float variance(std::size_t v, std::size_t band) const { return variance_[v * bands_ + band]; }
  /// Of that mean with the value as gathered.
  float covariance(std::size_t v, std::size_t band) const { return covariance_[v * bands_ + band]; }

 private:
  static constexpr std::size_t kJudged = 3;  ///< Edges to each side within which fits are judged.

  /// What the fit makes of the values of each half, [half * bands + band].
  void fit_values(const Surrounding& around, const SurroundingFit& fit, std::vector<float>& sums) const {
    sums.assign(2 * bands_, 0.0F);
    for (std::size_t i = 0; i < fit.weight.size(); ++i) {
      const float weight = fit.weight[i];
      const float* first = &layer_.half[0][around.vertices[i] * bands_];
      const float* second = &layer_.half[1][around.vertices[i] * bands_];
      for (std::size_t b = 0; b < bands_; ++b) {
        sums[b] += weight * first[b];
        sums[bands_ + b] += weight * second[b];
      }
    }
  }

  const VertexLayer& layer_;
  std::size_t bands_;
  std::vector<float> noise_;                // by vertex: variance of a half, all bands together
  std::vector<float> squared_error_;        // by vertex and fit: an estimate, which may be below 0
  std::vector<std::uint8_t> best_;          // by vertex: edges of the fit that is chosen
  std::array<std::vector<float>, 2> half_;  // by vertex and band, as the following
  std::vector<float> variance_, covariance_;
};

/// What becomes of all vertices, as VertexData has them: at first what they were.
struct SmoothVertices {
  explicit SmoothVertices(const VertexData& data)
      : radiance(data.radiance.size()),
        irradiance(data.irradiance),
        direct(data.direct_radiance),
        caustic(data.caustic_radiance) {
    radiance.value = data.radiance;
    for (std::size_t k = 0; k < data.radiance.size(); ++k)
      radiance.variance[k] = radiance.covariance[k] = data.radiance_stderr[k] * data.radiance_stderr[k];
  }

  SmoothedValues radiance;
  std::vector<float> irradiance, direct, caustic;
};

class Smoothing {
 public:
  Smoothing(const VertexGatherer& gatherer, const VertexRings& rings, const VertexLayers& layers,
            const StopToken& stop)
      : gatherer_(gatherer),
        rings_(rings),
        bands_(gatherer.field().band_count()),
        neighbours_(rings.size(), rings.triangles()) {
    tbb::enumerable_thread_specific<Surroundings> surroundings(
        [this] { return Surroundings(rings_, neighbours_); });
    const auto for_vertices = [&](auto&& function) {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rings.size(), kGroup), [&](const auto& range) {
        Surroundings& of_thread = surroundings.local();
        for (std::size_t v = range.begin(); v != range.end() && !stop.requested(); ++v)
          function(v, of_thread.of(v));
      });
    };
    for (const VertexLayer& layer : layers) fits_.emplace_back(layer, rings.size(), bands_);
    for_vertices([&](std::size_t v, const Surrounding& around) {
      const SurroundingFits of_hops(around);
      SurroundingFit fit;
      std::vector<float> sums;
      for (std::size_t hops = 0; hops < kFits; ++hops) {
        of_hops.fit(hops, fit);
        for (LayerFits& fits : fits_) fits.judge(v, hops, around, fit, sums);
      }
    });
    for_vertices([&](std::size_t v, const Surrounding& around) {
      const SurroundingFits of_hops(around);
      SurroundingFit fit;
      std::vector<float> sums;
      for (LayerFits& fits : fits_) {
        fits.choose(v, around);
        of_hops.fit(fits.chosen(v), fit);
        fits.keep(v, around, fit, sums);
      }
    });
  }

  void store(SmoothVertices& result) const {
    for (std::size_t v = 0; v < rings_.size(); ++v)
      if (gatherer_.diffuse_transmittance(v) == nullptr) store(v, result);
  }

 private:
  void store(std::size_t v, SmoothVertices& result) const {
    SurfaceModel::PointValues emission_here;
    SurfaceModel::PointValues reflectance_here;
    const float* own = gatherer_.emitted(v, emission_here);
    const float* reflectance =
        gatherer_.field().room().surfaces().reflectance(rings_.point(v), reflectance_here);
    for (std::size_t b = 0; b < bands_; ++b) {
      const std::size_t k = v * bands_ + b;
      const auto brdf = static_cast<float>(lambert_brdf_per_sr(reflectance[b]));
      std::array<float, 2> half{};
      float variance = 0;
      float covariance = 0;
      for (const LayerFits& fits : fits_) {
        for (std::size_t h = 0; h < 2; ++h) half[h] += fits.half(h, v, b);
        variance += fits.variance(v, b);
        covariance += fits.covariance(v, b);
      }
      // What is fitted through noise may pass below 0.
      const float all = std::max(0.0F, 0.5F * (half[0] + half[1]));
      const auto part = [&](std::size_t layer) {
        return brdf * std::clamp(0.5F * (fits_[layer].half(0, v, b) + fits_[layer].half(1, v, b)), 0.0F, all);
      };
      result.irradiance[k] = all;
      result.radiance.value[k] = own[b] + brdf * all;
      result.radiance.variance[k] = brdf * brdf * variance;
      result.radiance.covariance[k] = brdf * brdf * covariance;
      result.radiance.halves_apart[k] = 0.5F * brdf * (half[0] - half[1]);
      result.direct[k] = part(0);
      if (!result.caustic.empty()) result.caustic[k] = part(2);
    }
  }

  const VertexGatherer& gatherer_;
  const VertexRings& rings_;
  std::size_t bands_;
  VertexNeighbours neighbours_;
  std::vector<LayerFits> fits_;  // by layer
};

/// Vertices of one side of a surface, first to last - 1. They follow each other on it, so they are close.
struct VertexGroup {
  std::size_t first, last;
};

std::vector<VertexGroup> groups_of(const ZoneMesh& mesh, const VertexRings& rings) {
  std::vector<VertexGroup> groups;
  SurfaceId surface;
  bool front = true;
  for (std::size_t v = 0; v < rings.size(); ++v) {
    const SurfacePoint x = rings.point(v);
    const SurfaceId of_vertex = mesh.surface(x.triangle, x.front);
    if (groups.empty() || v - groups.back().first == kGroup || of_vertex != surface || x.front != front)
      groups.push_back({v, v});
    groups.back().last = v + 1;
    surface = of_vertex;
    front = x.front;
  }
  return groups;
}

/// Errors are taken relative to what is reflected, in the dark to this share of the mean of the group, for a
/// closed room beside a bright one has darkness of its own.
constexpr double kDark = 0.1;

std::vector<double> relative_scales(const VertexGatherer& gatherer, const VertexRings& rings,
                                    const std::vector<VertexGroup>& groups, const SmoothedValues& radiance,
                                    std::size_t bands, std::size_t band) {
  SurfaceModel::PointValues here;
  const auto reflected = [&](std::size_t v) {
    return static_cast<double>(radiance.value[v * bands + band]) -
           static_cast<double>(gatherer.emitted(v, here)[band]);
  };
  std::vector<double> scales(rings.size(), 0.0);
  for (const VertexGroup& group : groups) {
    double power = 0;
    double area = 0;
    double variance = 0;
    for (std::size_t v = group.first; v < group.last; ++v) {
      power += rings.area(v) * reflected(v);
      area += rings.area(v);
      variance += static_cast<double>(radiance.variance[v * bands + band]);
    }
    if (!(area > 0)) continue;
    // Where there is nothing but noise it is no more than all of what is seen.
    const double noise = std::sqrt(variance / static_cast<double>(group.last - group.first));
    for (std::size_t v = group.first; v < group.last; ++v)
      if (const double seen = reflected(v) + kDark * power / area + noise; seen > 0) scales[v] = 1 / seen;
  }
  return scales;
}

}  // namespace

void smooth_vertices(const VertexGatherer& gatherer, const VertexRings& rings, const VertexLayers& layers,
                     const StopToken& stop, VertexData& data) {
  const Smoothing smoothing(gatherer, rings, layers, stop);
  if (stop.requested()) return;
  SmoothVertices smooth(data);
  smoothing.store(smooth);
  const std::size_t bands = data.bands.count();
  const std::vector<VertexGroup> groups = groups_of(gatherer.field().room().mesh(), rings);
  for (std::size_t b = 0; b < bands; ++b) {
    const std::vector<double> scales = relative_scales(gatherer, rings, groups, smooth.radiance, bands, b);
    SmoothingErrors errors(smooth.radiance, data.radiance, data.radiance_stderr, bands, b, scales);
    std::vector<std::size_t> vertices;
    for (const VertexGroup& group : groups) {
      vertices.resize(group.last - group.first);
      std::iota(vertices.begin(), vertices.end(), group.first);
      errors.complete(vertices);
    }
  }
  for (std::size_t k = 0; k < data.radiance.size(); ++k)
    data.radiance_stderr[k] = std::sqrt(smooth.radiance.variance[k]);
  data.radiance = std::move(smooth.radiance.value);
  data.irradiance = std::move(smooth.irradiance);
  data.direct_radiance = std::move(smooth.direct);
  data.caustic_radiance = std::move(smooth.caustic);
  data.smoothed = true;
}

}  // namespace reemit

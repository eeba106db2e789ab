#include "viewer_export/vertex/vertex_refinement.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <tbb/parallel_for.h>

#include "solver/gather/path_key.h"

namespace reemit {
namespace {

/// Vertices of one task; fixed, so that packets of rays are the same for any number of threads.
constexpr std::size_t kChunk = 64;
constexpr int kFirstPoints = 2;
constexpr int kMostPoints = 1 << 14;

/// Sums over vertices for one band.
struct BandSums {
  double errors = 0;  // sum A s^2
  double values = 0;  // sum A (L - L_e)^2
};

/// Of vertices first .. last-1, by band.
std::vector<BandSums> band_sums(const VertexGatherer& gatherer, const VertexRings& rings,
                                const VertexData& data, std::size_t first, std::size_t last) {
  const std::size_t bands = data.bands.count();
  std::vector<BandSums> sums(bands);
  SurfaceModel::PointValues at_vertex;
  for (std::size_t v = first; v < last; ++v)
    for (std::size_t b = 0; b < bands; ++b) {
      const double s = data.radiance_stderr[v * bands + b];
      const double l = static_cast<double>(data.radiance[v * bands + b]) -
                       static_cast<double>(gatherer.emitted(v, at_vertex)[b]);
      sums[b].errors += rings.area(v) * s * s;
      sums[b].values += rings.area(v) * l * l;
    }
  return sums;
}

double area_of(const VertexRings& rings, std::size_t first, std::size_t last) {
  double area = 0;
  for (std::size_t v = first; v < last; ++v) area += rings.area(v);
  return area;
}

}  // namespace

double relative_error(const VertexGatherer& gatherer, const VertexRings& rings, const VertexData& data) {
  double worst = 0;
  for (const BandSums& band : band_sums(gatherer, rings, data, 0, rings.size()))
    if (band.values > 0) worst = std::max(worst, std::sqrt(band.errors / band.values));
  return worst;
}

WorstSurface worst_surface(const VertexGatherer& gatherer, const VertexRings& rings, const VertexData& data) {
  constexpr double kLeastArea = 0.01;  // of all
  struct Sums {
    std::vector<BandSums> bands;
    double area = 0;
  };
  std::vector<Sums> sums(data.surface_names.size());
  double area = 0;
  for (std::size_t v = 0; v < rings.size(); ++v) {
    Sums& of_surface = sums[data.surfaces[v].index()];
    const std::vector<BandSums> of_vertex = band_sums(gatherer, rings, data, v, v + 1);
    of_surface.bands.resize(of_vertex.size());
    for (std::size_t b = 0; b < of_vertex.size(); ++b) {
      of_surface.bands[b].errors += of_vertex[b].errors;
      of_surface.bands[b].values += of_vertex[b].values;
    }
    of_surface.area += rings.area(v);
    area += rings.area(v);
  }
  WorstSurface worst;
  for (std::size_t s = 0; s < sums.size(); ++s)
    for (const BandSums& band : sums[s].bands) {
      const double error = band.values > 0 ? std::sqrt(band.errors / band.values) : 0;
      if (sums[s].area >= kLeastArea * area && error > worst.error) worst = {SurfaceId(s), error};
    }
  return worst;
}

VertexRefinement::VertexRefinement(const VertexGatherer& gatherer, const VertexRings& rings,
                                   const VertexSettings& settings, const VertexProgressCallback& progress,
                                   const std::atomic<bool>& interrupt, VertexData& data)
    : gatherer_(gatherer),
      rings_(rings),
      settings_(settings),
      progress_(progress),
      interrupt_(interrupt),
      data_(data),
      layers_(settings.smooth ? gatherer.new_layers() : VertexLayers()),
      chunks_((rings.size() + kChunk - 1) / kChunk) {}

int VertexRefinement::most_points(const VertexSettings& settings) {
  const int of_numbers = static_cast<int>(PathKey::kMostPaths) / settings.gathers_per_point();
  return settings.error_target > 0 ? std::min(kMostPoints, of_numbers) : settings.points_per_replicate();
}

std::size_t VertexRefinement::first(std::size_t chunk) const {
  return chunk * kChunk;
}
std::size_t VertexRefinement::last(std::size_t chunk) const {
  return std::min((chunk + 1) * kChunk, rings_.size());
}

void VertexRefinement::run() {
  if (settings_.error_target > 0)
    run_to_target();
  else
    run_once();
}

void VertexRefinement::run_once() {
  const PointBlock block{0, settings_.points_per_replicate()};
  for_chunks([&](std::size_t c) {
    std::vector<float> means((last(c) - first(c)) * gatherer_.values_per_vertex(), 0.0F);
    if (gatherer_.gather(first(c), last(c), block, means.data(), data_))
      gatherer_.take_apart(first(c), last(c), means.data(), layers_);
  });
}

void VertexRefinement::run_to_target() {
  std::vector<float> means(rings_.size() * gatherer_.values_per_vertex(), 0.0F);
  std::vector<RefinedPart> parts(chunks_);
  int points = 0;
  while (points < most_points(settings_) && !interrupt_) {
    const PointBlock block{points, std::max(kFirstPoints, points)};
    for_chunks([&](std::size_t c) {
      if (parts[c].is_active())
        gatherer_.gather(first(c), last(c), block, &means[first(c) * gatherer_.values_per_vertex()], data_);
    });
    points += block.count;
    if (interrupt_ || !choose_active(parts)) break;
  }
  if (settings_.smooth) gatherer_.take_apart(0, rings_.size(), means.data(), layers_);
  data_.limited_by_zones = !interrupt_ && relative_error(gatherer_, rings_, data_) > settings_.error_target &&
                           std::any_of(parts.begin(), parts.end(), std::mem_fn(&RefinedPart::is_stalled));
}

// False if none is active any more.
bool VertexRefinement::choose_active(std::vector<RefinedPart>& parts) {
  const double target2 = std::pow(RefinedPart::aim(settings_.error_target), 2);
  const std::vector<BandSums> all = band_sums(gatherer_, rings_, data_, 0, rings_.size());
  const double total_area = area_of(rings_, 0, rings_.size());
  double worst = 0;
  for (const BandSums& band : all)
    if (band.values > 0) worst = std::max(worst, band.errors / (target2 * band.values));
  bool any = false;
  for (std::size_t c = 0; c < chunks_; ++c) {
    RefinedPart& part = parts[c];
    if (!part.is_active()) continue;
    const double area_share = area_of(rings_, first(c), last(c)) / total_area;
    const std::vector<BandSums> own = band_sums(gatherer_, rings_, data_, first(c), last(c));
    // Squared error over the part of the allowed one that goes with this part of the area.
    double excess = 0;
    for (std::size_t b = 0; b < own.size(); ++b)
      if (all[b].values > 0)
        excess = std::max(excess, own[b].errors / (target2 * all[b].values * area_share));
    part.look(excess, worst, true);  // every pass doubles the samples
    any = any || part.is_active();
  }
  share_done_ = worst > 1 ? 1 / worst : 1;
  return any;
}

template <class Function>
void VertexRefinement::for_chunks(Function&& function) {
  std::size_t done = 0;
  tbb::parallel_for(std::size_t{0}, chunks_, [&](std::size_t c) {
    if (interrupt_) return;
    function(c);
    const std::lock_guard lock(progress_mutex_);
    ++done;
    // One pass is all of the work unless there is a target.
    const double of_pass = static_cast<double>(done) / static_cast<double>(chunks_);
    if (progress_) progress_(settings_.error_target > 0 ? share_done_ : of_pass);
  });
}

}  // namespace reemit

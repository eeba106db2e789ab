#include "bench/hit_paths/block_comparison.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <tbb/parallel_for.h>

#include "bench/hit_paths/checked_picture.h"
#include "bench/hit_paths/hit_path_tracer.h"

namespace reemit::hit_paths {
namespace {

/// Sums over passes of the mean radiance of one block; a pass is one path through each of its pixels.
struct BlockSums {
  std::vector<double> sum, squares;
  int passes = 0;

  double mean(std::size_t b) const { return sum[b] / passes; }
  double standard_error(std::size_t b) const {
    const double variance = std::max(0.0, squares[b] / passes - mean(b) * mean(b));
    return std::sqrt(variance / (passes - 1));
  }
};

constexpr int kPassesAtOnce = 8;
constexpr int kLeastPasses = 64;

void add_passes(const HitPathTracer& tracer, const ComparisonSettings& settings, std::size_t across,
                std::size_t block, BlockSums& sums) {
  const int x0 = static_cast<int>(block % across) * kBlock;
  const int y0 = static_cast<int>(block / across) * kBlock;
  const std::size_t bands = sums.sum.size();
  std::vector<double> found(bands);
  for (int pass = 0; pass < kPassesAtOnce; ++pass) {
    std::seed_seq seed{settings.seed, std::uint64_t{block}, static_cast<std::uint64_t>(sums.passes)};
    HitPathTracer::Random random(seed);
    std::fill(found.begin(), found.end(), 0.0);
    for (int y = y0; y < y0 + kBlock; ++y)
      for (int x = x0; x < x0 + kBlock; ++x) tracer.add_path(x, y, random, found.data());
    for (std::size_t b = 0; b < bands; ++b) {
      const double mean = found[b] / (kBlock * kBlock);
      sums.sum[b] += mean;
      sums.squares[b] += mean * mean;
    }
    ++sums.passes;
  }
}

double worst_error(const BlockSums& s) {
  double worst = 0;
  for (std::size_t b = 0; b < s.sum.size(); ++b)
    if (s.sum[b] > 0) worst = std::max(worst, s.standard_error(b) / s.mean(b));
  return worst;
}

std::vector<BlockSums> trace_reference(const Scene& scene, const Camera& camera,
                                       const ComparisonSettings& settings, const CheckedPicture& size) {
  const HitPathTracer tracer(scene, camera, size.width, size.height, settings.photometry);
  const std::size_t bands = scene.bands.count();
  const std::size_t count = size.count();
  const auto across = static_cast<std::size_t>(size.across());
  std::vector<BlockSums> blocks(count, {std::vector<double>(bands), std::vector<double>(bands), 0});
  const auto start = std::chrono::steady_clock::now();
  for (;;) {
    tbb::parallel_for(std::size_t{0}, count,
                      [&](std::size_t i) { add_passes(tracer, settings, across, i, blocks[i]); });
    if (settings.passes > 0 && blocks[0].passes >= settings.passes) return blocks;
    if (settings.passes > 0 || blocks[0].passes < kLeastPasses) continue;
    std::vector<double> errors;
    for (const BlockSums& s : blocks) errors.push_back(worst_error(s));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (seconds >= settings.seconds || median(errors) <= settings.reference_error) return blocks;
  }
}

}  // namespace

bool BlockDeviation::differs() const {
  return std::abs(errors()) > kMostErrors && std::abs(relative()) > kMostDeviation;
}

std::size_t Comparison::different() const {
  return static_cast<std::size_t>(
      std::count_if(blocks.begin(), blocks.end(), [](const BlockDeviation& b) { return b.differs(); }));
}

Comparison compare_blocks(const Scene& scene, const Camera& camera, const ComparisonSettings& settings) {
  CheckedPicture checked{settings.width, settings.height, scene.bands.count(), {}};
  if (!settings.stills.empty()) checked = read_checked(settings.stills, scene.bands);
  const std::vector<BlockSums> reference = trace_reference(scene, camera, settings, checked);
  if (settings.stills.empty()) checked = render_checked(scene, camera, settings);
  const std::size_t bands = scene.bands.count();

  const double least_spread = median_spread(checked);

  Comparison out;
  out.camera = camera.name;
  std::vector<double> errors;
  CheckedBlock whole{std::vector<double>(checked.blocks.at(0).values.size()), 0};
  double sum_of_reference = 0;
  double variance_of_reference = 0;
  const int across = checked.across();
  for (std::size_t i = 0; i < reference.size(); ++i) {
    BlockDeviation worst;
    double worst_errors = -1;
    double standard_error = 0;  // of the reference over bands, which share their paths
    double pixels_error = 0;    // likewise
    for (std::size_t b = 0; b < bands; ++b) {
      const CheckedBlock& c = checked.blocks[i * bands + b];
      const double expected = reference[i].mean(b);
      for (std::size_t r = 0; r < c.values.size(); ++r) whole.values[r] += c.values[r];
      pixels_error += c.pixels_error;
      sum_of_reference += expected;
      standard_error += reference[i].standard_error(b);
      if (c.mean() == 0 && expected == 0) continue;
      const double spread = std::max(c.standard_error(), least_spread * c.mean());
      const BlockDeviation d{static_cast<int>(i) % across * kBlock, static_cast<int>(i) / across * kBlock,
                             c.mean(), expected, std::hypot(spread, reference[i].standard_error(b))};
      if (std::abs(d.errors()) <= worst_errors) continue;
      worst_errors = std::abs(d.errors());
      worst = d;
    }
    variance_of_reference += standard_error * standard_error;
    whole.pixels_error = std::hypot(whole.pixels_error, pixels_error);
    if (worst_errors < 0) continue;  // black in both
    out.blocks.push_back(worst);
    const bool found =
        std::any_of(reference[i].sum.begin(), reference[i].sum.end(), [](double sum) { return sum > 0; });
    const double error = found ? worst_error(reference[i]) : 1.0;  // one path would be as uncertain
    errors.push_back(error);
    out.largest_reference_error = std::max(out.largest_reference_error, error);
    out.paths += static_cast<std::uint64_t>(reference[i].passes) * kBlock * kBlock;
  }
  if (sum_of_reference > 0) {
    out.mean_deviation = whole.mean() / sum_of_reference - 1;
    out.mean_error = std::hypot(whole.standard_error(), std::sqrt(variance_of_reference)) / sum_of_reference;
  }
  out.reference_error = median(errors);
  sort_worst_first(out.blocks);
  return out;
}

}  // namespace reemit::hit_paths

#include "bench/hit_paths/block_reference.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <tbb/parallel_for.h>

#include "bench/hit_paths/block_comparison.h"
#include "bench/hit_paths/checked_picture.h"
#include "bench/hit_paths/hit_path_tracer.h"

namespace reemit::hit_paths {
namespace {

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

}  // namespace

double BlockSums::standard_error(std::size_t b) const {
  const double variance = std::max(0.0, squares[b] / passes - mean(b) * mean(b));
  return std::sqrt(variance / (passes - 1));
}

double BlockSums::worst_relative_error() const {
  double worst = 0;
  for (std::size_t b = 0; b < sum.size(); ++b)
    if (sum[b] > 0) worst = std::max(worst, standard_error(b) / mean(b));
  return worst;
}

std::vector<BlockSums> trace_reference(const Scene& scene, const Camera& camera,
                                       const ComparisonSettings& settings) {
  const HitPathTracer tracer(scene, camera, settings.width, settings.height, settings.photometry);
  const std::size_t bands = scene.bands.count();
  const CheckedPicture size{settings.width, settings.height, bands, {}};
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
    for (const BlockSums& s : blocks) errors.push_back(s.worst_relative_error());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (seconds >= settings.seconds || median(errors) <= settings.reference_error) return blocks;
  }
}

}  // namespace reemit::hit_paths

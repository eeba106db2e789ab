#include "bench/hit_paths/block_comparison.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

#include "bench/hit_paths/hit_path_tracer.h"
#include "solver/progressive_solver.h"

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

void add_passes(const HitPathTracer& tracer, const ComparisonSettings& settings, std::size_t block,
                BlockSums& sums) {
  const auto across = static_cast<std::size_t>(settings.width / kBlock);
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

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<BlockSums> trace_reference(const Scene& scene, const Camera& camera,
                                       const ComparisonSettings& settings) {
  const HitPathTracer tracer(scene, camera, settings.width, settings.height);
  const std::size_t bands = scene.bands.count();
  const auto count = static_cast<std::size_t>((settings.width / kBlock) * (settings.height / kBlock));
  std::vector<BlockSums> blocks(count, {std::vector<double>(bands), std::vector<double>(bands), 0});
  const auto start = std::chrono::steady_clock::now();
  for (;;) {
    tbb::parallel_for(std::size_t{0}, count,
                      [&](std::size_t i) { add_passes(tracer, settings, i, blocks[i]); });
    if (blocks[0].passes < kLeastPasses) continue;
    std::vector<double> errors;
    for (const BlockSums& s : blocks) errors.push_back(worst_error(s));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (seconds >= settings.seconds || median(errors) <= settings.reference_error) return blocks;
  }
}

/// The still that is checked, and by how much the noise of its zone solution may shift all of a block.
struct CheckedStill {
  StillImage image;
  double zone_error = 0;
};

CheckedStill render(const Scene& scene, const Camera& camera, const ComparisonSettings& settings) {
  const std::atomic<bool> never{false};
  MeshSettings mesh;
  if (settings.zone_area > 0) mesh.zone_area = settings.zone_area;
  SolverSettings solver;
  solver.packets = settings.packets;
  solver.seed = settings.seed;
  const Solution solution = solve(scene, build_mesh(scene, mesh), solver, {}, never);
  const RayScene rays(solution.mesh);
  StillSettings still;
  still.width = settings.width;
  still.height = settings.height;
  still.spp = settings.spp;
  still.seed = settings.seed;
  still.integrator = settings.by_path ? Integrator::kPath : Integrator::kGather;
  return {render_still(scene, solution, rays, camera, still, {}, never),
          settings.by_path ? 0.0 : solution.record.error};
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
  const std::vector<BlockSums> reference = trace_reference(scene, camera, settings);
  const CheckedStill checked = render(scene, camera, settings);
  const std::size_t bands = scene.bands.count();
  Comparison out;
  out.camera = camera.name;
  std::vector<double> errors;
  double sum = 0;
  double sum_of_reference = 0;
  const int across = settings.width / kBlock;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const int x0 = static_cast<int>(i) % across * kBlock;
    const int y0 = static_cast<int>(i) / across * kBlock;
    BlockDeviation worst;
    double worst_errors = -1;
    for (std::size_t b = 0; b < bands; ++b) {
      double mean = 0;
      double variance = 0;
      for (int y = y0; y < y0 + kBlock; ++y)
        for (int x = x0; x < x0 + kBlock; ++x) {
          const std::size_t at = (static_cast<std::size_t>(y) * static_cast<std::size_t>(settings.width) +
                                  static_cast<std::size_t>(x)) *
                                     bands +
                                 b;
          mean += static_cast<double>(checked.image.radiance[at]) / (kBlock * kBlock);
          variance += std::pow(static_cast<double>(checked.image.radiance_stderr[at]) / (kBlock * kBlock), 2);
        }
      mean *= 1 + settings.planted_bias;
      const double expected = reference[i].mean(b);
      sum += mean;
      sum_of_reference += expected;
      if (mean == 0 && expected == 0) continue;
      BlockDeviation d{x0, y0, mean, expected,
                       std::sqrt(variance + std::pow(checked.zone_error * mean, 2) +
                                 std::pow(reference[i].standard_error(b), 2))};
      if (std::abs(d.errors()) <= worst_errors) continue;
      worst_errors = std::abs(d.errors());
      worst = d;
    }
    if (worst_errors < 0) {
      ++out.black;
      continue;
    }
    out.blocks.push_back(worst);
    const double error = worst_error(reference[i]);
    errors.push_back(error);
    out.largest_reference_error = std::max(out.largest_reference_error, error);
    out.paths += static_cast<std::uint64_t>(reference[i].passes) * kBlock * kBlock;
  }
  out.mean_deviation = sum_of_reference > 0 ? sum / sum_of_reference - 1 : 0;
  out.reference_error = median(errors);
  std::sort(out.blocks.begin(), out.blocks.end(), [](const BlockDeviation& a, const BlockDeviation& b) {
    return std::abs(a.errors()) > std::abs(b.errors());
  });
  return out;
}

}  // namespace reemit::hit_paths

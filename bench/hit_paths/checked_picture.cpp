#include "bench/hit_paths/checked_picture.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "bench/hit_paths/block_comparison.h"
#include "bench/hit_paths/still_file.h"
#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "solver/zoning/build_zones.h"
#include "viewer_export/still/render_still.h"

namespace reemit::hit_paths {
namespace {

constexpr int kRenderings = 8;

}  // namespace

double CheckedBlock::mean() const {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double CheckedBlock::standard_error() const {
  const auto n = static_cast<double>(values.size());
  const double of_pixels = pixels_error / n;
  if (values.size() < 2) return of_pixels;
  double squares = 0;
  for (const double v : values) squares += (v - mean()) * (v - mean());
  // A few values may lie close by chance; the noise of pixels is known better.
  return std::max(std::sqrt(squares / (n * (n - 1))), of_pixels);
}

CheckedPicture empty_picture(int width, int height, std::size_t bands) {
  CheckedPicture picture{width, height, bands, {}};
  picture.blocks.resize(picture.count() * bands);
  return picture;
}

void add_still(const StillImage& image, double factor, CheckedPicture& picture) {
  const bool has_errors = !image.radiance_stderr.empty();
  for (std::size_t i = 0; i < picture.count(); ++i)
    for (std::size_t b = 0; b < picture.bands; ++b) {
      const int x0 = static_cast<int>(i) % picture.across() * kBlock;
      const int y0 = static_cast<int>(i) / picture.across() * kBlock;
      double sum = 0;
      double variance = 0;
      for (int y = y0; y < y0 + kBlock; ++y)
        for (int x = x0; x < x0 + kBlock; ++x) {
          const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                    static_cast<std::size_t>(x);
          const std::size_t value = pixel * picture.bands + b;
          sum += static_cast<double>(image.radiance[value]);
          if (has_errors) variance += std::pow(static_cast<double>(image.radiance_stderr[value]), 2);
        }
      CheckedBlock& block = picture.blocks[i * picture.bands + b];
      block.values.push_back(factor * sum / (kBlock * kBlock));
      block.pixels_error = std::hypot(block.pixels_error, factor * std::sqrt(variance) / (kBlock * kBlock));
    }
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double median_spread(const CheckedPicture& picture) {
  std::vector<double> spreads;
  for (const CheckedBlock& block : picture.blocks)
    if (block.mean() > 0) spreads.push_back(block.standard_error() / block.mean());
  return median(std::move(spreads));
}

void sort_worst_first(std::vector<BlockDeviation>& blocks) {
  std::sort(blocks.begin(), blocks.end(), [](const BlockDeviation& a, const BlockDeviation& b) {
    return std::abs(a.errors()) > std::abs(b.errors());
  });
}

CheckedPicture render_checked(const Scene& scene, const Camera& camera, const ComparisonSettings& settings) {
  const std::atomic<bool> never{false};
  MeshSettings mesh_settings;
  if (settings.zone_area > 0) mesh_settings.zone_area = settings.zone_area;
  const MeshResult mesh = build_zones(scene, mesh_settings);
  SolverSettings solver;
  if (settings.by_walks) solver.method = SolveMethod::kWalk;
  solver.packets = settings.packets / kRenderings;
  StillSettings still;
  still.width = settings.width;
  still.height = settings.height;
  still.spp = std::max(1, settings.spp / kRenderings);
  still.integrator = settings.by_path ? Integrator::kPath : Integrator::kGather;
  CheckedPicture picture = empty_picture(settings.width, settings.height, scene.bands.count());
  std::optional<ProgressiveSolver> run;
  for (int rendering = 0; rendering < kRenderings; ++rendering) {
    solver.seed = settings.seed * kRenderings + static_cast<std::uint64_t>(rendering);
    still.seed = solver.seed;
    // Paths do not read the zones: they need no solution, nor a room of their own for every picture.
    if (!run || !settings.by_path) run.emplace(scene, new_solution(scene, mesh, solver), never);
    if (!settings.by_path) {
      while (run->step()) {
      }
      run->end({}, Examination::kNone);
    }
    const StillImage image = render_still(run->room(), run->solution(), camera, still, {}, never);
    add_still(image, 1 + settings.planted_bias, picture);
  }
  return picture;
}

std::vector<BlockDeviation> compare_pictures(const CheckedPicture& checked, const CheckedPicture& reference) {
  const double least = median_spread(checked);
  const double least_of_reference = median_spread(reference);
  const auto error = [](const CheckedBlock& block, double least_spread) {
    return std::max(block.standard_error(), least_spread * block.mean());
  };
  std::vector<BlockDeviation> deviations;
  for (std::size_t i = 0; i < checked.count(); ++i) {
    BlockDeviation worst;
    double worst_errors = -1;
    for (std::size_t b = 0; b < checked.bands; ++b) {
      const CheckedBlock& c = checked.blocks[i * checked.bands + b];
      const CheckedBlock& r = reference.blocks[i * checked.bands + b];
      if (c.mean() == 0 && r.mean() == 0) continue;
      const BlockDeviation d{static_cast<int>(i) % checked.across() * kBlock,
                             static_cast<int>(i) / checked.across() * kBlock, c.mean(), r.mean(),
                             std::hypot(error(c, least), error(r, least_of_reference))};
      if (std::abs(d.errors()) <= worst_errors) continue;
      worst_errors = std::abs(d.errors());
      worst = d;
    }
    if (worst_errors >= 0) deviations.push_back(worst);
  }
  sort_worst_first(deviations);
  return deviations;
}

CheckedPicture read_checked(const std::vector<std::filesystem::path>& files, const BandSet& bands) {
  CheckedPicture picture;
  for (const std::filesystem::path& file : files) {
    const StillImage image = read_still(file, bands);
    if (picture.blocks.empty()) picture = empty_picture(image.width, image.height, bands.count());
    if (image.width != picture.width || image.height != picture.height)
      throw std::invalid_argument(file.string() + " is of another size than the pictures before it");
    add_still(image, 1, picture);
  }
  return picture;
}

}  // namespace reemit::hit_paths

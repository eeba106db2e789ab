#include "bench/hit_paths/block_comparison.h"

#include <algorithm>
#include <cmath>

#include "bench/hit_paths/block_reference.h"
#include "bench/hit_paths/checked_picture.h"

namespace reemit::hit_paths {
bool BlockDeviation::differs() const {
  return std::abs(errors()) > kMostErrors && std::abs(relative()) > kMostDeviation;
}

std::size_t Comparison::different() const {
  return static_cast<std::size_t>(
      std::count_if(blocks.begin(), blocks.end(), [](const BlockDeviation& b) { return b.differs(); }));
}

namespace {

Comparison compare(const CheckedPicture& checked, const std::vector<BlockSums>& reference,
                   const std::string& camera) {
  const std::size_t bands = checked.bands;

  const double least_spread = median_spread(checked);

  Comparison out;
  out.camera = camera;
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
    const double error = found ? reference[i].worst_relative_error() : 1.0;  // one path would be as uncertain
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

}  // namespace

Comparison compare_blocks(const Scene& scene, const Camera& camera, const ComparisonSettings& settings) {
  if (settings.stills.empty())
    return compare_blocks(scene, camera, settings, trace_reference(scene, camera, settings));
  const CheckedPicture checked = read_checked(settings.stills, scene.bands);
  ComparisonSettings sized = settings;
  sized.width = checked.width;
  sized.height = checked.height;
  return compare(checked, trace_reference(scene, camera, sized), camera.name);
}

Comparison compare_blocks(const Scene& scene, const Camera& camera, const ComparisonSettings& settings,
                          const std::vector<BlockSums>& reference) {
  return compare(render_checked(scene, camera, settings), reference, camera.name);
}

}  // namespace reemit::hit_paths

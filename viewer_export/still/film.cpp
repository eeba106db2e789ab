#include "viewer_export/still/film.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "scenes/model/error.h"
#include "viewer_export/still/allocate_planes.h"

namespace reemit {
namespace {

/// Calls use(pixel) for all pixels, on all threads.
template <class Use>
void for_each_pixel(std::size_t pixels, const Use& use) {
  constexpr std::size_t kPixelsOfTask = 2048;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels, kPixelsOfTask), [&](const auto& range) {
    for (std::size_t p = range.begin(); p < range.end(); ++p) use(p);
  });
}

}  // namespace

std::string to_string(PixelFilter filter) {
  return filter == PixelFilter::kBox ? "box" : "tent";
}

double sample_filter(PixelFilter filter, double u) {
  if (filter == PixelFilter::kBox) return u - 0.5;
  return u < 0.5 ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 * (1 - u));
}

std::size_t Film::bytes_per_pixel(std::size_t bands, std::size_t replicates, bool caustics) {
  // Finishing turns three of the replicates into layers.
  const std::size_t layers = (caustics ? 4 : 3) + std::max<std::size_t>(replicates, 3);
  return (layers * bands + 9) * sizeof(float) + 1;
}

Film::Film(const BandSet& bands, int width, int height, std::size_t replicates, std::size_t parts,
           bool caustics)
    : bands_(bands.count()), replicates_(replicates), parts_(parts) {
  image_.bands = bands;
  image_.width = width;
  image_.height = height;
  const std::size_t pixels = image_.pixel_count();
  try {
    std::vector<std::vector<float>*> by_band{&image_.direct, &image_.albedo, &image_.albedo_stderr};
    if (caustics) by_band.push_back(&image_.caustic);
    for (std::size_t r = 0; r < replicates_; ++r) by_band.push_back(&means_[r]);
    allocate_planes(by_band, pixels * bands_);
    image_.samples.assign(pixels, 0.0F);
    image_.luminous.assign(pixels, 0.0F);
    image_.mirroring.assign(pixels, 0.0F);
    image_.depth.assign(pixels, 0.0F);
    image_.normal.assign(3 * pixels, 0.0F);
    seen_.assign(pixels, 0.0F);
    begun_.assign(pixels, 0);
    blocks_.assign(pixels, 0);
  } catch (const std::bad_alloc&) {
    throw ResourceError("still",
                        "out of memory for " + std::to_string(pixels) + " pixels of " +
                            std::to_string(bytes_per_pixel(bands_, replicates_, caustics)) + " bytes",
                        "Choose a smaller picture.");
  }
}

void Film::add(std::size_t pixel, std::size_t replicate, const PixelBlock& block) {
  begun_[pixel] = std::max(begun_[pixel], static_cast<std::uint8_t>(replicate + 1));
  const auto samples = static_cast<float>(block.samples);
  const float share = samples / (static_cast<float>(block.earlier) + samples);
  const float share_of_all = samples / (image_.samples[pixel] + samples);
  for (std::size_t b = 0; b < bands_; ++b) {
    const std::size_t k = pixel * bands_ + b;
    float& mean = means_[replicate][k];
    float radiance = block.direct[b] + block.indirect[b];
    if (!image_.caustic.empty()) {
      radiance += block.caustic[b];
      image_.caustic[k] += share_of_all * (block.caustic[b] - image_.caustic[k]);
    }
    mean += share * (radiance - mean);
    image_.direct[k] += share_of_all * (block.direct[b] - image_.direct[k]);
    // As [WES79] updates variances: no difference of large numbers.
    const float off = block.albedo[b] - image_.albedo[k];
    image_.albedo[k] += share_of_all * off;
    image_.albedo_stderr[k] += samples * off * (block.albedo[b] - image_.albedo[k]);
  }
  ++blocks_[pixel];
  image_.samples[pixel] += samples;
  image_.luminous[pixel] += static_cast<float>(block.luminous);
  image_.mirroring[pixel] += static_cast<float>(block.mirroring);
  image_.depth[pixel] += static_cast<float>(block.depth);
  for (std::size_t k = 0; k < 3; ++k)
    image_.normal[3 * pixel + k] += static_cast<float>(block.normal[static_cast<Eigen::Index>(k)]);
  seen_[pixel] += static_cast<float>(block.seen);
}

ReplicateMean Film::replicate_mean(std::size_t pixel, std::size_t band) const {
  return mean_of_replicates(replicates_, parts_, [&](std::size_t r) {
    return static_cast<double>(means_[r][pixel * bands_ + band]);
  });
}

// Of fewer replicates than planned each counts as one of its own: most have parts of their own, too.
ReplicateMean Film::mean_so_far(std::size_t pixel, std::size_t band) const {
  const std::size_t begun = begun_[pixel];
  if (begun == replicates_) return replicate_mean(pixel, band);
  if (begun == 0) return {};
  return mean_of_replicates(
      begun, 1, [&](std::size_t r) { return static_cast<double>(means_[r][pixel * bands_ + band]); });
}

bool Film::has_gaps() const {
  return std::find(begun_.begin(), begun_.end(), 0) != begun_.end();
}

double Film::radiance(std::size_t pixel, std::size_t band) const {
  return replicate_mean(pixel, band).mean;
}

StillHalves Film::halves() const {
  const bool is_whole = std::all_of(begun_.begin(), begun_.end(),
                                    [&](std::size_t n) { return n == replicates_ && n % 2 == 0; });
  if (!is_whole) return {};
  StillHalves halves;
  const float share = 2.0F / static_cast<float>(replicates_);
  tbb::parallel_for(std::size_t{0}, halves.size(), [&](std::size_t h) {
    halves[h].assign(image_.direct.size(), 0.0F);
    for (std::size_t r = h; r < replicates_; r += 2)
      for (std::size_t k = 0; k < halves[h].size(); ++k) halves[h][k] += share * means_[r][k];
  });
  return halves;
}

float Film::indirect(std::size_t pixel, std::size_t band, float radiance) const {
  const std::size_t k = pixel * bands_ + band;
  const float caustic = image_.caustic.empty() ? 0.0F : image_.caustic[k];
  return std::max(0.0F, radiance - image_.direct[k] - caustic);
}

void Film::complete_geometry(StillImage& image, std::size_t pixel) const {
  const float seen = seen_[pixel];
  image.depth[pixel] = seen > 0 ? image.depth[pixel] / seen : std::numeric_limits<float>::infinity();
  Eigen::Map<Vec3f> normal(&image.normal[3 * pixel]);
  const float length = normal.norm();
  if (length > 0) normal /= length;
  const float samples = image.samples[pixel];
  if (samples > 0) {
    image.luminous[pixel] /= samples;
    image.mirroring[pixel] /= samples;
  }
  // The variance of a block's mean falls as its samples, or faster.
  const float of_mean = blocks_[pixel] > 1 ? 1 / (samples * static_cast<float>(blocks_[pixel] - 1)) : 0.0F;
  for (std::size_t k = pixel * bands_; k < (pixel + 1) * bands_; ++k)
    image.albedo_stderr[k] = std::sqrt(of_mean * image.albedo_stderr[k]);
}

StillImage Film::snapshot() const {
  StillImage image = image_;
  for (std::vector<float>* layer : {&image.radiance, &image.indirect, &image.radiance_stderr})
    layer->resize(image_.direct.size());
  for_each_pixel(image_.pixel_count(), [&](std::size_t pixel) {
    for (std::size_t b = 0; b < bands_; ++b) {
      const std::size_t k = pixel * bands_ + b;
      const ReplicateMean mean = replicate_mean(pixel, b);
      image.radiance[k] = static_cast<float>(mean.mean);
      image.indirect[k] = indirect(pixel, b, image.radiance[k]);
      image.radiance_stderr[k] = static_cast<float>(std::sqrt(mean.squared_error));
    }
    complete_geometry(image, pixel);
  });
  return image;
}

StillImage Film::finish() {
  const bool have_errors = std::find(begun_.begin(), begun_.end(), 1) == begun_.end();
  for (std::size_t r = replicates_; r < 3; ++r) means_[r].resize(image_.direct.size());
  for_each_pixel(image_.pixel_count(), [&](std::size_t pixel) {
    for (std::size_t b = 0; b < bands_; ++b) {
      // In place: replicates 0, 1 and 2 become the layers radiance, indirect and standard error.
      const std::size_t k = pixel * bands_ + b;
      const ReplicateMean mean = mean_so_far(pixel, b);
      const double error = have_errors ? std::sqrt(mean.squared_error) : 0.0;
      means_[0][k] = static_cast<float>(mean.mean);
      means_[1][k] = indirect(pixel, b, means_[0][k]);
      means_[2][k] = static_cast<float>(error);
    }
    complete_geometry(image_, pixel);
  });
  image_.radiance = std::move(means_[0]);
  image_.indirect = std::move(means_[1]);
  if (have_errors) image_.radiance_stderr = std::move(means_[2]);
  return std::move(image_);
}

}  // namespace reemit

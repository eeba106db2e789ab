#include "viewer_export/still/film.h"

#include <cmath>

#include <gtest/gtest.h>

namespace reemit {
namespace {

TEST(PixelFilter, box_and_tent_have_their_shapes) {
  // Second moments 1/12 and 1/6 of the box and the tent; midpoint rule.
  double box = 0;
  double tent = 0;
  constexpr int kCount = 10000;
  for (int i = 0; i < kCount; ++i) {
    const double u = (i + 0.5) / kCount;
    box += std::pow(sample_filter(PixelFilter::kBox, u), 2) / kCount;
    tent += std::pow(sample_filter(PixelFilter::kTent, u), 2) / kCount;
  }
  EXPECT_NEAR(box, 1.0 / 12, 1e-6);
  EXPECT_NEAR(tent, 1.0 / 6, 1e-6);
  EXPECT_NEAR(sample_filter(PixelFilter::kTent, 0), -1, 1e-12);
  EXPECT_NEAR(sample_filter(PixelFilter::kTent, 0.5), 0, 1e-12);
}

TEST(Film, mean_and_error_of_replicates_that_grow_by_blocks) {
  Film film(BandSet::grey(), 2, 1, 4);
  const float albedo = 0.25F;
  const auto add = [&](std::size_t replicate, float direct, float indirect, int earlier, int samples) {
    film.add(1, replicate,
             {.direct = &direct,
              .indirect = &indirect,
              .albedo = &albedo,
              .normal = Vec3(0, 0, samples),
              .depth = 2.0 * samples,
              .seen = samples,
              .samples = samples,
              .earlier = earlier});
  };
  // Replicates end at 1, 2, 3 and 6: mean 3, variance of the mean 14/12.
  for (std::size_t r = 0; r < 4; ++r) add(r, 1, 0, 0, 2);
  const float last[] = {1, 2.5F, 4, 8.5F};
  for (std::size_t r = 0; r < 4; ++r) add(r, 0.5F, last[r] - 0.5F, 2, 4);
  EXPECT_NEAR(film.radiance(1, 0), 3, 1e-5);
  EXPECT_NEAR(film.replicate_mean(1, 0).squared_error, 14.0 / 12, 1e-5);
  const StillImage image = film.finish();
  ASSERT_NO_THROW(check_consistent(image));
  EXPECT_NEAR(image.radiance[1], 3, 1e-5);
  EXPECT_NEAR(image.direct[1], 2.0 / 3, 1e-5);
  EXPECT_NEAR(image.indirect[1], 3 - 2.0 / 3, 1e-5);
  EXPECT_NEAR(image.radiance_stderr[1], std::sqrt(14.0 / 12), 1e-5);
  EXPECT_EQ(image.samples[1], 24);
  EXPECT_NEAR(image.depth[1], 2, 1e-5);
  EXPECT_NEAR(image.normal[5], 1, 1e-6);
  EXPECT_EQ(image.samples[0], 0);
  EXPECT_TRUE(std::isinf(image.depth[0]));
}

TEST(Film, error_of_the_albedo_is_that_of_blocks_weighed_by_their_samples) {
  Film film(BandSet::grey(), 1, 1, 4);
  const auto add = [&](std::size_t replicate, float albedo, int earlier, int samples) {
    const float light = 1;
    film.add(
        0, replicate,
        {.direct = &light, .indirect = &light, .albedo = &albedo, .samples = samples, .earlier = earlier});
  };
  // Mean 0.3 of 24 samples; squares off it, by samples: 2 (0.04 + 0.01 + 0 + 0.09) + 4 (4 * 0.01) = 0.44.
  const float first[] = {0.1F, 0.2F, 0.3F, 0.6F};
  for (std::size_t r = 0; r < 4; ++r) add(r, first[r], 0, 2);
  EXPECT_NEAR(film.snapshot().albedo_stderr[0], std::sqrt(0.28 / (3 * 8)), 1e-6);
  for (std::size_t r = 0; r < 4; ++r) add(r, r % 2 == 0 ? 0.2F : 0.4F, 2, 4);
  const StillImage image = film.finish();
  EXPECT_NEAR(image.albedo[0], 0.3, 1e-6);
  EXPECT_NEAR(image.albedo_stderr[0], std::sqrt(0.44 / (7 * 24)), 1e-6);
}

TEST(Film, a_snapshot_is_the_picture_that_would_be_handed_over) {
  Film film(BandSet::grey(), 3, 2, 4, 1, true);
  for (std::size_t pixel = 0; pixel < 6; ++pixel)
    for (std::size_t r = 0; r < 4; ++r) {
      const auto direct = static_cast<float>(pixel + r * r);
      const float indirect = 0.5F * static_cast<float>(r), caustic = 0.25F, albedo = 0.5F;
      film.add(pixel, r,
               {.direct = &direct,
                .indirect = &indirect,
                .caustic = &caustic,
                .albedo = &albedo,
                .normal = Vec3(0, 0, 2),
                .depth = 3,
                .seen = pixel == 5 ? 0 : 2,
                .samples = 2});
    }
  const StillImage now = film.snapshot();
  ASSERT_NO_THROW(check_consistent(now));
  const StillImage end = film.finish();
  EXPECT_EQ(now.radiance, end.radiance);
  EXPECT_EQ(now.radiance_stderr, end.radiance_stderr);
  EXPECT_EQ(now.albedo_stderr, end.albedo_stderr);
  EXPECT_EQ(now.direct, end.direct);
  EXPECT_EQ(now.indirect, end.indirect);
  EXPECT_EQ(now.caustic, end.caustic);
  EXPECT_EQ(now.normal, end.normal);
  EXPECT_EQ(now.depth, end.depth);
  EXPECT_EQ(now.samples, end.samples);
}

}  // namespace
}  // namespace reemit

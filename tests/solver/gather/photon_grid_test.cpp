#include "solver/gather/photon_grid.h"

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace reemit {
namespace {

/// Points all over a box around the origin, so that some have negative coordinates, and crowded in a corner.
std::vector<Vec3f> photon_places() {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-1, 1);
  std::vector<Vec3f> places;
  for (int i = 0; i < 2000; ++i) places.emplace_back(uniform(random), uniform(random), uniform(random));
  for (int i = 0; i < 2000; ++i)
    places.push_back(Vec3f::Constant(0.9F) +
                     0.05F * Vec3f(uniform(random), uniform(random), uniform(random)));
  return places;
}

constexpr float kPhotonCell = 0.25F;

PhotonGrid grid_of(const std::vector<Vec3f>& places) {
  std::vector<std::uint32_t> all(places.size());
  std::iota(all.begin(), all.end(), 0U);
  return {places, all, kPhotonCell};
}

TEST(PhotonGrid, finds_every_point_within_the_radius_once) {
  const std::vector<Vec3f> places = photon_places();
  const PhotonGrid grid = grid_of(places);
  constexpr float kRadius = 0.5F * kPhotonCell;
  for (const Vec3f& place : {Vec3f(0, 0, 0), Vec3f(-0.4F, 0.3F, 0.99F), Vec3f(0.9F, 0.88F, 0.9F)}) {
    std::vector<std::uint32_t> found;
    grid.visit(place, kRadius, [&](std::uint32_t i, float d2) {
      EXPECT_FLOAT_EQ(d2, (places[i] - place).squaredNorm());
      found.push_back(i);
    });
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < places.size(); ++i)
      if ((places[i] - place).squaredNorm() < kRadius * kRadius) expected.push_back(i);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
    EXPECT_FALSE(expected.empty());
  }
}

// Of some 2,000 crowded points in two cells to a side 256 of each are looked at: a standard error of 6 % of
// what is found, of which 4 are allowed, odds of 1 in 10^4 for a seed. Counting each point once finds less
// than half.
TEST(PhotonGrid, looks_at_some_points_of_each_cell_for_all_of_them) {
  const std::vector<Vec3f> places = photon_places();
  const PhotonGrid grid = grid_of(places);
  const Vec3f place = Vec3f::Constant(0.9F);
  constexpr float kRadius = 0.04F;
  std::size_t all = 0;
  grid.visit(place, kRadius, [&](std::uint32_t, float) { ++all; });
  ASSERT_GT(all, 300U);
  std::size_t looked_at = 0;
  double counted = 0;
  grid.visit_some(place, kRadius, 256, [&](std::uint32_t, float, float scale) {
    ++looked_at;
    counted += static_cast<double>(scale);
  });
  EXPECT_LT(looked_at, all / 2);
  EXPECT_NEAR(counted, static_cast<double>(all), 0.24 * static_cast<double>(all));
}

}  // namespace
}  // namespace reemit

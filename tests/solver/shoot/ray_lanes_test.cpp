#include "solver/shoot/ray_lanes.h"

#include <cmath>

#include <gtest/gtest.h>

#include "solver/sampling/counter_rng.h"
#include "solver/sampling/warp.h"

namespace reemit {
namespace {

TEST(RayLanes, EqualTheScalarMappings) {
  const CounterRng rng(4, RngPurpose::kProbe);
  const Vec3f corner(0.2F, -0.4F, 0.1F);
  const Vec3f edge1(0.3F, 0, 0.1F);
  const Vec3f edge2(0, 0.2F, -0.1F);
  const Vec3f middle = corner + (edge1 + edge2) / 3.0F;
  const Frame frame(edge1.cross(edge2).normalized());
  ZoneLanes zones{};
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 16; ++i) {
      zones.corner[k][i] = corner[k];
      zones.edge1[k][i] = edge1[k];
      zones.edge2[k][i] = edge2[k];
      zones.middle[k][i] = middle[k];
      zones.tangent[k][i] = frame.tangent[k];
      zones.bitangent[k][i] = frame.bitangent[k];
      zones.normal[k][i] = frame.normal[k];
    }
  for (std::uint64_t block = 0; block < 500; ++block) {
    UniformLanes numbers;
    for (std::uint32_t i = 0; i < 16; ++i) {
      const auto u = rng.uniform4(block, 0, i);
      // Some numbers on the seams of the mappings.
      for (std::size_t d = 0; d < 4; ++d)
        numbers.u[d][i] = block < 2 ? 0.5F * static_cast<float>(block) : u[d];
    }
    Ray16 rays;
    EXPECT_EQ(start_rays(zones, numbers, rays), 0U);
    for (int i = 0; i < 16; ++i) {
      const auto [a, b] = sample_triangle(numbers.u[0][i], numbers.u[1][i]);
      const Vec3f origin = RayTracer::lifted(corner + a * edge1 + b * edge2, frame.normal, middle);
      const Vec3f direction = frame.to_world(sample_cosine_hemisphere(numbers.u[2][i], numbers.u[3][i]));
      EXPECT_LT((rays.origin(i) - origin).norm(), 3e-7F);
      // Near the horizon the cosine is the root of a small difference.
      EXPECT_LT((rays.direction(i) - direction).norm(), 1e-6F / std::max(1e-3F, direction.dot(frame.normal)));
    }
  }
}

// Far out of the space in which rays live, where coordinates are rounded by more than the lift.
TEST(RayLanes, StartsThatRoundingLeftBehindAreKnown) {
  const CounterRng rng(5, RngPurpose::kProbe);
  const Vec3f edge1(0.5F, -0.3F, 0.1F);
  const Vec3f edge2(0.1F, 0.4F, -0.6F);
  const Vec3f normal = edge1.cross(edge2).normalized();
  const Vec3f middle = Vec3f::Constant(700) + (edge1 + edge2) / 3.0F;
  ZoneLanes zones{};
  for (int i = 0; i < 15; ++i)  // the last lane has no geometry
    for (int k = 0; k < 3; ++k) {
      zones.corner[k][i] = 700;
      zones.edge1[k][i] = edge1[k];
      zones.edge2[k][i] = edge2[k];
      zones.middle[k][i] = middle[k];
      zones.normal[k][i] = normal[k];
    }
  int behind = 0;
  int before = 0;
  for (std::uint32_t block = 0; block < 100; ++block) {
    UniformLanes numbers;
    for (std::uint32_t i = 0; i < 16; ++i)
      for (std::size_t d = 0; d < 4; ++d) numbers.u[d][i] = rng.uniform4(block, 0, i)[d];
    Ray16 rays;
    const std::uint32_t bits = start_rays(zones, numbers, rays);
    EXPECT_EQ(bits >> 15, 0U);
    for (int i = 0; i < 15; ++i) {
      const Vec3 way = rays.origin(i).cast<double>() - middle.cast<double>();
      const double height = way.dot(normal.cast<double>());
      if (std::fabs(height) < 1e-6) continue;
      EXPECT_EQ((bits >> i & 1U) != 0, height < 0);
      ++(height < 0 ? behind : before);
    }
  }
  EXPECT_GT(behind, 50);
  EXPECT_GT(before, 50);
}

TEST(RayLanes, SixteenRandomNumbersEqualSingleOnes) {
  const CounterRng rng(99, RngPurpose::kReflection);
  std::uint32_t index[16];
  for (std::uint32_t i = 0; i < 16; ++i) index[i] = 1000 * i + 7;
  BitLanes lanes;
  BitLanes anywhere;
  rng.bits4x16(index, 12, 34, lanes);
  rng.bits4x16_anywhere(index, 12, 34, anywhere);
  for (std::uint32_t i = 0; i < 16; ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(lanes.word[k][i], rng.bits4(index[i], 12, 34)[k]);
      EXPECT_EQ(anywhere.word[k][i], lanes.word[k][i]);
    }
}

}  // namespace
}  // namespace reemit

#include "solver/emit/opening_sampler.h"

#include <cmath>

#include <gtest/gtest.h>

#include "scenes/model/opening_reach.h"
#include "solver/sampling/counter_rng.h"
#include "tests/solver/emit/luminaire_tables.h"
#include "tests/support/chi_square.h"

namespace reemit {
namespace {

using Shape = LuminousOpening::Shape;
using Axis = LuminousOpening::Axis;
using test::opening;

template <class Visit>
void for_samples(const LuminousOpening& o, std::uint32_t count, const Visit& visit) {
  const CounterRng rng(5, RngPurpose::kEmission);
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto u = rng.uniform4(k, 0, 0);
    visit(sample_opening(o, static_cast<double>(u[0]), static_cast<double>(u[1])));
  }
}

TEST(OpeningSampler, points_reach_as_far_as_the_opening_and_no_farther) {
  const LuminousOpening openings[] = {opening(Shape::kPoint, 1, 2, 3),
                                      opening(Shape::kBox, 0.6, 1.2, 0),
                                      opening(Shape::kBox, 0.6, 1.2, 0.3),
                                      opening(Shape::kBox, 1.2, 0, 0),
                                      opening(Shape::kCylinder, 0.4, 0.2, 0),
                                      opening(Shape::kCylinder, 0.4, 0.4, 1),
                                      opening(Shape::kCylinder, 1.5, 0.1, 0.2, Axis::kLength),
                                      opening(Shape::kCylinder, 0, 0.3, 0.2, Axis::kLength),
                                      opening(Shape::kEllipsoid, 1, 0.5, 0.2)};
  for (const LuminousOpening& o : openings)
    for (const Vec3& n : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0.48, -0.6, 0.64)}) {
      const double reach = opening_reach(o, n);
      double farthest = 0;
      for_samples(o, 20'000, [&](const Vec3& p) { farthest = std::max(farthest, n.dot(p)); });
      EXPECT_LE(farthest, reach * (1 + 1e-6) + 1e-12);
      EXPECT_GE(farthest, 0.97 * reach);
    }
  EXPECT_EQ(opening_extent(openings[0]), 0);
  EXPECT_EQ(opening_extent(openings[1]), 1.2);
}

TEST(OpeningSampler, uniform_over_the_faces_of_a_box) {
  // Slices of equal height along each axis hold the caps, or their share of the sides.
  const LuminousOpening o = opening(Shape::kBox, 1, 2, 3);
  constexpr std::uint32_t kSamples = 100'000;
  std::vector<double> counts(10, 0.0);
  for_samples(o, kSamples, [&](const Vec3& p) {
    const double z = p.z() / 3 + 0.5;
    if (z <= 0)
      counts[8] += 1;
    else if (z >= 1)
      counts[9] += 1;
    else
      counts[static_cast<std::size_t>(z * 8)] += 1;
  });
  const double area = 2 * (2 + 3 + 6);
  std::vector<double> expected(10, kSamples * 2 * (3 + 6) / 8 / area);
  expected[8] = expected[9] = kSamples * 2 / area;
  EXPECT_GT(test::chi_square_of_counts(counts, expected), test::kFalseAlarm);
}

TEST(OpeningSampler, uniform_over_round_openings) {
  constexpr std::uint32_t kSamples = 100'000;
  const auto fit = [&](const LuminousOpening& o, auto&& cell, const std::vector<double>& shares) {
    std::vector<double> counts(shares.size(), 0.0);
    std::vector<double> expected = shares;
    for (double& e : expected) e *= kSamples;
    for_samples(o, kSamples, [&](const Vec3& p) { counts[std::min(cell(p), shares.size() - 1)] += 1; });
    EXPECT_GT(test::chi_square_of_counts(counts, expected), test::kFalseAlarm);
  };
  // An ellipse: rings of equal area. A sphere: slices of equal height.
  fit(
      opening(Shape::kCylinder, 2, 4, 0),
      [](const Vec3& p) { return static_cast<std::size_t>(12 * (p.x() * p.x() + p.y() * p.y() / 4)); },
      std::vector<double>(12, 1.0 / 12));
  fit(
      opening(Shape::kEllipsoid, 2, 2, 2),
      [](const Vec3& p) { return static_cast<std::size_t>(6 * (p.y() + 1)); },
      std::vector<double>(12, 1.0 / 12));
  // A cylinder of radius 1 and height 3 along x: caps pi each, side 6 pi.
  fit(opening(Shape::kCylinder, 3, 2, 2, Axis::kLength),
      [](const Vec3& p) {
        if (p.x() <= -1.5) return std::size_t{6};
        if (p.x() >= 1.5) return std::size_t{7};
        return static_cast<std::size_t>((p.x() + 1.5) * 2);
      },
      {1. / 8, 1. / 8, 1. / 8, 1. / 8, 1. / 8, 1. / 8, 1. / 8, 1. / 8});
}

}  // namespace
}  // namespace reemit

#include "viewer_export/vertex/surrounding_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include <gtest/gtest.h>

namespace reemit {
namespace {

/// Vertices of a slanted grid around one, those of the border of a face if `half`.
Surrounding grid_around(bool half) {
  Surrounding around;
  for (int hop = 0; hop <= static_cast<int>(Surrounding::kHops); ++hop) {
    for (int i = -hop; i <= hop; ++i)
      for (int j = half ? 0 : -hop; j <= hop; ++j) {
        if (std::max(std::abs(i), std::abs(j)) != hop) continue;
        around.vertices.push_back(static_cast<std::uint32_t>(around.vertices.size()));
        around.x.push_back(0.01 * (i + 0.3 * j));
        around.y.push_back(0.02 * j);
      }
    around.upto[static_cast<std::size_t>(hop)] = around.vertices.size();
  }
  return around;
}

double fitted(const Surrounding& around, const SurroundingFit& fit, auto&& function) {
  double sum = 0;
  for (std::size_t i = 0; i < fit.weight.size(); ++i)
    sum += static_cast<double>(fit.weight[i]) * function(around.x[i], around.y[i]);
  return sum;
}

TEST(SurroundingFit, ReproducesWhatItIsOfOrder) {
  const auto plane = [](double x, double y) { return 2 + 30 * x - 50 * y; };
  const auto second_order = [&](double x, double y) {
    return plane(x, y) + 900 * x * x - 400 * x * y + 700 * y * y;
  };
  for (const bool half : {false, true}) {
    const Surrounding around = grid_around(half);
    const SurroundingFits fits(around);
    SurroundingFit fit;
    for (std::size_t hops = 0; hops <= Surrounding::kHops; ++hops) {
      fits.fit(hops, fit);
      ASSERT_EQ(fit.weight.size(), around.upto[hops]);
      EXPECT_NEAR(fitted(around, fit, [](double, double) { return 1.0; }), 1, 1e-5);
      if (around.upto[hops] >= 5) {
        EXPECT_NEAR(fitted(around, fit, plane), 2, 1e-4);
      }
      if (around.upto[hops] >= 12) {
        EXPECT_NEAR(fitted(around, fit, second_order), 2, 1e-4);
      }
    }
  }
}

TEST(SurroundingFit, OwnWeightIsTheSumOfSquares) {
  const Surrounding around = grid_around(true);
  const SurroundingFits fits(around);
  SurroundingFit fit;
  for (std::size_t hops = 0; hops <= Surrounding::kHops; ++hops) {
    fits.fit(hops, fit);
    double squares = 0;
    for (const float w : fit.weight) squares += static_cast<double>(w) * static_cast<double>(w);
    EXPECT_NEAR(squares, fit.own_weight(), 1e-5);
    EXPECT_EQ(fit.weight[0], fit.own_weight());
  }
}

TEST(SurroundingFit, TakesTheMeanOfVerticesInALine) {
  Surrounding around;
  for (int i = 0; i < 7; ++i) {
    around.vertices.push_back(static_cast<std::uint32_t>(i));
    around.x.push_back(0.1 * (i % 2 == 0 ? i : -i));
    around.y.push_back(0);
  }
  around.upto.fill(7);
  SurroundingFit fit;
  SurroundingFits(around).fit(1, fit);
  for (const float w : fit.weight) EXPECT_FLOAT_EQ(w, 1.0F / 7);
}

}  // namespace
}  // namespace reemit

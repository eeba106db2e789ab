// Probabilities of a light tree: they sum to 1 with the dead ends, picks follow them, what is left of u is
// uniform. tests/solver/emit/light_tree_zero_test.cpp has the cases where a probability may be 0.
#include "solver/emit/light_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/solver/emit/random_luminaires.h"
#include "tests/support/chi_square.h"

namespace reemit {
namespace {

std::vector<double> probabilities(const LightTree& tree, const Vec3f& x, const Vec3f& n) {
  std::vector<double> all(tree.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = static_cast<double>(tree.probability(static_cast<std::uint32_t>(i), x, n));
  return all;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Relative rounding of a product of shares, summed.
constexpr double kRounding = 1e-6;

TEST(LightTree, ProbabilitiesSumToOneWithoutCuts) {
  // No horizon and luminaires that shine everywhere: nothing can be proven dark, so there are no dead ends.
  test::RandomLuminaires random(1);
  for (const auto& arrangement : test::arrangements(2)) {
    std::vector<LuminaireBounds> luminaires = arrangement.luminaires;
    for (LuminaireBounds& l : luminaires) l.cos_normals = -1;
    const LightTree tree(luminaires);
    ASSERT_EQ(tree.size(), luminaires.size());
    for (int i = 0; i < 20; ++i)
      EXPECT_NEAR(sum(probabilities(tree, random.in_cube(2), Vec3f::Zero())), 1, kRounding)
          << arrangement.name;
  }
}

TEST(LightTree, ProbabilitiesAndDeadEndsSumToOne) {
  // The unit interval is cut into at most one piece per child of each node; pieces that end nowhere are
  // measured at evenly spaced positions, which errs by less than one spacing per piece.
  test::RandomLuminaires random(3);
  constexpr int kPositions = 20000;
  for (const auto& arrangement : test::arrangements(4)) {
    const LightTree tree(arrangement.luminaires);
    const auto pieces = static_cast<double>(std::min<std::size_t>(2 * tree.size(), 400));
    for (int i = 0; i < 10; ++i) {
      const Vec3f x = random.in_cube(1.2F);
      const Vec3f n = random.direction();
      int dead = 0;
      for (int k = 0; k < kPositions; ++k) {
        double u = (k + 0.5) / kPositions;
        Pick pick;
        dead += !tree.pick(x, n, u, pick);
      }
      const double reached = sum(probabilities(tree, x, n));
      EXPECT_LE(reached, 1 + kRounding) << arrangement.name;
      EXPECT_NEAR(reached + static_cast<double>(dead) / kPositions, 1, kRounding + pieces / kPositions)
          << arrangement.name;
    }
  }
}

TEST(LightTree, PickGivesItsProbabilityToTheBit) {
  test::RandomLuminaires random(5);
  for (const auto& arrangement : test::arrangements(6)) {
    const LightTree tree(arrangement.luminaires);
    int picks = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3f x = random.in_cube(1.2F);
      const Vec3f n = random.direction();
      double u = random.unit();
      Pick pick;
      if (!tree.pick(x, n, u, pick)) continue;
      ++picks;
      ASSERT_LT(pick.luminaire, tree.size());
      EXPECT_EQ(pick.probability, tree.probability(pick.luminaire, x, n)) << arrangement.name;
      EXPECT_GT(pick.probability, 0);
      EXPECT_GE(u, 0);
      EXPECT_LT(u, 1);
    }
    EXPECT_GT(picks, 500) << arrangement.name;
  }
}

/// Chi-square of independent picks, dead ends as one more cell: false alarms one in 10^6 each. The same
/// counts must refuse probabilities that are 2 % off up and down in turn.
TEST(LightTree, PicksFollowTheProbabilities) {
  test::RandomLuminaires random(7);
  constexpr int kPicks = 2000000;
  for (const std::size_t count : {2, 3, 100, 5000}) {
    const LightTree tree(test::bounds_of(random.scene(count, 0.2F)));
    // The receiver of ten with the most luminaires in play.
    Vec3f x, n;
    std::vector<double> expected;
    double most = -1;
    for (int i = 0; i < 10; ++i) {
      const Vec3f at = random.in_cube(1);
      const Vec3f normal = random.direction();
      const std::vector<double> p = probabilities(tree, at, normal);
      double entropy = 0;
      for (const double v : p) entropy -= v > 0 ? v * std::log(v) : 0;
      if (entropy <= most) continue;
      most = entropy;
      x = at;
      n = normal;
      expected = p;
    }
    expected.push_back(std::max(0.0, 1 - sum(expected)));
    std::vector<double> counts(expected.size());
    for (int i = 0; i < kPicks; ++i) {
      double u = random.unit();
      Pick pick;
      counts[tree.pick(x, n, u, pick) ? pick.luminaire : count] += 1;
    }
    std::vector<double> biased = expected;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      expected[i] *= kPicks;
      biased[i] = expected[i] * (i % 2 == 0 ? 1.02 : 0.98);
    }
    const double kept = sum(biased);
    for (double& b : biased) b *= kPicks / kept;
    EXPECT_GT(test::chi_square_of_counts(counts, expected), test::kFalseAlarm) << count;
    EXPECT_LT(test::chi_square_of_counts(counts, biased), test::kFalseAlarm) << count;
  }
}

/// What is left of u falls evenly into 16 bins whatever was picked. u as it was before the pick is refused.
TEST(LightTree, RestOfUIsUniformAndIndependent) {
  test::RandomLuminaires random(8);
  constexpr int kPicks = 1000000;
  constexpr std::size_t kBins = 16;
  for (const std::size_t count : {1, 2, 100, 5000}) {
    std::vector<LuminaireBounds> luminaires;
    for (std::size_t i = 0; i < count; ++i)
      luminaires.push_back(random.of_kind(test::ShapedLuminaire::Kind::kSphere, 0.05F).bounds());
    const LightTree tree(luminaires);
    const Vec3f x = random.in_cube(0.5F);
    const Vec3f n = Vec3f::Zero();
    const std::vector<double> probability = probabilities(tree, x, n);
    std::vector<double> expected(count * kBins), counts(expected.size()), unstretched(expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
      expected[i] = kPicks * probability[i / kBins] / static_cast<double>(kBins);
    for (int i = 0; i < kPicks; ++i) {
      const double before = random.unit();
      double u = before;
      Pick pick;
      ASSERT_TRUE(tree.pick(x, n, u, pick));
      const auto cell = [&](double v) {
        return pick.luminaire * kBins + static_cast<std::size_t>(v * kBins);
      };
      counts[cell(u)] += 1;
      unstretched[cell(before)] += 1;
    }
    EXPECT_GT(test::chi_square_of_counts(counts, expected), test::kFalseAlarm) << count;
    if (count > 1) {
      EXPECT_LT(test::chi_square_of_counts(unstretched, expected), test::kFalseAlarm) << count;
    }
  }
}

TEST(LightTree, PickManyIsPickAtEvenPositions) {
  test::RandomLuminaires random(9);
  for (const auto& arrangement : test::arrangements(10)) {
    const LightTree tree(arrangement.luminaires);
    for (int i = 0; i < 100; ++i) {
      const Vec3f x = random.in_cube(1.2F);
      const Vec3f n = random.direction();
      const double u = random.unit();
      std::vector<Pick> picks(static_cast<std::size_t>(1 + i % 40));
      std::vector<double> rest(picks.size());
      const std::size_t found = tree.pick_many(x, n, u, picks, rest);
      std::size_t expected = 0;
      for (std::size_t k = 0; k < picks.size(); ++k) {
        double v = (static_cast<double>(k) + u) / static_cast<double>(picks.size());
        Pick pick;
        if (!tree.pick(x, n, v, pick)) continue;
        ASSERT_LT(expected, found);
        EXPECT_EQ(picks[expected].luminaire, pick.luminaire);
        EXPECT_EQ(picks[expected].probability, pick.probability);
        EXPECT_EQ(rest[expected], v);
        ++expected;
      }
      EXPECT_EQ(found, expected) << arrangement.name;
    }
  }
}

/// The brighter, nearer and better turned luminaire is likelier; far away the shares are those of intensity.
TEST(LightTree, ProbabilitiesFollowTheIrradiance) {
  const Vec3f x(0, 0, 0), n(0, 0, 1);
  const auto share = [&](const LuminaireBounds& a, const LuminaireBounds& b) {
    return static_cast<double>(LightTree(std::array{a, b}).probability(0, x, n));
  };
  const auto point = [](float px, float pz, float intensity) {
    return sphere_bounds({px, 0, pz}, 0, intensity);
  };
  EXPECT_NEAR(share(point(0.1F, 1, 3), point(-0.1F, 1, 1)), 0.75, 1e-5);
  EXPECT_NEAR(share(point(0, 1, 1), point(0, 2, 1)), 0.8, 1e-5);
  // Cosine over squared distance of (1,0,1): 1/sqrt(8), against 1 of (0,0,1).
  EXPECT_NEAR(share(point(1, 1, 1), point(0, 1, 1)), 1 / (1 + std::sqrt(8.0)), 1e-5);
  const auto panel = [](const Vec3f& normal) {
    const Vec3f middle(0, 0, 1);
    return flat_bounds(std::array{middle}, normal, 1);
  };
  EXPECT_NEAR(share(panel(Vec3f(0, 0.6F, -0.8F)), panel(Vec3f(0, 0, -1))), 0.8 / 1.8, 1e-5);
}

TEST(LightTree, DegenerateInputs) {
  double u = 0.25;
  Pick pick;
  EXPECT_FALSE(LightTree().pick({0, 0, 0}, {0, 0, 1}, u, pick));
  EXPECT_TRUE(LightTree(std::span<const LuminaireBounds>()).empty());
  EXPECT_EQ(u, 0.25);
  std::vector<LuminaireBounds> bad(3);
  bad[2].intensity = 0;
  EXPECT_THROW(LightTree{bad}, std::invalid_argument);

  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const auto& arrangement : test::arrangements(11)) {
    const LightTree tree(arrangement.luminaires);
    const Vec3f on = arrangement.luminaires[0].min;
    for (const Vec3f& x :
         {on, Vec3f(nan, 0, 0), Vec3f(infinity, 0, 0), Vec3f(-1e30F, 0, 0), Vec3f(1e5F, 0, 0)}) {
      for (const double start : {0.0, 0.5, std::nextafter(1.0, 0.0)}) {
        u = start;
        if (!tree.pick(x, {0, 0, 1}, u, pick)) {
          EXPECT_EQ(u, start);
          continue;
        }
        EXPECT_LT(pick.luminaire, tree.size());
        EXPECT_GT(pick.probability, 0);
        EXPECT_LE(pick.probability, 1);
        EXPECT_GE(u, 0);
        EXPECT_LT(u, 1);
      }
    }
    EXPECT_LE(sum(probabilities(tree, on, Vec3f::Zero())), 1 + kRounding) << arrangement.name;
  }
}

}  // namespace
}  // namespace reemit

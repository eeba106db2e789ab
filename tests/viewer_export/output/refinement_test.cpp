#include "viewer_export/output/refinement.h"

#include <gtest/gtest.h>

namespace reemit {
namespace {

TEST(Refinement, PartsGoOnUntilTheyAreGoodEnough) {
  RefinedPart part;
  part.look(8, 8, true);
  EXPECT_TRUE(part.is_active());
  part.look(4, 4, true);
  EXPECT_TRUE(part.is_active());
  part.look(0.9, 2, true);
  EXPECT_FALSE(part.is_active());
  EXPECT_FALSE(part.is_stalled());
  part.look(5, 5, true);
  EXPECT_FALSE(part.is_active()) << "estimates of those that stopped were low by chance";
}

TEST(Refinement, AllStopWhenTheWholeIsGoodEnough) {
  RefinedPart part;
  part.look(3, 0.99, true);
  EXPECT_FALSE(part.is_active());
}

TEST(Refinement, PartsThatMoreSamplesDoNotHelpAreGivenUp) {
  RefinedPart part;
  part.look(8, 8, true);
  part.look(7, 7, true);
  EXPECT_TRUE(part.is_active()) << "once may be chance";
  part.look(6.5, 6.5, true);
  EXPECT_FALSE(part.is_active());
  EXPECT_TRUE(part.is_stalled());
}

TEST(Refinement, OneGoodStepMakesUpForOneWithout) {
  RefinedPart part;
  for (const double excess : {16.0, 15.0, 7.0, 6.5, 3.0}) part.look(excess, excess, true);
  EXPECT_TRUE(part.is_active());
}

TEST(Refinement, OnlyDoubledSamplesTellOfStalling) {
  RefinedPart part;
  part.look(8, 8, true);
  for (int i = 0; i < 5; ++i) part.look(7.9, 7.9, false);
  EXPECT_TRUE(part.is_active());
  part.look(4, 4, true);
  EXPECT_TRUE(part.is_active());
}

}  // namespace
}  // namespace reemit

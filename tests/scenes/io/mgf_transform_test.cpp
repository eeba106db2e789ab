#include "scenes/io/mgf/mgf_transform.h"

#include <gtest/gtest.h>

#include "scenes/io/common/text_parse.h"
#include "scenes/model/error.h"
#include "scenes/model/vec.h"

namespace reemit {
namespace {

MgfTransform transform(const std::string& text) {
  const auto lines = split_lines(text);
  return MgfTransform(lines.at(0).words, "here");
}

Vec3 moved(const std::string& text, const Vec3& point, std::int64_t instance = 0) {
  return transform(text).instance(instance) * point;
}

TEST(MgfTransform, AppliesArgumentsInOrder) {
  const Vec3 p(1, 2, 3);
  EXPECT_EQ(moved("-t 1 0 -1", p), Vec3(2, 2, 2));
  EXPECT_EQ(moved("-s 2 -t 1 0 0", p), Vec3(3, 4, 6));
  EXPECT_EQ(moved("-t 1 0 0 -s 2", p), Vec3(4, 4, 6));
  EXPECT_EQ(moved("-mx", p), Vec3(-1, 2, 3));
  EXPECT_EQ(moved("-my -mz", p), Vec3(1, -2, -3));
}

TEST(MgfTransform, RotatesCounterClockwiseAndExactlyByQuarters) {
  EXPECT_EQ(moved("-rz 90", Vec3(1, 0, 0)), Vec3(0, 1, 0));
  EXPECT_EQ(moved("-rx 90", Vec3(0, 1, 0)), Vec3(0, 0, 1));
  EXPECT_EQ(moved("-ry 90", Vec3(0, 0, 1)), Vec3(1, 0, 0));
  EXPECT_EQ(moved("-rz -270", Vec3(1, 2, 3)), moved("-rz 90", Vec3(1, 2, 3)));
  EXPECT_EQ(moved("-rx 180", Vec3(1, 2, 3)), Vec3(1, -2, -3));
  EXPECT_TRUE(moved("-rz 30", Vec3(1, 0, 0)).isApprox(Vec3(std::sqrt(3) / 2, 0.5, 0), 1e-15));
  // About the centre of the object, as in the description of MGF.
  EXPECT_TRUE(moved("-t -15 0 35 -ry -20 -t 15 0 -35", Vec3(15, 4, -35)).isApprox(Vec3(15, 4, -35), 1e-15));
}

TEST(MgfTransform, RepeatsWithI) {
  EXPECT_EQ(moved("-i 3 -t 1 0 0 -i 1 -s 2", Vec3(0, 0, 0)), Vec3(6, 0, 0));
  EXPECT_EQ(moved("-i 0 -t 1 0 0", Vec3(5, 0, 0)), Vec3(5, 0, 0));
  EXPECT_EQ(transform("-i 3 -t 1 0 0").instance_count(), 1);
}

TEST(MgfTransform, MakesArraysOfArrays) {
  const MgfTransform grid = transform("-t 1 1 10 -a 3 -t 3 0 0 -a 5 -t 0 3 0 -i 1 -t 100 0 0");
  ASSERT_EQ(grid.instance_count(), 15);
  std::int64_t n = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 5; ++j, ++n)
      EXPECT_TRUE((grid.instance(n) * Vec3::Zero()).isApprox(Vec3(101 + 3 * i, 1 + 3 * j, 10))) << n;
  const MgfTransform spiral = transform("-a 6 -rz 60");
  EXPECT_TRUE((spiral.instance(2) * Vec3(1, 0, 0)).isApprox(Vec3(-0.5, std::sqrt(3) / 2, 0), 1e-14));
}

TEST(MgfTransform, RefusesWhatItCannotDo) {
  for (const char* bad : {"-t 1 2", "-t 1 2 x", "-s 0", "-s", "-rq 3", "30", "-a 0", "-a 2.5", "-a -1",
                          "-i -1", "-a 10000 -a 10000", "-rx nan"})
    EXPECT_THROW(transform(bad), InputError) << bad;
}

}  // namespace
}  // namespace reemit

#include "viewer_export/cli/option_values.h"

#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/refusal.h"

namespace reemit::cli {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(OptionValues, ShareAsPercentOrFraction) {
  EXPECT_DOUBLE_EQ(parse_share("1%"), 0.01);
  EXPECT_DOUBLE_EQ(parse_share("0.5 %"), 0.005);
  EXPECT_DOUBLE_EQ(parse_share("0.01"), 0.01);
  EXPECT_DOUBLE_EQ(parse_share("1e-3"), 0.001);
  for (const char* text :
       {"", "%", "0", "0%", "-1%", "1", "2", "100%", "1%%", "1 percent", "nan", "inf", "1,5%"}) {
    EXPECT_THROW(parse_share(text), std::invalid_argument) << text;
  }
}

TEST(OptionValues, TimeWithUnits) {
  EXPECT_DOUBLE_EQ(parse_seconds("60"), 60);
  EXPECT_DOUBLE_EQ(parse_seconds("60s"), 60);
  EXPECT_DOUBLE_EQ(parse_seconds("1.5 min"), 90);
  EXPECT_DOUBLE_EQ(parse_seconds("2h"), 7200);
  EXPECT_DOUBLE_EQ(parse_seconds("500ms"), 0.5);
  for (const char* text : {"", "s", "0", "0s", "-3s", "3 sec", "3m", "1e400", "1e308h", "60s60", "nan"}) {
    EXPECT_THROW(parse_seconds(text), std::invalid_argument) << text;
  }
}

TEST(OptionValues, CountsAreWhole) {
  EXPECT_EQ(parse_count("1"), 1U);
  EXPECT_EQ(parse_count("250000"), 250000U);
  EXPECT_EQ(parse_count("1e6"), 1000000U);
  EXPECT_EQ(parse_count("2.5e6"), 2500000U);
  EXPECT_EQ(parse_count("999999999999999999"), 999999999999999999U);
  for (const char* text :
       {"", "0", "-1", "1.5", "1e-3", "1e19", "1000000000000000001", "1e6 packets", "0x10", "inf"}) {
    EXPECT_THROW(parse_count(text), std::invalid_argument) << text;
  }
}

TEST(OptionValues, NumbersAreFinite) {
  EXPECT_DOUBLE_EQ(parse_exposure("-1.5"), -1.5);
  EXPECT_DOUBLE_EQ(parse_exposure("+2"), 2);
  EXPECT_DOUBLE_EQ(parse_positive("0.25"), 0.25);
  for (const char* text : {"", "x", "nan", "inf", "1e999", "1 2", "1e9", "-101"}) {
    EXPECT_THROW(parse_exposure(text), std::invalid_argument) << text;
  }
  EXPECT_THROW(parse_positive("0"), std::invalid_argument);
  EXPECT_THROW(parse_positive("-1"), std::invalid_argument);
}

TEST(OptionValues, Points) {
  EXPECT_EQ(parse_point("1,-2,3e-1"), Vec3(1, -2, 0.3));
  EXPECT_EQ(parse_point(" 1 , 2 , 3 "), Vec3(1, 2, 3));
  for (const char* text : {"", "1,2", "1,2,3,4", "1;2;3", "1,,3", "1,2,nan", "a,b,c"}) {
    EXPECT_THROW(parse_point(text), std::invalid_argument) << text;
    EXPECT_THROW(parse_direction(text), std::invalid_argument) << text;
  }
  EXPECT_THROW(parse_point("1e20,1,1"), std::invalid_argument);
  EXPECT_EQ(parse_direction("1e20,1,1"), Vec3(1e20, 1, 1));
}

TEST(OptionValues, PictureSizes) {
  EXPECT_EQ(parse_size("640x480").width, 640);
  EXPECT_EQ(parse_size("640x480").height, 480);
  EXPECT_EQ(parse_size("16384x1").width, 16384);
  for (const char* text :
       {"", "640", "x480", "640x", "0x480", "640x-1", "16385x1", "640X480", "6.4x4", "640x480x3"}) {
    EXPECT_THROW(parse_size(text), std::invalid_argument) << text;
  }
}

TEST(OptionValues, MessagesNameTheTextAndShowARightOne) {
  EXPECT_THAT(test::refusal_of<std::invalid_argument>([] { parse_share("two"); }),
              AllOf(HasSubstr("'two'"), HasSubstr("1%")));
}

}  // namespace
}  // namespace reemit::cli

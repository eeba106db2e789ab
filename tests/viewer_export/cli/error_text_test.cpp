#include "viewer_export/cli/error_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "viewer_export/cli/text_table.h"

namespace reemit::cli {
namespace {

using testing::HasSubstr;

TEST(RoughPercent, HasTwoDigitsAndNoExponent) {
  EXPECT_EQ(rough_percent_text(0.01234), "1.2 %");
  EXPECT_EQ(rough_percent_text(0.9996), "100 %");
  EXPECT_EQ(rough_percent_text(4.231), "423 %");
}

TEST(ErrorText, states_the_share_of_the_zones) {
  EXPECT_EQ(zones_text(ZoneBias{0.0312, 0.035}), "3.1 %");
  EXPECT_EQ(zones_text(ZoneBias{0.002, 0.0081}), "below 0.81 %");
  EXPECT_EQ(zones_text(ZoneBias{}), "none");
  EXPECT_EQ(zones_text(std::nullopt), "not known");
}

TEST(ErrorText, json_holds_both_numbers_or_null) {
  nlohmann::ordered_json json;
  add_zones(json, ZoneBias{0.03, 0.04});
  EXPECT_EQ(json["zone_error"], 0.03);
  EXPECT_EQ(json["zone_error_bound"], 0.04);
  add_zones(json, std::nullopt);
  EXPECT_TRUE(json["zone_error"].is_null());
  EXPECT_TRUE(json["zone_error_bound"].is_null());
}

TEST(ErrorText, says_when_the_zones_alone_miss_a_target) {
  const std::string text = missed_by_zones("the picture", 0.01, ZoneBias{0.0312, 0.035});
  EXPECT_THAT(text, HasSubstr("the picture"));
  EXPECT_THAT(text, HasSubstr("1 %"));
  EXPECT_THAT(text, HasSubstr("3.1 %"));
  EXPECT_THAT(text, HasSubstr("--zones"));
  EXPECT_EQ(missed_by_zones("the picture", 0.05, ZoneBias{0.0312, 0.035}), "");
  EXPECT_EQ(missed_by_zones("the picture", 0, ZoneBias{0.0312, 0.035}), "") << "no target";
  EXPECT_EQ(missed_by_zones("the picture", 0.01, ZoneBias{0.02, 0.05}), "") << "noise may be all of it";
  EXPECT_EQ(missed_by_zones("the picture", 0.01, std::nullopt), "");
}

}  // namespace
}  // namespace reemit::cli

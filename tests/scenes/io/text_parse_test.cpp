#include "scenes/io/common/text_parse.h"

#include <gtest/gtest.h>

namespace reemit {
namespace {

TEST(TextParse, NumbersMustBeWholeAndFinite) {
  EXPECT_EQ(parse_number("1.5"), 1.5);
  EXPECT_EQ(parse_number(".5"), 0.5);
  EXPECT_EQ(parse_number("+2"), 2);
  EXPECT_EQ(parse_number("-3.e2"), -300);
  for (const char* bad : {"", "+", "-", "1.5x", "1,5", "nan", "inf", "-inf", "1e999", "0x10", "+-1", " 1"})
    EXPECT_FALSE(parse_number(bad)) << bad;
  EXPECT_EQ(parse_integer("-12"), -12);
  for (const char* bad : {"", "1.0", "99999999999999999999", "1a"}) EXPECT_FALSE(parse_integer(bad)) << bad;
}

TEST(TextParse, LinesKeepTheirNumbersAcrossJoinsAndLineEnds) {
  const std::string text = "a b\r\n\n  c \\\n\t d\\\r\ne\rf\\ g \\";
  const auto lines = split_lines(text);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].number, 1U);
  EXPECT_EQ(lines[0].words, (std::vector<std::string_view>{"a", "b"}));
  EXPECT_EQ(lines[1].number, 3U);
  EXPECT_EQ(lines[1].words, (std::vector<std::string_view>{"c", "d", "e"}));
  EXPECT_EQ(lines[2].number, 6U);
  EXPECT_EQ(lines[2].words, (std::vector<std::string_view>{"f\\", "g", "\\"}));
}

TEST(TextParse, AByteOrderMarkIsNoPartOfTheFirstWord) {
  const auto lines = split_lines("\xEF\xBB\xBFmtllib a.mtl\nv 1 2 3\n");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].words.front(), "mtllib");
}

}  // namespace
}  // namespace reemit

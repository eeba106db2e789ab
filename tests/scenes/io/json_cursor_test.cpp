#include "scenes/io/common/json_cursor.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/scenes/io/expect_input_error.h"

namespace reemit {
namespace {

using test::expect_input_error;

const std::string kFile = "room.json";

TEST(ParseJson, AllowsComments) {
  EXPECT_EQ(parse_json("// one\n{\"a\": 1 /* two */}", kFile)["a"], 1);
}

TEST(ParseJson, NamesTheLineOfASyntaxError) {
  expect_input_error([] { parse_json("{\n\"a\": 1,\n}", kFile); }, {"room.json:3", "syntax error"});
}

TEST(ParseJson, RefusesAKeyThatStandsTwice) {
  expect_input_error([] { parse_json(R"({"a": [1, {"b": 1, "c": 2, "b": 3}]})", kFile); },
                     {"room.json#/a/1", "\"b\" is given twice"});
  EXPECT_NO_THROW(parse_json(R"({"a": {"b": 1}, "c": {"b": 2}, "d": [{"b": 1}, {"b": 2}]})", kFile));
}

TEST(ParseJson, RefusesDeepNestingAndHugeNumbers) {
  expect_input_error([] { parse_json(std::string(100000, '['), kFile); }, {"nested deeper than 64"});
  expect_input_error([] { parse_json("[1e999]", kFile); }, {"1e999"});
  expect_input_error([] { parse_json(R"({"a": [{"b": 1}, {"c": 2, "d/e": -1e400}]})", kFile); },
                     {"room.json#/a/1/d~1e", "-1e400"});
}

TEST(JsonCursor, NamesThePlaceOfAWrongValue) {
  const auto document = parse_json(R"({"a/b": [0, {"c": "text"}]})", kFile);
  const JsonCursor root(document, kFile);
  expect_input_error([&] { root.at("a/b")[1].at("c").number(); },
                     {"room.json#/a~1b/1/c", "expected a number"});
  expect_input_error([&] { root.at("missing"); }, {"room.json#", "\"missing\" is missing"});
}

TEST(JsonCursor, SuggestsTheNearestKey) {
  const auto document = parse_json(R"({"reflectence": 0.5})", kFile);
  const JsonCursor root(document, kFile);
  expect_input_error(
      [&] {
        root.expect_object({"radiance", "reflectance"});
      },
      {"#/reflectence", "unknown key", "Did you mean \"reflectance\"?", "radiance, reflectance"});
}

TEST(JsonCursor, ChecksRanges) {
  const auto document = parse_json(R"({"n": 1.5, "count": 7, "less": -5})", kFile);
  const JsonCursor root(document, kFile);
  EXPECT_EQ(root.at("count").integer_in(0, 7), 7);
  expect_input_error([&] { root.at("count").integer_in(0, 6); }, {"#/count", "0 to 6"});
  expect_input_error([&] { root.at("n").integer_in(0, 6); }, {"whole number"});
  expect_input_error([&] { root.at("n").number_in(0, 1); }, {"out of range"});
  EXPECT_EQ(root.at("n").strength(), 1.5);
  expect_input_error([&] { root.at("less").strength(); }, {"#/less", "-5 is out of range", "above 0"});
}

TEST(NearestName, FindsTyposButNotStrangers) {
  EXPECT_EQ(nearest_name("whiet", {"white", "black"}), "white");
  EXPECT_EQ(nearest_name("ceiling", {"white", "black"}), "");
  EXPECT_EQ(nearest_name(std::string(10000, 'x'), {"white"}), "");
}

}  // namespace
}  // namespace reemit

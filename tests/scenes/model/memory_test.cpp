#include "scenes/model/memory.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/model/error.h"

namespace reemit {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(Memory, MoreThanThereIsIsRefusedWithBothNumbers) {
  try {
    check_memory("room.gltf: 7600000 triangles", 8e9, 2'000'000'000);
    FAIL() << "not refused";
  } catch (const ResourceError& problem) {
    EXPECT_THAT(problem.what(), AllOf(HasSubstr("room.gltf: 7600000 triangles"), HasSubstr("8 GB of memory"),
                                      HasSubstr("2 GB are free"), HasSubstr("Simplify")));
  }
}

TEST(Memory, WhatFitsOrCannotBeToldIsTried) {
  EXPECT_NO_THROW(check_memory("room", 1e9, 2'000'000'000));
  EXPECT_NO_THROW(check_memory("room", 1e18, std::nullopt));
}

TEST(Memory, ThereIsSomeLeft) {
  const auto available = available_memory();
  if (available) {
    EXPECT_GT(*available, 1'000'000u);
  }
}

}  // namespace
}  // namespace reemit

#include "viewer_export/still/pixel_groups.h"

#include <cstdint>
#include <set>

#include <gtest/gtest.h>

namespace reemit {
namespace {

TEST(PixelGroups, aligned_squares_are_runs_of_numbers) {
  for (std::uint32_t side = 1; side <= 64; side *= 2)
    for (std::uint32_t y0 = 0; y0 < 64; y0 += side)
      for (std::uint32_t x0 = 0; x0 < 64; x0 += side) {
        std::set<std::uint32_t> numbers;
        for (std::uint32_t y = y0; y < y0 + side; ++y)
          for (std::uint32_t x = x0; x < x0 + side; ++x)
            numbers.insert(place_in_group(128 + x, 64 + y).number);
        ASSERT_EQ(numbers.size(), side * side);
        EXPECT_EQ(*numbers.rbegin() - *numbers.begin(), side * side - 1);
        EXPECT_EQ(*numbers.begin() % (side * side), 0U);
      }
}

TEST(PixelGroups, squares_of_a_picture_are_groups_of_their_own) {
  std::set<std::uint64_t> groups;
  for (std::uint32_t y = 0; y < 1024; y += 64)
    for (std::uint32_t x = 0; x < 4096; x += 64) {
      EXPECT_EQ(place_in_group(x, y).group, place_in_group(x + 63, y + 63).group);
      groups.insert(place_in_group(x, y).group);
    }
  EXPECT_EQ(groups.size(), 16U * 64U);
}

}  // namespace
}  // namespace reemit

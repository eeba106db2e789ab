#include "mesh/geometry/find_in_blocks.h"

#include <atomic>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

namespace reemit {
namespace {

/// A list that grows by what was found from it.
std::vector<double> grown(std::size_t count, int threads) {
  std::vector<double> list{1, 2, 3};
  const WorkWatch watch;
  tbb::task_arena(threads).execute([&] {
    find_in_blocks<double>(
        count, WorkStep(watch, 0, 1),
        [&] {
          return [&, scratch = std::vector<double>()](std::size_t i, double& found) mutable {
            scratch.assign({list[i % list.size()], list[(7 * i) % list.size()], list.back()});
            found = 1e-3 * (scratch[0] + scratch[1] - scratch[2]);
          };
        },
        [&](std::size_t i, double found) { list.push_back(found + static_cast<double>(i)); });
  });
  return list;
}

TEST(FindInBlocks, UsesEachItemOnceAndInOrderOnAnyNumberOfThreads) {
  for (const std::size_t count : {0U, 1U, 1000U, 5000U}) {
    const std::vector<double> one = grown(count, 1);
    ASSERT_EQ(one.size(), count + 3);
    for (std::size_t i = 0; i < count; ++i) {
      const auto number = static_cast<double>(i);
      EXPECT_NEAR(one[3 + i], number, 0.02 * number + 0.01);
    }
    EXPECT_EQ(one, grown(count, 4));
  }
}

TEST(FindInBlocks, EndsWhereItsWatchOrAFunctionThrows) {
  const WorkWatch watch;
  std::size_t used = 0;
  const auto find_nothing = [] { return [](std::size_t, int&) {}; };
  const auto count_up_to = [&](std::size_t i, int) {
    if (i == 1500) throw std::runtime_error("enough");
    ++used;
  };
  EXPECT_THROW(find_in_blocks<int>(4000, WorkStep(watch, 0, 1), find_nothing, count_up_to),
               std::runtime_error);
  EXPECT_EQ(used, 1500);
  const auto refuse = [] { return [](std::size_t, int&) { throw std::runtime_error("not that one"); }; };
  EXPECT_THROW(find_in_blocks<int>(4000, WorkStep(watch, 0, 1), refuse, count_up_to), std::runtime_error);
  const std::atomic<bool> interrupt{true};
  const WorkWatch interrupted({}, StopToken(interrupt));
  EXPECT_THROW(find_in_blocks<int>(4000, WorkStep(interrupted, 0, 1), find_nothing, count_up_to),
               Interrupted);
}

}  // namespace
}  // namespace reemit

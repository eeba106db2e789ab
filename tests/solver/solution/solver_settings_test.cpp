#include "solver/solution/solver_settings.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "scenes/model/error.h"
#include "solver/progressive_solver.h"
#include "tests/support/test_rooms.h"
#include "tests/support/variable_furnace.h"

namespace reemit {
namespace {

TEST(SolverSettings, OutOfRangeAreRefusedBeforeARunBegins) {
  const test::VariableFurnace furnace(1);
  const auto starts = [&](auto&& change) {
    SolverSettings settings;
    change(settings);
    new_solution(furnace.room().scene(), furnace.room().mesh(), settings);
  };
  EXPECT_NO_THROW(starts([](SolverSettings&) {}));
  const double nan = std::nan("");
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double error : {nan, -1.0, 1.0})
    EXPECT_THROW(starts([&](SolverSettings& s) { s.error_target = error; }), InputError) << error;
  for (const double seconds : {nan, -1.0, infinity})
    EXPECT_THROW(starts([&](SolverSettings& s) { s.time_limit_s = seconds; }), InputError) << seconds;
  for (const double share : {nan, 0.0, 5.0})
    EXPECT_THROW(starts([&](SolverSettings& s) { s.stop_share = share; }), InputError) << share;
  for (const int count : {1, 0, -5, 65537})
    EXPECT_THROW(starts([&](SolverSettings& s) { s.smallest_batch_count = count; }), InputError) << count;
  EXPECT_THROW(starts([](SolverSettings& s) { s.batch_packets = kMostBatchPackets + 1; }), InputError);
  EXPECT_THROW(starts([](SolverSettings& s) { s.threads = -3; }), InputError);
}

}  // namespace
}  // namespace reemit

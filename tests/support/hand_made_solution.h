#pragma once
#include <algorithm>

#include "solver/solution/solution.h"
#include "tests/support/test_rooms.h"

namespace reemit::test {

/// A solution in which every zone, front and back, has the given irradiances [W/m2] in all bands, as if one
/// batch had found them.
inline Solution uniform_solution(const RoomBuilder& room, double direct, double indirect) {
  Solution solution;
  solution.bands = room.scene().bands;
  keep_surfaces(room.scene(), solution);
  solution.mesh = room.mesh().mesh;
  ZoneSums& sums = solution.sums;
  sums.clear(solution.mesh.zone_count(), channels_of(room.scene()), false);
  const std::size_t values = sums.direct.size();
  sums.count_batch(1);
  sums.direct.assign(values, direct);
  sums.direct_cross = sums.direct;
  sums.direct_squared.assign(values, direct * direct);
  sums.indirect.assign(values, indirect);
  sums.indirect_cross = sums.indirect;
  sums.indirect_squared.assign(values, indirect * indirect);
  const double total = direct + indirect;
  sums.total_squared.assign(values, total * total);
  std::fill_n(sums.group_total.begin(), values, total);
  return solution;
}

/// A solution in which nothing has arrived anywhere.
inline Solution dark_solution(const RoomBuilder& room) {
  return uniform_solution(room, 0, 0);
}

}  // namespace reemit::test

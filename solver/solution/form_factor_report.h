#pragma once
#include <cstddef>
#include <cstdint>

namespace reemit {

/// Sums of form factors over the rows of zones: 1 where no light can leave.
struct RowSums {
  double lowest = 0;
  double highest = 0;
  double rms_deviation = 0;  ///< From 1, over the zones of closed rooms; 0 if there are none.
};

/// How form factors came about.
struct FormFactorReport {
  std::uint64_t facing_pairs = 0;   ///< Unordered pairs of zones that see each other if nothing is between.
  std::uint64_t open_pairs = 0;     ///< Of these: no surface lies where it could come between; exact.
  std::uint64_t walled_pairs = 0;   ///< One triangle blocks all of the view; exactly 0.
  std::uint64_t clear_pairs = 0;    ///< Of the others: no ray was blocked; taken as exact.
  std::uint64_t hidden_pairs = 0;   ///< Every ray was blocked; taken as 0.
  std::uint64_t sampled_pairs = 0;  ///< Partly visible: the visible share is sampled and has an error.
  std::uint64_t rays = 0;
  std::size_t zones = 0;
  std::size_t closed_zones = 0;  ///< In rooms that no ray left.
  RowSums before, after;         ///< Without and with enforced closure.
};

}  // namespace reemit

#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

namespace reemit {

// Between structures in memory and datasets, which hold one member of all of them.

/// value_of(item) of each.
template <class T, class Range, class Function>
std::vector<T> column(const Range& range, Function&& value_of) {
  std::vector<T> values;
  for (const auto& item : range) values.push_back(static_cast<T>(value_of(item)));
  return values;
}

/// The values of values_of(item) of each, one item after the other.
template <class T, class Range, class Function>
std::vector<T> flattened(const Range& range, Function&& values_of) {
  std::vector<T> flat;
  for (const auto& item : range)
    for (const auto& value : values_of(item)) flat.push_back(static_cast<T>(value));
  return flat;
}

template <class T>
bool all_finite(const std::vector<T>& values) {
  return std::all_of(values.begin(), values.end(), [](T x) { return std::isfinite(x); });
}

}  // namespace reemit

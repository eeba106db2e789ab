#pragma once
#include <vector>

#include "scenes/model/vec.h"

namespace reemit::bench {

/// A point or direction that was given as three numbers (ProgramOption::count(3)). Throws std::out_of_range
/// if there are fewer.
inline Vec3 vector_of(const std::vector<double>& numbers) {
  return {numbers.at(0), numbers.at(1), numbers.at(2)};
}

}  // namespace reemit::bench

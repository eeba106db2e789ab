#pragma once
#include "scenes/model/scene.h"

namespace reemit {

/// Adds the counts of a part of a room to those of the whole.
inline void add_counts(const KindCounts& part, KindCounts& whole) {
  for (const auto& [kind, count] : part) whole[kind] += count;
}

}  // namespace reemit

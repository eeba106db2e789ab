#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "scenes/model/work_watch.h"

namespace reemit {

/// Finds something for each of `count` items, a block of them at once, and uses it in their order, so that
/// what comes of it does not depend on the number of threads. `new_find()` gives a function
/// find(i, Found&) for a share of a block; shares go side by side, each with a function, and so scratch, of
/// its own. A Found was used for another item before. `use(i, Found&)` follows for the items of the block,
/// one after the other, and may change what those of later blocks are found from. Throws what `step`, which
/// is asked before every block, and the functions throw.
template <class Found, class NewFind, class Use>
void find_in_blocks(std::size_t count, const WorkStep& step, const NewFind& new_find, const Use& use) {
  constexpr std::size_t kBlock = 1024;
  constexpr std::size_t kSmallestShare = 16;
  std::vector<Found> found(std::min(count, kBlock));
  for (std::size_t first = 0; first < count; first += kBlock) {
    step.at(first, count);
    const std::size_t last = std::min(first + kBlock, count);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(first, last, kSmallestShare), [&](const auto& share) {
      auto find = new_find();
      for (std::size_t i = share.begin(); i < share.end(); ++i) find(i, found[i - first]);
    });
    for (std::size_t i = first; i < last; ++i) use(i, found[i - first]);
  }
}

}  // namespace reemit

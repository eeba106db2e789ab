#pragma once
#include <cstddef>
#include <vector>

#include <tbb/parallel_for.h>

namespace reemit {

/// Makes each of the empty planes `size` zeros, on all threads: what takes time is that the system hands the
/// memory out. Throws std::bad_alloc.
inline void allocate_planes(const std::vector<std::vector<float>*>& planes, std::size_t size) {
  tbb::parallel_for(std::size_t{0}, planes.size(), [&](std::size_t i) { planes[i]->resize(size); });
}

}  // namespace reemit

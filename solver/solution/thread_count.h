#pragma once
#include <algorithm>

#include <tbb/info.h>

namespace reemit {

/// Threads for settings that ask for `wished` of them: at most one for each core, of which 0 means all.
inline int thread_count(int wished) {
  const int cores = tbb::info::default_concurrency();
  return wished > 0 ? std::min(wished, cores) : cores;
}

}  // namespace reemit

#pragma once
#include <cstddef>

#include <tbb/global_control.h>

#include "solver/solution/thread_count.h"

namespace reemit::cli {

/// Holds all that a command does to the threads that its user grants, meshing and writing too, which have no
/// settings of their own. 0 means all cores.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads)
      : limit_(tbb::global_control::max_allowed_parallelism,
               static_cast<std::size_t>(thread_count(threads))) {}

 private:
  tbb::global_control limit_;
};

}  // namespace reemit::cli

#pragma once
#include <atomic>

namespace reemit::test {

/// The interrupt of work that nobody interrupts.
inline const std::atomic<bool> kNever{false};

}  // namespace reemit::test

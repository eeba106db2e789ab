#pragma once
#include <stdexcept>

namespace reemit {

/// An interrupt ended work that has no partial result.
class Interrupted : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace reemit

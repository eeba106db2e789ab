#pragma once
#include <stdexcept>
#include <string>

namespace reemit {

/// Something in a solution file that cannot be; becomes an InputError that names the file.
class FileDamage : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws FileDamage unless the condition holds.
inline void require_intact(bool condition, const std::string& problem) {
  if (!condition) throw FileDamage(problem);
}

}  // namespace reemit

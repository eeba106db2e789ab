#pragma once
#include <stdexcept>
#include <string>

namespace reemit {

/// Bad input or bad usage; the program ends with exit code 2. The message says where, what, and what to do.
class InputError : public std::runtime_error {
 public:
  /// `where`: file:line, JSON pointer or option; `problem`: what is wrong; `advice`: what to do about it.
  InputError(const std::string& where, const std::string& problem, const std::string& advice)
      : std::runtime_error(where + ": " + problem + (advice.empty() ? "" : "\n  " + advice)) {}
};

/// Out of memory, disk full, unwritable output. The program ends with exit code 2 when the output is at
/// fault, else 3.
class ResourceError : public std::runtime_error {
 public:
  ResourceError(const std::string& where, const std::string& problem, const std::string& advice)
      : std::runtime_error(where + ": " + problem + (advice.empty() ? "" : "\n  " + advice)) {}
};

}  // namespace reemit

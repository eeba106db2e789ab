#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace reemit {

/// Memory that this process can still get without driving the machine into swapping [bytes]: what the system
/// has to spare, within the limits on the process and its container. Nothing where the system does not say.
std::optional<std::uint64_t> available_memory();

/// The most memory that this process has had in use at once so far [bytes].
std::uint64_t peak_memory();

/// Throws ResourceError if `what` needs clearly more memory than there is, before it is spent. `needed`
/// [bytes] should rather be too small: a room that might just fit is tried.
void check_memory(const std::string& what, double needed, std::optional<std::uint64_t> available);
/// The same for what takes time to name.
void check_memory(const std::function<std::string()>& what, double needed,
                  std::optional<std::uint64_t> available);

}  // namespace reemit

#include "scenes/model/memory.h"

#include <algorithm>
#include <fstream>
#include <limits>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include "scenes/model/error.h"

namespace reemit {
namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

/// The number in a file that holds one, such as those of control groups; without a limit they say "max".
std::optional<std::uint64_t> number_in(const char* file) {
  std::ifstream stream(file);
  std::uint64_t number = 0;
  if (stream >> number) return number;
  return std::nullopt;
}

/// Sum of two lines of /proc/meminfo.
std::optional<std::uint64_t> free_of_machine() {
  std::ifstream stream("/proc/meminfo");
  std::string name;
  std::uint64_t kilobytes = 0;
  std::string unit;
  std::optional<std::uint64_t> sum;
  while (stream >> name >> kilobytes && std::getline(stream, unit))
    if (name == "MemAvailable:" || name == "SwapFree:") sum = sum.value_or(0) + 1024 * kilobytes;
  return sum;
}

std::uint64_t left_of(std::uint64_t limit, std::uint64_t used) {
  return limit > used ? limit - used : 0;
}

/// Address space that the process may still take.
std::uint64_t free_of_process() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
  const std::optional<std::uint64_t> pages = number_in("/proc/self/statm");
  return left_of(limit.rlim_cur, pages.value_or(0) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)));
}

/// What a container's limit leaves. Its use counts cached files, of which those not in use are given up
/// before anything else is refused.
std::uint64_t free_of_container() {
  const auto limit = number_in("/sys/fs/cgroup/memory.max");
  const auto used = number_in("/sys/fs/cgroup/memory.current");
  if (!limit || !used) return kUnlimited;
  std::ifstream stream("/sys/fs/cgroup/memory.stat");
  std::string name;
  std::uint64_t bytes = 0;
  std::uint64_t cached = 0;
  while (stream >> name >> bytes)
    if (name == "inactive_file") cached = bytes;
  return left_of(*limit, left_of(*used, cached));
}

}  // namespace

std::optional<std::uint64_t> available_memory() {
  const std::optional<std::uint64_t> machine = free_of_machine();
  if (!machine) return std::nullopt;
  return std::min({*machine, free_of_process(), free_of_container()});
}

std::uint64_t peak_memory() {
  rusage used{};
  if (getrusage(RUSAGE_SELF, &used) != 0) return 0;
  constexpr std::uint64_t kKilobyte = 1024;  // Linux counts in them
  return kKilobyte * static_cast<std::uint64_t>(used.ru_maxrss);
}

void check_memory(const std::string& what, double needed, std::optional<std::uint64_t> available) {
  check_memory([&] { return what; }, needed, available);
}

void check_memory(const std::function<std::string()>& what, double needed,
                  std::optional<std::uint64_t> available) {
  if (!available || needed <= static_cast<double>(*available)) return;
  constexpr double kGigabyte = 1e9;
  throw ResourceError(what(),
                      fmt::format("takes at least {:.2g} GB of memory, and {:.2g} GB are free",
                                  needed / kGigabyte, static_cast<double>(*available) / kGigabyte),
                      "Simplify the room, close other programs, or use a machine with more memory.");
}

}  // namespace reemit

#pragma once
#include <fstream>
#include <string>

namespace reemit::bench {

/// Of the machine, as pages name it beside what was measured there.
inline std::string processor_name() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

}  // namespace reemit::bench

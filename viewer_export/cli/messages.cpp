#include "viewer_export/cli/messages.h"

#include <cstdio>
#include <set>

#include <fmt/format.h>

namespace reemit::cli {

void print_warnings(const std::vector<std::string>& warnings) {
  std::set<std::string> seen;
  for (const std::string& warning : warnings) {
    if (seen.insert(warning).second) fmt::print(stderr, "reemit: warning: {}\n", warning);
  }
}

void print_note(const std::string& note) {
  fmt::print(stderr, "reemit: {}\n", note);
}

}  // namespace reemit::cli

#pragma once
#include <string>
#include <vector>

namespace reemit::cli {

/// Prints each different warning once, as "reemit: warning: ...", to stderr.
void print_warnings(const std::vector<std::string>& warnings);
/// Prints "reemit: ..." to stderr.
void print_note(const std::string& note);

}  // namespace reemit::cli

#pragma once
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace reemit::cli {

// What the program says never ends a run: a solution is worth more than a line about it. On stderr a line
// that cannot be written is lost; on stdout checked_output tells at the end.

/// Gives standard streams that the caller closed a place of their own, so that no file of ours gets their
/// numbers and what is printed ends up in it. To be called before any file is opened.
void claim_standard_streams();

/// Prints to stderr as it stands.
void print_error_text(std::string_view text);
/// Prints each different warning once, as "reemit: warning: ...", to stderr.
void print_warnings(const std::vector<std::string>& warnings);
/// Prints "reemit: ..." to stderr.
void print_note(const std::string& note);

/// Prints a result to stdout.
void print_result(std::string_view text);
/// Prints a JSON document to stdout; bytes that are not UTF-8 (of paths) become U+FFFD, as JSON demands.
void print_json(const nlohmann::ordered_json& document);

/// Writes what is still in the buffer; false if any result did not arrive. Where the reader of a pipe has
/// left (`reemit info room.json | head -1`) the program ends here as by SIGPIPE.
bool results_arrived();

}  // namespace reemit::cli

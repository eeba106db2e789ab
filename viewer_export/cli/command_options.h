#pragma once
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

namespace reemit::cli {

/// Options that most subcommands share.
struct OutputStyle {
  bool json = false;     ///< Results on stdout as one JSON document.
  bool quiet = false;    ///< Neither progress nor warnings.
  bool verbose = false;  ///< Progress lines even where stderr is not a terminal.
};

inline void add_progress_options(CLI::App& command, OutputStyle& style) {
  auto* quiet = command.add_flag("--quiet,-q", style.quiet, "No progress, notes or warnings on stderr");
  command.add_flag("--verbose,-v", style.verbose, "Progress lines on stderr even if it is not a terminal")
      ->excludes(quiet);
}

inline void add_json_option(CLI::App& command, OutputStyle& style) {
  command.add_flag("--json", style.json, "Print the result as one JSON document");
}

/// An option whose text `parse` turns into the value; its std::invalid_argument becomes a usage error.
template <class Target, class Parse>
CLI::Option* add_parsed_option(CLI::App& command, const std::string& names, Target& target, Parse parse,
                               const std::string& type, const std::string& help) {
  const std::function<void(const std::string&)> read = [&target, parse, names](const std::string& text) {
    try {
      target = parse(text);
    } catch (const std::invalid_argument& problem) {
      throw CLI::ValidationError(names, problem.what());
    }
  };
  return command.add_option_function(names, read, help)->type_name(type);
}

}  // namespace reemit::cli

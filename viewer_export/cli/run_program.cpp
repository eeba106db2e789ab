#include <cstdio>
#include <filesystem>
#include <memory>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "scenes/io/common/json_cursor.h"
#include "scenes/model/error.h"
#include "scenes/model/interrupted.h"
#include "viewer_export/cli/command_options.h"
#include "viewer_export/cli/commands.h"
#include "viewer_export/cli/messages.h"
#include "viewer_export/cli/output_path.h"

namespace reemit::cli {
namespace {

std::vector<std::string> known_words(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
  }
  for (const CLI::App* subcommand : command.get_subcommands([](const CLI::App*) { return true; })) {
    words.push_back(subcommand->get_name());
  }
  return words;
}

/// What is meant where the three numbers of a point are words of their own, as in "--eye 1 2 3"; else empty.
std::string spaced_point(const CLI::App& command, std::span<const std::string> words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string name = words[i].substr(0, words[i].find('='));
    const CLI::Option* option = command.get_option_no_throw(name);
    if (!name.starts_with("--") || option == nullptr || option->get_type_name() != kPointType) continue;
    std::vector<std::string> numbers(words.begin() + static_cast<std::ptrdiff_t>(i) + 1, words.end());
    if (name != words[i]) numbers.insert(numbers.begin(), words[i].substr(name.size() + 1));
    const std::string point = joined_point(numbers);
    if (!point.empty()) return fmt::format("{} takes one word; write {} {}", name, name, point);
  }
  return "";
}

/// What to say about a command line that does not parse.
std::string usage_message(const CLI::App& program, const CLI::ParseError& error,
                          std::span<const std::string> words) {
  const auto chosen = program.get_subcommands();
  const CLI::App& command = chosen.empty() ? program : *chosen.front();
  std::string message = error.what();
  const std::vector<std::string> unknown = program.remaining(true);
  if (!unknown.empty()) {
    message = fmt::format("unknown argument '{}'", unknown.front());
    const std::string word = unknown.front().substr(0, unknown.front().find('='));
    const std::string suggestion = nearest_name(word, known_words(command));
    if (!suggestion.empty()) message += fmt::format("; did you mean '{}'?", suggestion);
  }
  const std::string point = spaced_point(command, words);
  if (!point.empty()) message = point;
  const std::string name = chosen.empty() ? "reemit" : "reemit " + command.get_name();
  return fmt::format("{}\n  '{} --help' lists what it takes", message, name);
}

ExitCode fail(const std::string& message, ExitCode code) {
  std::fflush(stdout);
  print_error_text(fmt::format("reemit: error: {}\n", message));
  return code;
}

/// What printed last may still wait in a buffer when the disk behind stdout is full.
ExitCode checked_output(ExitCode code) {
  return results_arrived() ? code : fail("standard output: cannot write", ExitCode::kBadInput);
}

ExitCode parse_and_run(CLI::App& program, const Action& action, int argc, const char* const* argv) {
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::Success)) {
      return fail(usage_message(program, error, std::vector<std::string>(argv + 1, argv + argc)),
                  ExitCode::kBadInput);
    }
    program.exit(error);  // prints the help or the version
    return checked_output(ExitCode::kDone);
  }
  return checked_output(action());
}

}  // namespace

ExitCode run_program(int argc, const char* const* argv) {
  constexpr const char* kMemoryAdvice =
      "out of memory\n  use fewer zones (solve --zones) or a smaller picture (render --size)";
  try {
    Action action;
    const std::unique_ptr<CLI::App> program = make_program(action);
    return parse_and_run(*program, action, argc, argv);
  } catch (const Interrupted& end) {
    return fail(fmt::format("{}; nothing was written", end.what()), ExitCode::kInterrupted);
  } catch (const ResourceError& problem) {
    return fail(problem.what(), ExitCode::kNoResources);
  } catch (const std::bad_alloc&) {
    return fail(kMemoryAdvice, ExitCode::kNoResources);
  } catch (const std::length_error&) {
    return fail(kMemoryAdvice, ExitCode::kNoResources);
  } catch (const std::filesystem::filesystem_error& problem) {
    return fail(problem.what(), ExitCode::kBadInput);
  } catch (const std::system_error& problem) {  // of threads, in the main
    return fail(
        fmt::format("the system gives no further threads or memory ({})\n  Raise its limits (ulimit -u, "
                    "ulimit -v, those of the container), or use fewer --threads.",
                    problem.what()),
        ExitCode::kNoResources);
  } catch (
      const std::exception& problem) {  // InputError, OutputError, and what a library throws on bad input
    return fail(problem.what(), ExitCode::kBadInput);
  }
}

}  // namespace reemit::cli

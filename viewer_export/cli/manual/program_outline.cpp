#include "viewer_export/cli/manual/program_outline.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>

#include <CLI/CLI.hpp>

namespace reemit::cli {
namespace {

std::vector<std::string> parts_of(const std::string& value) {
  std::vector<std::string> parts = CLI::detail::split(value, '|');
  std::erase(parts, "");
  return parts;
}

/// Of "hits|zones" with a default both; of "NAME|all" the second, for capitals stand for something else.
std::vector<std::string> typed_words(const std::vector<std::string>& parts,
                                     const std::string& default_value) {
  if (parts.size() < 2) return {};
  if (parts.front() == default_value) return parts;
  std::vector<std::string> words;
  for (const std::string& part : parts)
    if (std::none_of(part.begin(), part.end(), [](unsigned char c) { return std::isupper(c) != 0; }))
      words.push_back(part);
  return words;
}

bool stands_for_file(std::string_view part) {
  return part == "ROOM" || part == "SOLUTION" || part == "FILE" || part == "DIR/";
}

std::string longest_name(const CLI::Option& option) {
  return option.get_lnames().empty() ? option.get_name(true) : "--" + option.get_lnames().front();
}

/// By name: the sets of CLI11 are in the order of addresses, which differs from run to run.
std::vector<std::string> sorted_names(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(longest_name(*option));
  std::sort(names.begin(), names.end());
  return names;
}

OptionOutline outline_of_option(const CLI::Option& option) {
  OptionOutline outline;
  for (const std::string& name : option.get_snames()) outline.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) outline.names.push_back("--" + name);
  outline.default_value = option.get_default_str();
  if (option.get_items_expected_max() > 0) {
    const std::string type = option.get_type_name();  // "DEG:FLOAT in [0.1 - 179]"
    const std::size_t colon = std::min(type.find(':'), type.size());
    outline.value = type.substr(0, colon);
    if (colon < type.size()) outline.limits = type.substr(colon + 1);
    const std::vector<std::string> parts = parts_of(outline.value);
    outline.words = typed_words(parts, outline.default_value);
    outline.takes_file = std::any_of(parts.begin(), parts.end(), stands_for_file);
  }
  outline.required = option.get_required();
  outline.repeats = option.get_items_expected_max() > 1;
  outline.needs = sorted_names(option.get_needs());
  outline.excludes = sorted_names(option.get_excludes());
  outline.help = option.get_description();
  return outline;
}

CommandOutline outline_of_command(const CLI::App& command) {
  CommandOutline outline;
  outline.name = command.get_name();
  outline.description = command.get_description();
  outline.footer = command.get_footer();
  for (const std::string& name : command.get_groups()) {
    OptionGroup group{name, {}};
    for (const CLI::Option* option : command.get_options()) {
      if (option->get_group() != name) continue;
      auto& place = option->get_positional() ? outline.positionals : group.options;
      place.push_back(outline_of_option(*option));
    }
    if (!group.options.empty()) outline.groups.push_back(std::move(group));
  }
  return outline;
}

}  // namespace

ProgramOutline outline_of(const CLI::App& program) {
  ProgramOutline outline{outline_of_command(program), {}};
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
    outline.commands.push_back(outline_of_command(*command));
  return outline;
}

}  // namespace reemit::cli

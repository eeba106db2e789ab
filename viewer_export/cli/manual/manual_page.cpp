#include "viewer_export/cli/manual/manual_page.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "reemit/version.h"

namespace reemit::cli {
namespace {

/// Text within a line as roff prints it unchanged: alone, '-' would become a hyphen and quotes typographic,
/// which nobody can copy into a shell.
std::string escaped(std::string_view text) {
  static constexpr std::pair<char, std::string_view> kEscapes[] = {
      {'\\', "\\e"}, {'-', "\\-"}, {'\'', "\\(aq"}, {'`', "\\(ga"}, {'^', "\\(ha"}, {'~', "\\(ti"}};
  std::string result;
  for (const char c : text) {
    const auto* const escape = std::find_if(std::begin(kEscapes), std::end(kEscapes),
                                            [c](const auto& candidate) { return candidate.first == c; });
    if (escape == std::end(kEscapes))
      result += c;
    else
      result += escape->second;
  }
  return result;
}

/// Line by line; one that begins with a dot is kept from being a request and has `before_dot` in front.
std::string text_lines(const std::string& text, std::string_view before_dot) {
  std::string result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('.')) result += fmt::format("{}\\&", before_dot);
    result += escaped(line) + '\n';
  }
  return result;
}

/// As running text. A list of file formats stays one: its lines begin with their extension.
std::string paragraph(const std::string& text) {
  return text_lines(text, ".br\n");
}

/// With its line breaks, as examples need them.
std::string as_it_stands(const std::string& text) {
  return ".nf\n" + text_lines(text, "") + ".fi\n";
}

std::string bold(std::string_view text) {
  return "\\fB" + escaped(text) + "\\fR";
}
std::string slanted(std::string_view text) {
  return "\\fI" + escaped(text) + "\\fR";
}

std::string bold_list(const std::vector<std::string>& names) {
  std::string result;
  for (const std::string& name : names) result += fmt::format("{}{}", result.empty() ? "" : ", ", bold(name));
  return result;
}

/// "hits|zones" with words to type in bold and what stands for something else slanted.
std::string value_text(const OptionOutline& option) {
  std::string result;
  std::string_view rest = option.value;
  while (true) {
    const std::string_view part = rest.substr(0, rest.find('|'));
    const bool typed = std::find(option.words.begin(), option.words.end(), part) != option.words.end();
    result += typed ? bold(part) : slanted(part);
    if (part.size() == rest.size()) return result;
    result += '|';
    rest.remove_prefix(part.size() + 1);
  }
}

std::string option_entry(const OptionOutline& option) {
  std::string head = bold_list(option.names);
  if (!head.empty() && !option.value.empty()) head += ' ';
  if (!option.value.empty()) head += value_text(option);
  if (option.names.empty() && option.repeats) head += " ...";

  std::string text = ".TP\n" + head + '\n' + paragraph(option.help);
  std::vector<std::string> rules;
  if (option.required && !option.names.empty()) rules.emplace_back("Required.");
  if (!option.limits.empty()) rules.push_back(escaped(option.limits) + '.');
  if (!option.default_value.empty()) rules.push_back(fmt::format("Default: {}.", bold(option.default_value)));
  if (!option.needs.empty()) rules.push_back(fmt::format("Only with {}.", bold_list(option.needs)));
  if (!option.excludes.empty()) rules.push_back(fmt::format("Not with {}.", bold_list(option.excludes)));
  if (!rules.empty()) text += fmt::format(".br\n{}\n", fmt::join(rules, " "));
  return text;
}

/// "reemit solve -o SOLUTION [OPTIONS] ROOM ...": what must be there, and where the rest goes.
std::string synopsis(const std::string& program, const CommandOutline& command) {
  std::string line = bold(program + " " + command.name);
  for (const OptionGroup& group : command.groups)
    for (const OptionOutline& option : group.options)
      if (option.required) line += fmt::format(" {} {}", bold(option.names.front()), value_text(option));
  line += fmt::format(" [{}]", slanted("OPTIONS"));
  for (const OptionOutline& positional : command.positionals)
    line += fmt::format(" {}{}", value_text(positional), positional.repeats ? " ..." : "");
  return line + '\n';
}

std::string option_groups(const CommandOutline& command) {
  std::string text;
  for (const OptionGroup& group : command.groups) {
    text += fmt::format(".PP\n{}\n", slanted(group.name + ":"));
    for (const OptionOutline& option : group.options) text += option_entry(option);
  }
  return text;
}

std::string command_section(const std::string& program, const CommandOutline& command) {
  std::string text = fmt::format(".SS {} {}\n", program, command.name);
  text += paragraph(command.description + '.') + ".PP\n" + synopsis(program, command);
  for (const OptionOutline& positional : command.positionals) text += option_entry(positional);
  return text + option_groups(command) + ".PP\n" + as_it_stands(command.footer);
}

}  // namespace

std::string manual_page(const ProgramOutline& outline) {
  const CommandOutline& program = outline.program;
  std::string capitals = program.name;
  std::transform(capitals.begin(), capitals.end(), capitals.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  // No date: the same source gives the same page.
  std::string text =
      fmt::format(".TH {} 1 \"\" \"{} {}\" \"User Commands\"\n", capitals, program.name, kProgramVersion);
  text += fmt::format(".SH NAME\n{} \\- progressive Monte Carlo radiosity with final gather\n", program.name);
  text += ".SH SYNOPSIS\n";
  for (const CommandOutline& command : outline.commands) text += synopsis(program.name, command) + ".br\n";
  text += fmt::format("{} {}\n", bold(program.name), bold("--help"));
  text += ".SH DESCRIPTION\n" + paragraph(program.description) + option_groups(program);
  text += ".SH COMMANDS\n";
  for (const CommandOutline& command : outline.commands) text += command_section(program.name, command);
  return text + ".SH NOTES\n" + as_it_stands(program.footer);
}

}  // namespace reemit::cli

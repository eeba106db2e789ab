#include "viewer_export/cli/manual/shell_completion.h"

#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace reemit::cli {
namespace {

std::vector<std::string> option_names(const CommandOutline& command) {
  std::vector<std::string> names;
  for (const OptionGroup& group : command.groups)
    for (const OptionOutline& option : group.options)
      names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

/// What is offered behind options that take a value: its words, the names of files, or nothing.
std::string value_cases(const CommandOutline& command) {
  std::string text;
  for (const OptionGroup& group : command.groups)
    for (const OptionOutline& option : group.options) {
      if (option.value.empty()) continue;
      std::vector<std::string> patterns;
      for (const std::string& name : option.names)
        patterns.push_back(fmt::format("'{} {}'", command.name, name));
      const std::string offer =
          option.takes_file ? "return" : fmt::format("words='{}'", fmt::join(option.words, " "));
      text += fmt::format("    {}) {} ;;\n", fmt::join(patterns, " | "), offer);
    }
  return text;
}

std::string name_case(const std::string& command, const CommandOutline& options) {
  return fmt::format("      '{} '-*) words='{}' ;;\n", command, fmt::join(option_names(options), " "));
}

constexpr const char* kBegin =
    R"(# Completion of {0} for bash, made from the options that the program declares.
_{0}() {{
  local IFS=$' \t\n' current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}
  local command='' word words=''
  COMPREPLY=()
  # To bash, '=' in "--option=value" is a word of its own.
  if [[ $current == '=' ]]; then
    current=''
  elif [[ $previous == '=' ]]; then
    previous=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
  for word in "${{COMP_WORDS[@]:1:$((COMP_CWORD - 1))}}"; do
    case $word in
      {1}) command=$word && break ;;
    esac
  done
  # Where this returns without an answer, bash completes names of files.
  case "$command $previous" in
)";

constexpr const char* kMiddle = R"(    *) case "$command $current" in
)";

constexpr const char* kEnd = R"(      ' '*) words='{1}' ;;
      *) return ;;
    esac ;;
  esac
  compopt +o default 2>/dev/null
  # shellcheck disable=SC2207 # words have neither blanks nor patterns, and zsh has no mapfile
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}}
complete -o default -F _{0} {0}
)";

}  // namespace

std::string bash_completion(const ProgramOutline& outline) {
  const std::string& program = outline.program.name;
  std::vector<std::string> commands;
  for (const CommandOutline& command : outline.commands) commands.push_back(command.name);

  std::string script = fmt::format(kBegin, program, fmt::join(commands, " | "));
  for (const CommandOutline& command : outline.commands) script += value_cases(command);
  script += kMiddle;
  script += name_case("", outline.program);
  for (const CommandOutline& command : outline.commands) script += name_case(command.name, command);
  return script + fmt::format(kEnd, program, fmt::join(commands, " "));
}

}  // namespace reemit::cli

#pragma once
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace reemit::cli {

/// One option or positional argument of a command.
struct OptionOutline {
  std::vector<std::string> names;  ///< "-o", "--output"; empty for a positional argument.
  std::string value;  ///< What it takes, as help shows it: "SOLUTION", "hits|zones"; empty for a flag.
  std::vector<std::string> words;  ///< Those parts of `value` that are typed as they stand.
  std::string limits;              ///< What a value must be besides, in the words of CLI11; empty mostly.
  bool takes_file = false;         ///< A part of `value` stands for a file or folder.
  std::string default_value;       ///< Empty: none, or help says it in words.
  bool required = false;
  bool repeats = false;               ///< A positional argument that takes several words.
  std::vector<std::string> needs;     ///< Names of options that it goes with only.
  std::vector<std::string> excludes;  ///< Names of options that it does not go with.
  std::string help;                   ///< Lines as help breaks them.
};

/// Options under one heading, in the order of the help.
struct OptionGroup {
  std::string name;
  std::vector<OptionOutline> options;
};

/// A command, or the program as a whole.
struct CommandOutline {
  std::string name;
  std::string description;
  std::string footer;
  std::vector<OptionOutline> positionals;
  std::vector<OptionGroup> groups;
};

/// What manual page and completion are made of.
struct ProgramOutline {
  CommandOutline program;
  std::vector<CommandOutline> commands;
};

/// Of all that is declared; nothing is parsed or run.
ProgramOutline outline_of(const CLI::App& program);

}  // namespace reemit::cli

#pragma once
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>

namespace reemit::bench {

/// One option of a benchmark, for what goes beyond its name, value and text. Valid as long as its
/// ProgramOptions.
class ProgramOption {
 public:
  /// Shows the value that the variable has now as the default.
  ProgramOption& show_default();
  ProgramOption& required();
  /// Numbers from least to most only, both included; shown as they are given here.
  ProgramOption& in_range(int least, int most);
  ProgramOption& in_range(double least, double most);
  ProgramOption& positive();
  /// So many values; for vectors.
  ProgramOption& count(int values);
  ProgramOption& existing_file();
  ProgramOption& one_of(std::initializer_list<std::string> values);
  ProgramOption& needs(const ProgramOption& other);
  ProgramOption& excludes(const ProgramOption& other);

 private:
  friend class ProgramOptions;
  explicit ProgramOption(void* option) : option_(option) {}
  void* option_;  // of CLI11
};

/// The command line of a benchmark. CLI11 is seen in one file only: it takes longer to compile than most
/// benchmarks.
class ProgramOptions {
 public:
  explicit ProgramOptions(const std::string& about);
  ~ProgramOptions();
  ProgramOptions(const ProgramOptions&) = delete;
  ProgramOptions& operator=(const ProgramOptions&) = delete;

  /// An option by its names ("-o,--output") or an argument by its place ("room"), stored into `value`, which
  /// must live as long as this. Types: those that program_options.cpp instantiates.
  template <class T>
  ProgramOption add_option(const std::string& names, T& value, const std::string& text = "");
  ProgramOption add_flag(const std::string& names, bool& value, const std::string& text);

  /// A command of the program with a command line of its own, one of which has to be given. Valid as long as
  /// this.
  ProgramOptions add_command(const std::string& name, const std::string& about);
  /// Of a command: whether it was given.
  bool is_given() const;

  /// Reads the command line. An exit code if the program shall end: after --help, or after an error, which it
  /// prints.
  std::optional<int> parse(int argc, char** argv);

  /// Prints that an argument is missing and how to get help. Returns the exit code.
  int exit_without(const std::string& name);

 private:
  struct Parser;
  explicit ProgramOptions(std::unique_ptr<Parser> parser);
  std::unique_ptr<Parser> parser_;
};

}  // namespace reemit::bench

#include "bench/program_options.h"

#include <cstdint>
#include <filesystem>
#include <set>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace reemit::bench {
namespace {

CLI::Option& known(void* option) {
  return *static_cast<CLI::Option*>(option);
}

}  // namespace

ProgramOption& ProgramOption::show_default() {
  known(option_).capture_default_str();
  return *this;
}

ProgramOption& ProgramOption::required() {
  known(option_).required();
  return *this;
}

ProgramOption& ProgramOption::in_range(int least, int most) {
  known(option_).check(CLI::Range(least, most));
  return *this;
}

ProgramOption& ProgramOption::in_range(double least, double most) {
  known(option_).check(CLI::Range(least, most));
  return *this;
}

ProgramOption& ProgramOption::positive() {
  known(option_).check(CLI::PositiveNumber);
  return *this;
}

ProgramOption& ProgramOption::count(int values) {
  known(option_).expected(values);
  return *this;
}

ProgramOption& ProgramOption::existing_file() {
  known(option_).check(CLI::ExistingFile);
  return *this;
}

ProgramOption& ProgramOption::one_of(std::initializer_list<std::string> values) {
  known(option_).check(CLI::IsMember(std::set<std::string>(values)));
  return *this;
}

ProgramOption& ProgramOption::needs(const ProgramOption& other) {
  known(option_).needs(&known(other.option_));
  return *this;
}

ProgramOption& ProgramOption::excludes(const ProgramOption& other) {
  known(option_).excludes(&known(other.option_));
  return *this;
}

struct ProgramOptions::Parser {
  explicit Parser(const std::string& about) : whole(std::make_unique<CLI::App>(about)), app(*whole) {}
  explicit Parser(CLI::App& command) : app(command) {}
  std::unique_ptr<CLI::App> whole;  // null for a command, which is a part of another
  CLI::App& app;
};

ProgramOptions::ProgramOptions(const std::string& about) : parser_(std::make_unique<Parser>(about)) {}
ProgramOptions::ProgramOptions(std::unique_ptr<Parser> parser) : parser_(std::move(parser)) {}
ProgramOptions::~ProgramOptions() = default;

template <class T>
ProgramOption ProgramOptions::add_option(const std::string& names, T& value, const std::string& text) {
  return ProgramOption(parser_->app.add_option(names, value, text));
}

template ProgramOption ProgramOptions::add_option(const std::string&, int&, const std::string&);
template ProgramOption ProgramOptions::add_option(const std::string&, std::uint32_t&, const std::string&);
template ProgramOption ProgramOptions::add_option(const std::string&, std::uint64_t&, const std::string&);
template ProgramOption ProgramOptions::add_option(const std::string&, double&, const std::string&);
template ProgramOption ProgramOptions::add_option(const std::string&, std::string&, const std::string&);
template ProgramOption ProgramOptions::add_option(const std::string&, std::filesystem::path&,
                                                  const std::string&);
template ProgramOption ProgramOptions::add_option(const std::string&, std::optional<std::uint32_t>&,
                                                  const std::string&);
template ProgramOption ProgramOptions::add_option(const std::string&, std::optional<double>&,
                                                  const std::string&);
template ProgramOption ProgramOptions::add_option(const std::string&, std::vector<int>&, const std::string&);
template ProgramOption ProgramOptions::add_option(const std::string&, std::vector<std::uint64_t>&,
                                                  const std::string&);
template ProgramOption ProgramOptions::add_option(const std::string&, std::vector<double>&,
                                                  const std::string&);
template ProgramOption ProgramOptions::add_option(const std::string&, std::vector<std::string>&,
                                                  const std::string&);
template ProgramOption ProgramOptions::add_option(const std::string&, std::vector<std::filesystem::path>&,
                                                  const std::string&);

ProgramOption ProgramOptions::add_flag(const std::string& names, bool& value, const std::string& text) {
  return ProgramOption(parser_->app.add_flag(names, value, text));
}

ProgramOptions ProgramOptions::add_command(const std::string& name, const std::string& about) {
  parser_->app.require_subcommand(1);
  return ProgramOptions(std::make_unique<Parser>(*parser_->app.add_subcommand(name, about)));
}

bool ProgramOptions::is_given() const {
  return parser_->app.parsed();
}

std::optional<int> ProgramOptions::parse(int argc, char** argv) {
  try {
    parser_->app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return parser_->app.exit(e);
  }
  return std::nullopt;
}

int ProgramOptions::exit_without(const std::string& name) {
  return parser_->app.exit(CLI::RequiredError(name));
}

}  // namespace reemit::bench

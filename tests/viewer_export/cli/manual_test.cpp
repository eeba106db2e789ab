#include <array>
#include <cstdio>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"
#include "viewer_export/cli/commands.h"
#include "viewer_export/cli/manual/manual_page.h"
#include "viewer_export/cli/manual/program_outline.h"
#include "viewer_export/cli/manual/shell_completion.h"

namespace reemit::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

std::string output_of(const std::string& command) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
  if (!pipe) throw std::runtime_error("cannot run " + command);
  std::string output;
  std::array<char, 4096> block{};
  while (const std::size_t count = std::fread(block.data(), 1, block.size(), pipe.get()))
    output.append(block.data(), count);
  return output;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The program as it declares itself, and what is made of that.
class Manual : public ::testing::Test {
 protected:
  /// Every command, the program itself first, under an empty name.
  std::vector<std::pair<std::string, const CLI::App*>> commands() const {
    std::vector<std::pair<std::string, const CLI::App*>> all{{"", program_.get()}};
    for (const CLI::App* command : program_->get_subcommands([](const CLI::App*) { return true; }))
      all.emplace_back(command->get_name(), command);
    return all;
  }

  /// What bash offers where the cursor stands behind the last of `words`; its own names of files as
  /// "<files>".
  std::vector<std::string> offers(const std::vector<std::string>& words) const {
    std::string script = "source " + (folder_ / "reemit.bash").string() + "\nCOMP_WORDS=(reemit";
    for (const std::string& word : words) script += " '" + word + "'";
    // Only while bash completes can compopt switch off names of files; here it says whether it would.
    script += ")\nCOMP_CWORD=" + std::to_string(words.size()) +
              "\nfiles='<files>'; compopt() { [[ $* != '+o default' ]] || files=''; }\n_reemit\n"
              "printf '%s\\n' \"${COMPREPLY[@]}\" $files\n";
    folder_.write("ask.bash", script);
    std::vector<std::string> lines =
        lines_of(output_of("bash --noprofile --norc " + (folder_ / "ask.bash").string() + " 2>&1"));
    std::erase(lines, "");
    return lines;
  }

  void SetUp() override { folder_.write("reemit.bash", cli::bash_completion(outline_)); }

  cli::Action action_;
  std::unique_ptr<CLI::App> program_ = cli::make_program(action_);
  cli::ProgramOutline outline_ = cli::outline_of(*program_);
  std::string page_ = cli::manual_page(outline_);
  TempFolder folder_;
};

TEST_F(Manual, PageHasEveryOptionOfEveryCommand) {
  std::size_t options = 0;
  for (const auto& [name, command] : commands()) {
    const std::size_t begin = page_.find(name.empty() ? ".SH DESCRIPTION" : ".SS reemit " + name + "\n");
    ASSERT_NE(begin, std::string::npos) << name;
    const std::string section = page_.substr(begin, page_.find("\n.S", begin) - begin);
    for (const CLI::Option* option : command->get_options()) {
      for (std::string option_name : option->get_lnames()) {
        for (std::size_t i = 0; (i = option_name.find('-', i)) != std::string::npos; i += 2)
          option_name.insert(i, 1, '\\');
        EXPECT_THAT(section, HasSubstr("\\fB\\-\\-" + option_name + "\\fR")) << name;
        ++options;
      }
      for (const std::string& option_name : option->get_snames())
        EXPECT_THAT(section, HasSubstr("\\fB\\-" + option_name + "\\fR")) << name;
    }
  }
  EXPECT_GT(options, 50U);
}

TEST_F(Manual, PageShowsWhatHelpShows) {
  EXPECT_THAT(page_, HasSubstr("\\fB\\-\\-method\\fR \\fBshooting\\fR|\\fBwalk\\fR|\\fBmatrix\\fR"));
  EXPECT_THAT(page_, HasSubstr("Default: \\fBshooting\\fR."));
  EXPECT_THAT(page_, HasSubstr("\\fB\\-\\-camera\\fR \\fINAME\\fR|\\fBall\\fR"));
  EXPECT_THAT(page_, HasSubstr("Only with \\fB\\-\\-direct\\fR."));
  EXPECT_THAT(page_, HasSubstr("Not with \\fB\\-\\-verbose\\fR."));
  EXPECT_THAT(page_, HasSubstr("\n  reemit solve room.json \\-o room.h5 \\-\\-error 1%\n"));
}

TEST_F(Manual, GroffFindsNoFaultInThePage) {
  if (output_of("command -v groff").empty()) GTEST_SKIP() << "no groff";
  const std::string file = folder_.write("reemit.1", page_).string();
  EXPECT_THAT(output_of("groff -man -ww -z " + file + " 2>&1"), IsEmpty());
  const std::string shown = output_of("groff -man -Tascii -P-cbou " + file);
  EXPECT_THAT(shown, AllOf(HasSubstr("--method shooting|walk|matrix"), HasSubstr("'reemit COMMAND --help'"),
                           HasSubstr(".exr  OpenEXR")));
}

TEST_F(Manual, GroffWouldFindAFault) {
  if (output_of("command -v groff").empty()) GTEST_SKIP() << "no groff";
  const std::string file = folder_.write("reemit.1", page_ + ".NOSUCHMACRO\n").string();
  EXPECT_THAT(output_of("groff -man -ww -z " + file + " 2>&1"), HasSubstr("NOSUCHMACRO"));
}

TEST_F(Manual, BashOffersEveryOptionOfEveryCommand) {
  for (const auto& [name, command] : commands()) {
    const std::vector<std::string> offered = name.empty() ? offers({"-"}) : offers({name, "room.h5", "-"});
    std::size_t names = 0;
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& option_name : option->get_lnames())
        EXPECT_THAT(offered, Contains("--" + option_name)) << name;
      for (const std::string& option_name : option->get_snames())
        EXPECT_THAT(offered, Contains("-" + option_name)) << name;
      names += option->get_lnames().size() + option->get_snames().size();
    }
    EXPECT_EQ(offered.size(), names) << name;
  }
}

TEST_F(Manual, BashOffersCommands) {
  EXPECT_THAT(offers({""}), UnorderedElementsAre("solve", "render", "export", "measure", "audit", "info"));
  EXPECT_THAT(offers({"rend"}), ElementsAre("render"));
}

TEST_F(Manual, BashOffersWordsOfOptions) {
  EXPECT_THAT(offers({"solve", "room.json", "--method", "sho"}), ElementsAre("shooting"));
  EXPECT_THAT(offers({"solve", "--method", "="}), UnorderedElementsAre("shooting", "walk", "matrix"));
  EXPECT_THAT(offers({"solve", "--method", "=", "m"}), ElementsAre("matrix"));
  EXPECT_THAT(offers({"info", "--emissive-units", ""}), UnorderedElementsAre("auto", "cd/m2", "W/sr/m2"));
  EXPECT_THAT(offers({"export", "x.h5", "--units", ""}), UnorderedElementsAre("W", "lx"));
  EXPECT_THAT(offers({"render", "x.h5", "--camera", "a"}), ElementsAre("all"));
  EXPECT_THAT(offers({"solve", "--zone"}), UnorderedElementsAre("--zones", "--zone-area"));
}

TEST_F(Manual, BashOffersFilesWhereFilesAreMeantAndOnlyThere) {
  EXPECT_THAT(offers({"solve", ""}), ElementsAre("<files>"));
  EXPECT_THAT(offers({"solve", "room.json", "-o", ""}), ElementsAre("<files>"));
  EXPECT_THAT(offers({"render", "room.h5", "--output", ""}), ElementsAre("<files>"));
  EXPECT_THAT(offers({"solve", "room.json", "--error", ""}), IsEmpty());
  EXPECT_THAT(offers({"solve", "room.json", "--seed", ""}), IsEmpty());
}

}  // namespace
}  // namespace reemit::test

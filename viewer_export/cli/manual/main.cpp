// Writes the manual page and the completion script of reemit from the options it declares; the build runs it.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include "viewer_export/cli/commands.h"
#include "viewer_export/cli/manual/manual_page.h"
#include "viewer_export/cli/manual/program_outline.h"
#include "viewer_export/cli/manual/shell_completion.h"

namespace {

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  if (!stream.flush())
    throw std::runtime_error(file.string() + ": cannot write; is there room, and may you write there?");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: reemit_manual FOLDER\n  writes reemit.1 and reemit.bash into it\n", stderr);
    return 2;
  }
  try {
    const std::filesystem::path folder = argv[1];
    reemit::cli::Action action;
    const auto outline = reemit::cli::outline_of(*reemit::cli::make_program(action));
    std::filesystem::create_directories(folder);
    write(folder / "reemit.1", reemit::cli::manual_page(outline));
    write(folder / "reemit.bash", reemit::cli::bash_completion(outline));
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "reemit_manual: %s\n", problem.what());
    return 2;
  }
  return 0;
}

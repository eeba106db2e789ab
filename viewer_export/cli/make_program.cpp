#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "viewer_export/cli/commands.h"

#include "reemit/version.h"

namespace reemit::cli {
namespace {

constexpr const char* kDescription =
    "Solves the light in a room once and answers every later question from that solution:\n"
    "radiance at every vertex, stills from any viewpoint, and where every watt went.";

constexpr const char* kFooter =
    "Examples:\n"
    "  reemit solve room.json -o room.h5 --error 1%\n"
    "  reemit render room.h5 --camera all -o pictures/\n"
    "  reemit export room.h5 -o room.ply\n"
    "  reemit audit room.h5\n"
    "'reemit COMMAND --help' explains a command.\n"
    "Lux: 'reemit info room.h5' for every surface, 'reemit measure room.h5 --grid ...' on a working\n"
    "plane, 'reemit export room.h5 -o lux.csv --units lx' for every vertex.\n"
    "Noise: a lower --error, of solve first, then of render, export or measure; more\n"
    "--zones where the last line of a command says that zones are what is off.\n"
    "Documentation in docs/: examples.md, room_format.md, command_line.md, export_formats.md,\n"
    "solution_file.md.\n"
    "Exit codes: 0 done, 1 a check failed, 2 bad usage, input or output, 3 out of memory,\n"
    "130 interrupted before there was a result.";

}  // namespace

std::unique_ptr<CLI::App> make_program(Action& action) {
  auto program = std::make_unique<CLI::App>(kDescription, "reemit");
  program->footer(kFooter);
  program->set_version_flag("--version", fmt::format("reemit {}", kProgramVersion),
                            "Print the version and exit");
  program->require_subcommand(1);
  add_solve_command(*program, action);
  add_render_command(*program, action);
  add_export_command(*program, action);
  add_measure_command(*program, action);
  add_audit_command(*program, action);
  add_info_command(*program, action);
  return program;
}

}  // namespace reemit::cli

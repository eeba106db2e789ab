#pragma once
#include <functional>
#include <memory>

#include "viewer_export/cli/exit_code.h"

namespace CLI {
class App;
}

namespace reemit::cli {

/// What the chosen subcommand does once the whole command line has been read. Throws InputError,
/// ResourceError.
using Action = std::function<ExitCode()>;

// Each adds one subcommand to the program; when it is the chosen one, parsing sets `action`.
void add_solve_command(CLI::App& program, Action& action);
void add_render_command(CLI::App& program, Action& action);
void add_export_command(CLI::App& program, Action& action);
void add_measure_command(CLI::App& program, Action& action);
void add_audit_command(CLI::App& program, Action& action);
void add_info_command(CLI::App& program, Action& action);

/// All that the command line may hold. Nothing runs: parsing sets `action`, which must outlive the result.
std::unique_ptr<CLI::App> make_program(Action& action);

/// Reads the command line, runs the subcommand, and turns every exception into a message on stderr and an
/// exit code.
ExitCode run_program(int argc, const char* const* argv);

}  // namespace reemit::cli

#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "solver/solution/solution_file.h"
#include "viewer_export/cli/audit_report.h"
#include "viewer_export/cli/command_options.h"
#include "viewer_export/cli/commands.h"

namespace reemit::cli {
namespace {

struct AuditOptions {
  std::filesystem::path solution;
  OutputStyle style;
};

ExitCode run_audit(const AuditOptions& options) {
  const Solution solution = load_solution(options.solution);
  if (options.style.json) {
    fmt::print("{}\n", audit_json(solution.audit, solution.surface_names).dump(2));
  } else {
    fmt::print("{}", audit_text(solution.audit, solution.surface_names));
  }
  return solution.audit.balanced() ? ExitCode::kDone : ExitCode::kCheckFailed;
}

}  // namespace

void add_audit_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<AuditOptions>();
  CLI::App& audit = *program.add_subcommand("audit", "Say where every watt went");
  audit.footer(
      "Exit code 1 if the books do not balance: emitted = absorbed + escaped + unshot + roulette, to the "
      "quantum.\n"
      "Example:\n"
      "  reemit audit room.h5 --json");
  audit.add_option("solution", options->solution, "Solution file")->required()->type_name("SOLUTION");
  add_json_option(audit, options->style);
  audit.callback([options, &action] { action = [options] { return run_audit(*options); }; });
}

}  // namespace reemit::cli

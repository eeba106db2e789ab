#include <filesystem>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "scenes/model/interrupted.h"
#include "solver/gather/direct_audit.h"
#include "viewer_export/cli/audit_report.h"
#include "viewer_export/cli/command_options.h"
#include "viewer_export/cli/commands.h"
#include "viewer_export/cli/direct_audit_report.h"
#include "viewer_export/cli/interrupt.h"
#include "viewer_export/cli/loading.h"
#include "viewer_export/cli/messages.h"
#include "viewer_export/cli/progress.h"
#include "viewer_export/cli/solution_report.h"
#include "viewer_export/cli/thread_limit.h"

namespace reemit::cli {
namespace {

struct AuditOptions {
  std::filesystem::path solution;
  std::vector<std::filesystem::path> room;
  bool direct = false;
  DirectAuditSettings settings;
  int threads = 0;
  OutputStyle style;
};

/// Throws Interrupted.
DirectAudit compare_direct_light(const AuditOptions& options, const Solution& solution) {
  const ThreadLimit limit(options.threads);
  const Scene scene = load_room_of(solution, options.solution, options.room, options.style);
  const Room room = build_room(scene, solution.mesh, options.style);
  const InterruptGuard interrupt;
  Progress progress("comparing direct light", progress_style(options.style.quiet, options.style.verbose));
  DirectAudit audit = audit_direct_light(
      room, solution, options.settings, [&progress](double done) { progress.update(done); },
      interrupt.requested());
  progress.finish();
  if (interrupt.requested()) throw Interrupted("the comparison was interrupted");
  return audit;
}

ExitCode run_audit(const AuditOptions& options) {
  const Solution solution = load_solution(options.solution, options.style);
  const std::vector<std::string> warnings = state_warnings(solution, options.solution);
  if (!options.style.quiet) print_warnings(warnings);
  std::optional<DirectAudit> direct;
  if (options.direct) direct = compare_direct_light(options, solution);
  if (options.style.json) {
    nlohmann::ordered_json document = audit_json(solution.audit, solution.surface_names);
    document["warnings"] = warnings;
    if (direct) document["direct"] = direct_audit_json(*direct, solution);
    print_json(document);
  } else {
    print_result(audit_text(solution.audit, solution.surface_names));
    if (direct) print_result('\n' + direct_audit_text(*direct, solution));
  }
  const bool sound = solution.audit.balanced() && (!direct || direct->agrees());
  return sound ? ExitCode::kDone : ExitCode::kCheckFailed;
}

}  // namespace

void add_audit_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<AuditOptions>();
  CLI::App& audit = *program.add_subcommand("audit", "Say where every watt went, and check the direct light");
  audit.footer(
      "Exit code 1 if the books do not balance: emitted = absorbed + escaped + unshot + roulette, to the\n"
      "quantum; or if --direct finds zones that differ.\n"
      "Examples:\n"
      "  reemit audit room.h5 --json\n"
      "  reemit audit room.h5 --direct");
  audit.add_option("solution", options->solution, "Solution file")->required()->type_name("SOLUTION");
  auto* direct =
      audit.add_flag("--direct", options->direct,
                     "Compare the direct light that packets bring to every zone with shadow rays to the\n"
                     "luminaires, which stills and exports use");
  add_integer_option(audit, "--points", options->settings.points, 32, 1 << 20,
                     "Shadow rays per zone, rounded up")
      ->needs(direct);
  add_seed_and_threads(audit, options->settings.seed, options->threads);
  for (const char* name : {"--seed", "--threads"}) audit.get_option(name)->needs(direct);
  add_room_option(audit, options->room)->needs(direct);
  add_progress_options(audit, options->style);
  add_json_option(audit, options->style);
  audit.callback([options, &action] { action = [options] { return run_audit(*options); }; });
}

}  // namespace reemit::cli

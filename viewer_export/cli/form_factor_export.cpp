#include "viewer_export/cli/form_factor_export.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "scenes/model/error.h"
#include "scenes/model/stopwatch.h"
#include "solver/solution/file_seal.h"
#include "solver/solution/solution_file.h"
#include "viewer_export/cli/interrupt.h"
#include "viewer_export/cli/messages.h"
#include "viewer_export/cli/output_path.h"
#include "viewer_export/cli/progress.h"
#include "viewer_export/cli/solution_report.h"
#include "viewer_export/formats/form_factor_writer.h"
#include "viewer_export/output/export_info.h"

#include "reemit/version.h"

namespace reemit::cli {
namespace fs = std::filesystem;
namespace {

std::vector<std::pair<std::string, std::string>> notes_of(const Solution& solution,
                                                          const FormFactorReport& report, std::size_t cells,
                                                          std::uint64_t seed) {
  std::vector<std::pair<std::string, std::string>> notes{
      {"program", fmt::format("reemit {}", kProgramVersion)},
      {"room", fmt::format("{}", fmt::join(room_files(solution), " + "))},
      {"room_hash", solution.room_hash},
      {"meaning",
       "factor: share of the power that zone_from sends out uniformly which reaches zone_to directly"},
      {"zones", fmt::format("{}, numbered as in the solution file", report.zones)},
      {"cells", fmt::format("{}, of which zones consist", cells)},
      {"pairs", fmt::format("of cells, {} facing: {} open, {} walled off, {} clear, {} hidden, {} sampled",
                            report.facing_pairs, report.open_pairs, report.walled_pairs, report.clear_pairs,
                            report.hidden_pairs, report.sampled_pairs)},
      {"row_sums", fmt::format("{} to {}", report.after.lowest, report.after.highest)},
      {"seed", std::to_string(seed)}};
  for (auto& [name, value] : notes) value = one_line(std::move(value));
  return notes;
}

}  // namespace

ExitCode export_form_factors(const FormFactorExport& options) {
  form_factor_format_of(options.output);  // refuses an unknown one before the work
  check_output_file(options.output, options.solution);
  if (fs::exists(options.output) && ends_in_seal(options.output))
    throw InputError(options.output.string(), "is a solution, which form factors would replace",
                     "choose another output with -o");
  const Solution solution = reemit::load_solution(options.solution);
  if (!solution.mesh.solid_shares().empty())
    throw InputError(options.solution.string(),
                     "the room has cut-outs, and form factors are those of opaque faces",
                     "Leave their masks out to have them as if they were whole.");
  const ZoneMesh cells(solution.mesh.base(), {}, solution.mesh.splits());
  const RayTracer rays(cells);

  const auto start = std::chrono::steady_clock::now();
  const InterruptGuard interrupt;
  Progress progress("form factors", progress_style(options.style.quiet, options.style.verbose));
  const FormFactors factors =
      join_cells(compute_form_factors(
                     cells, rays, {.seed = options.seed, .enforce_closure = true},
                     [&progress](double done) { progress.update(done); }, interrupt.requested()),
                 solution.mesh);
  progress.finish();
  const FormFactorReport& report = factors.report();
  write_output([&] {
    write_form_factors({factors, solution.mesh, solution.surface_names,
                        notes_of(solution, report, cells.zone_count(), options.seed)},
                       options.output);
  });

  if (!options.style.quiet) print_warnings(form_factor_warnings(report));
  const double seconds = seconds_since(start);
  if (options.style.json) {
    nlohmann::ordered_json json = form_factor_json(report);
    json["file"] = options.output.string();
    json["seconds"] = seconds;
    print_json(json);
  } else {
    print_result(
        fmt::format("{}: {:.2f} s\n{}\n", options.output.string(), seconds, form_factor_text(report)));
  }
  return ExitCode::kDone;
}

std::string form_factor_formats_help() {
  std::string help;
  for (const FormFactorFormat& format : form_factor_formats())
    help += fmt::format("\n{}  {}", format.extension, format.description);
  return help;
}

}  // namespace reemit::cli

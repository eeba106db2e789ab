#include "viewer_export/cli/solution_report.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "scenes/model/memory.h"
#include "solver/solution/zone_summary.h"
#include "viewer_export/cli/error_text.h"
#include "viewer_export/cli/text_table.h"
#include "viewer_export/cli/zone_lines.h"

namespace reemit::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSolutionHeadWidth = 10;  // of the first column

/// By band, in the order of "bands".
Json unshot_shares(const EnergyAudit& audit) {
  Json shares = Json::array();
  for (const BandAudit& band : audit.bands) shares.push_back(band.unshot_share());
  return shares;
}

Json record_json(const Solution& solution) {
  const SolveRecord& record = solution.record;
  const double target = solution.settings.error_target;
  Json json{{"stopped", to_string(record.stopped)},
            {"packets", record.packets},
            {"rays", record.rays},
            {"seconds", record.seconds},
            {"error", record.error},
            {"error_bound", record.error_bound},
            {"error_95th_percentile", record.error_95th_percentile},
            {"discretisation", record.discretisation ? Json(*record.discretisation) : Json(nullptr)},
            {"zones", solution.mesh.zone_count()},
            {"unreached_zones", record.unreached_zones},
            {"gathered_zones", record.gathered_zones},
            {"batches", solution.sums.batches},
            {"error_target", target > 0 ? Json(target) : Json()},
            {"seed", solution.settings.seed},
            {"method", to_string(solution.settings.method)},
            {"sampling", to_string(solution.settings.sampling)},
            {"reemission", to_string(solution.settings.reemission)},
            {"direct", to_string(solution.settings.direct)},
            {"unshot_share", unshot_shares(solution.audit)},
            {"balanced", solution.audit.balanced()},
            {"bands", solution.bands.names()},
            {"room", solution.room_path},
            {"room_files", room_files(solution)},
            {"room_hash", solution.room_hash}};
  add_zones(json, record.gather_bias);
  return json;
}

/// More is unshot than whole batches leave; by the matrix method it is what rounding leaves.
bool lacks_unshot_power(const Solution& solution) {
  return solution.settings.method != SolveMethod::kMatrix &&
         solution.audit.unshot_share() > solution.settings.stop_share;
}

/// Stills and exports need not look for what belongs to the room.
bool is_ready_for_views(const Solution& solution) {
  const GatherPlan& plan = solution.gather_plan;
  return !plan.uneven.empty() && (plan.caustics || !solution.sums.has_caustics());
}

std::string view_text(const Solution& solution) {
  const GatherPlan& plan = solution.gather_plan;
  if (!is_ready_for_views(solution))
    return "every still and export looks for uneven zones or photons first: the file has not all of them\n";
  std::string text = fmt::format("begin at once: {} uneven zones",
                                 std::count(plan.uneven.begin(), plan.uneven.end(), std::uint8_t{1}));
  if (plan.caustics)
    text += fmt::format(" and {} photons behind mirrors and glass", plan.caustics->radius_codes.size());
  return text + " are known\n";
}

std::string deviation_text(const RowSums& sums) {
  return fmt::format("{:.6f} to {:.6f} (rms deviation from 1 in closed rooms {:.1e})", sums.lowest,
                     sums.highest, sums.rms_deviation);
}

Json row_sums_json(const RowSums& sums) {
  return {{"lowest", sums.lowest}, {"highest", sums.highest}, {"rms_deviation", sums.rms_deviation}};
}

}  // namespace

std::string form_factor_text(const FormFactorReport& report) {
  return fmt::format(
      "form factors: {} zones ({} in closed rooms), {} pairs that face each other: {} open, {} walled off, "
      "{} clear, {} hidden, {} sampled\nrow sums: {}; enforced: {}",
      report.zones, report.closed_zones, report.facing_pairs, report.open_pairs, report.walled_pairs,
      report.clear_pairs, report.hidden_pairs, report.sampled_pairs, deviation_text(report.before),
      deviation_text(report.after));
}

Json form_factor_json(const FormFactorReport& report) {
  return {{"zones", report.zones},
          {"closed_zones", report.closed_zones},
          {"facing_pairs", report.facing_pairs},
          {"open_pairs", report.open_pairs},
          {"walled_pairs", report.walled_pairs},
          {"clear_pairs", report.clear_pairs},
          {"hidden_pairs", report.hidden_pairs},
          {"sampled_pairs", report.sampled_pairs},
          {"rays", report.rays},
          {"row_sums_before", row_sums_json(report.before)},
          {"row_sums", row_sums_json(report.after)}};
}

std::vector<std::string> form_factor_warnings(const FormFactorReport& report) {
  constexpr double kMostOff = 1e-3;
  constexpr double kHighest = 1.01;  // those of open rooms have noise
  const RowSums& sums = report.after;
  if (!(sums.rms_deviation > kMostOff || sums.highest > kHighest)) return {};
  return {fmt::format(
      "form factors do not add up to 1 (in closed rooms rms deviation {}; highest sum {:.4g}): light is lost "
      "or made. Things far smaller than the zones that see them, or than the room, do that; more --zones or "
      "--method shooting help",
      percent_text(sums.rms_deviation), sums.highest)};
}

std::vector<std::string> solve_warnings(const Solution& solution) {
  std::vector<std::string> warnings;
  if (lacks_unshot_power(solution))
    warnings.push_back(fmt::format(
        "{} of the emitted power was still on its way when the run stopped ({}): radiosities are too low by "
        "about that. "
        "Give it more time; light in sealed parts of high reflectance needs 1/(1 - reflectance) bounces, and "
        "some of the light of a luminaire inside a body of clear glass never gets out.",
        percent_text(solution.audit.worst_unshot_share()), to_string(solution.record.stopped)));
  if (solution.form_factors)
    for (std::string& warning : form_factor_warnings(*solution.form_factors))
      warnings.push_back(std::move(warning));
  if (solution.sums.batches == 1)
    warnings.push_back(
        "the run stopped after one batch: how large its error is, is not known. Give it more time, or more "
        "packets.");
  return warnings;
}

std::vector<std::string> state_warnings(const Solution& solution, const std::filesystem::path& file) {
  std::vector<std::string> warnings = solve_warnings(solution);
  if (solution.record.stopped == StopReason::kUnderWay)
    warnings.push_back(
        fmt::format("{0} is a checkpoint of a run that has not come to its end: its noise is still {1}. "
                    "'reemit solve --resume {0}' goes on with it.",
                    file.string(), percent_text(solution.record.error)));
  return warnings;
}

std::string solve_line(const Solution& solution) {
  const SolveRecord& record = solution.record;
  const std::string effort = solution.form_factors ? fmt::format("{} zones", solution.mesh.zone_count())
                                                   : fmt::format("{} packets", record.packets);
  std::string line = fmt::format("stopped: {}; {}, {} rays, {:.2f} s, noise {}, zones {} in gathered light",
                                 to_string(record.stopped), effort, record.rays, record.seconds,
                                 percent_text(record.error), zones_text(record.gather_bias));
  if (record.discretisation)
    line += fmt::format("; points differ from their zones by {}", percent_text(*record.discretisation));
  if (solution.form_factors) line += "\n" + form_factor_text(*solution.form_factors);
  return line;
}

Json solve_json(const Scene& scene, const Solution& solution, const std::filesystem::path& file) {
  Json json = record_json(solution);
  json["warnings"] = scene.warnings;
  for (const auto& more : {solution.mesh_report.warnings, solution.light_warnings, solve_warnings(solution)})
    for (const std::string& warning : more) json["warnings"].push_back(warning);
  json["notes"] = scene.notes;
  json["solution"] = file.string();
  json["peak_memory_bytes"] = peak_memory();
  if (solution.form_factors) json["form_factors"] = form_factor_json(*solution.form_factors);
  return json;
}

std::string solution_text(const Solution& solution, const std::filesystem::path& file,
                          const std::string& room_status) {
  const SolveRecord& record = solution.record;
  std::string text =
      fmt::format("{}: solution, written by reemit {}\n", file.string(), solution.program_version);
  text += fmt::format("room      {} ({})\n", fmt::join(room_files(solution), " + "), room_status);
  text += fmt::format("hash      {}\n", solution.room_hash);
  text += fmt::format("bands     {} ({})\n", fmt::join(solution.bands.names(), " "),
                      solution.bands.efficacy_statement());
  text += fmt::format("method    {}, {} sampling, seed {}\n", to_string(solution.settings.method),
                      to_string(solution.settings.sampling), solution.settings.seed);
  text += fmt::format("stopped   {}\n", to_string(record.stopped));
  text += fmt::format("effort    {} packets, {} rays, {} batches, {:.2f} s\n", record.packets, record.rays,
                      solution.sums.batches, record.seconds);
  text += fmt::format(
      "noise     {} rms over zones; that of 95 % of the lit zones is below {} of their own light\n",
      percent_text(record.error), percent_text(record.error_95th_percentile));
  text += fmt::format("bound     {} (99.9 % odds that the true rms noise of the zone values is below)\n",
                      percent_text(record.error_bound));
  text += fmt::format("zones     {} error in light gathered at points; only finer zones lessen it\n",
                      zones_text(record.gather_bias));
  if (record.discretisation)
    text += fmt::format("          points differ from the zones they are in by {} rms\n",
                        percent_text(*record.discretisation));
  if (record.gathered_zones > 0)
    text += fmt::format("gathered  {} zones too small for packets\n", record.gathered_zones);
  text += fmt::format("mesh      {} base triangles, {} zones, {} of them never reached by light\n",
                      solution.mesh.triangle_count(), solution.mesh.zone_count(), record.unreached_zones);
  text += shared_zones_text(solution.mesh, kSolutionHeadWidth, sealed_light_share(solution));
  if (solution.sums.batches > 0) text += "views     " + view_text(solution);
  if (lacks_unshot_power(solution))
    text += fmt::format("unshot    {} of the emitted power; radiosities are too low by about that\n",
                        percent_text(solution.audit.worst_unshot_share()));
  text += fmt::format("books     {}\n", solution.audit.balanced() ? "balance exactly" : "DO NOT BALANCE");
  return text;
}

Json solution_json(const Solution& solution, const std::filesystem::path& file,
                   const std::string& room_status) {
  Json json{{"kind", "solution"},
            {"file", file.string()},
            {"program_version", solution.program_version},
            {"room_status", room_status}};
  json.update(record_json(solution));
  json["base_triangles"] = solution.mesh.triangle_count();
  add_shared_zones(json, solution.mesh, sealed_light_share(solution));
  json["ready_for_views"] = is_ready_for_views(solution);
  json["warnings"] = solution.mesh_report.warnings;
  for (const auto& more : {solution.light_warnings, solve_warnings(solution)})
    for (const std::string& warning : more) json["warnings"].push_back(warning);
  return json;
}

}  // namespace reemit::cli

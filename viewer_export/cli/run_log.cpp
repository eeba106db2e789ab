#include "viewer_export/cli/run_log.h"

#include <fstream>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/model/error.h"
#include "viewer_export/cli/error_text.h"
#include "viewer_export/cli/messages.h"
#include "viewer_export/cli/output_path.h"

#include "reemit/version.h"

namespace reemit::cli {
namespace {

using Json = nlohmann::ordered_json;

/// How the first line of every log begins.
constexpr std::string_view kStart = R"({"event":"start",)";

bool is_log(const std::filesystem::path& file) {
  std::string start(kStart.size(), '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  return stream.gcount() == 0 || start == kStart;
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  return std::filesystem::absolute(a).lexically_normal() == std::filesystem::absolute(b).lexically_normal();
}

}  // namespace

void RunLog::check(const std::filesystem::path& file, const std::filesystem::path& room,
                   const std::filesystem::path& solution) {
  check_output_file(file, room);
  if (same_file(file, solution))
    throw InputError(file.string(), "is the solution file too", "Give --log a file of its own.");
  if (std::filesystem::exists(file) && !is_log(file))
    throw InputError(file.string(), "exists and is no log of a run", "Give --log the name of a new file.");
}

RunLog::RunLog(const std::filesystem::path& file, const Run& run)
    : file_(file),
      stream_(std::fopen(file.c_str(), run.goes_on ? "ab" : "wb"), std::fclose),
      matrix_(run.settings.method == SolveMethod::kMatrix) {
  if (!stream_) throw OutputError(file.string() + ": cannot create the log");
  const SolverSettings& settings = run.settings;
  write({{"event", "start"},
         {"program_version", kProgramVersion},
         {"room", run.room.string()},
         {"solution", run.solution.string()},
         {"method", to_string(settings.method)},
         {"sampling", to_string(settings.sampling)},
         {"seed", settings.seed},
         {"error_target", settings.error_target},
         {"time_limit_s", settings.time_limit_s},
         {"packets", settings.packets},
         {"zones", run.zones},
         {"bands", run.bands.names()}});
}

void RunLog::add(const SolveProgress& now) {
  if (now.examines) return;
  if (matrix_) {
    const int hundredths = static_cast<int>(100 * now.fraction);
    if (hundredths <= hundredths_) return;
    hundredths_ = hundredths;
    write({{"event", "progress"}, {"seconds", now.seconds}, {"fraction", now.fraction}});
    return;
  }
  write({{"event", "batch"},
         {"seconds", now.seconds},
         {"batches", now.batches},
         {"packets", now.packets},
         {"rays", now.rays},
         {"error", now.error},
         {"error_bound", now.error_bound},
         {"unshot_share", now.unshot_share}});
}

void RunLog::finish(const Solution& solution) {
  const SolveRecord& record = solution.record;
  Json line{{"event", "end"},
            {"stopped", to_string(record.stopped)},
            {"seconds", record.seconds},
            {"batches", solution.sums.batches},
            {"packets", record.packets},
            {"rays", record.rays},
            {"error", record.error},
            {"error_bound", record.error_bound},
            {"error_95th_percentile", record.error_95th_percentile},
            {"unshot_share", solution.audit.worst_unshot_share()}};
  add_zones(line, record.gather_bias);
  write(line);
}

void RunLog::write(const Json& line) {
  if (!stream_) return;
  const std::string text = line.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
  if (std::fwrite(text.data(), 1, text.size(), stream_.get()) == text.size() &&
      std::fflush(stream_.get()) == 0)
    return;
  stream_.reset();
  print_warnings(
      {fmt::format("{}: cannot be written any further; the run goes on without it", file_.string())});
}

}  // namespace reemit::cli

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/convergence/page_template.h"
#include "bench/convergence/report.h"
#include "bench/convergence/summary.h"

namespace reemit::bench {
namespace {

constexpr std::array<double, 4> kErrors{0.05, 0.02, 0.01, 0.005};

std::string time_cell(const TimeToError& time) {
  const auto seconds =
      time.seconds < 100 ? fmt::format("{:.2g}", time.seconds) : fmt::format("{:.0f}", time.seconds);
  switch (time.reach) {
    case Reach::kMeasured:
      return seconds;
    case Reach::kAtMost:
      return fmt::format("≤ {}", seconds);
    case Reach::kExtrapolated:
      return fmt::format("*{}*", seconds);
    case Reach::kNever:
      break;
  }
  return "–";
}

std::string percent(double share) {
  return fmt::format("{:.2g} %", 100 * share);
}

std::string time_table(const std::vector<Curve>& curves) {
  std::string text =
      "| room | method | 5 % | 2 % | 1 % | 0.5 % | longest run | its error (least .. most) | stays |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  for (const Curve& c : curves) {
    const std::vector<CurvePoint> points = c.medians();
    text += fmt::format("| {} | {} |", c.room, c.method);
    for (const double error : kErrors) text += fmt::format(" {} |", time_cell(time_to_error(points, error)));
    const Level& last = c.levels.back();
    const double left = remaining_error(points);
    text += fmt::format(" {:.2g} s | {} ({} .. {}) | {} |\n", last.seconds.median, percent(last.error.median),
                        percent(last.error.least), percent(last.error.most), left > 0 ? percent(left) : "");
  }
  return text;
}

std::string rate_table(const std::vector<Curve>& curves) {
  std::string text =
      "| room | method | per | rate | least .. most over seeds | last step |\n|---|---|---|---|---|---|\n";
  for (const Curve& c : curves) {
    const std::vector<CurvePoint> points = c.medians();
    const std::optional<double> rate = convergence_rate(points);
    if (!rate) continue;
    std::vector<double> rates;
    for (const auto& seed : c.by_seed)
      if (const auto own = convergence_rate(seed)) rates.push_back(*own);
    const Spread spread = spread_of(rates);
    const auto last_step = convergence_rate({points.end() - 2, points.end()});
    text += fmt::format("| {} | {} | {} | {:.2f} | {:.2f} .. {:.2f} | {:.2f} |\n", c.room, c.method,
                        c.work_unit, *rate, spread.least, spread.most, *last_step);
  }
  return text;
}

std::string factor_row(const std::vector<Curve>& curves, const std::string& what, const std::string& room,
                       const std::string& slow, const std::string& fast, double error,
                       const std::string& asked) {
  const Curve* a = find_curve(curves, room, slow);
  const Curve* b = find_curve(curves, room, fast);
  if (a == nullptr || b == nullptr) return "";
  const Factor f = factor_between(*a, *b, error);
  std::string ratio = "–";
  if (f.ratio.median > 0)
    ratio = fmt::format("{}**{:.2g}** ({:.2g} .. {:.2g})", f.is_bound ? "≥ " : "", f.ratio.median,
                        f.ratio.least, f.ratio.most);
  return fmt::format("| {}, {} | {} | {}: {} | {}: {} | {} | {} |\n", room, what, percent(error), slow,
                     time_cell(f.slow), fast, time_cell(f.fast), ratio, asked);
}

/// In the order in which they first come.
std::vector<std::string> rooms_of(const std::vector<Curve>& curves) {
  std::vector<std::string> rooms;
  for (const Curve& c : curves)
    if (rooms.empty() || rooms.back() != c.room) rooms.push_back(c.room);
  return rooms;
}

std::string factor_table(const std::vector<Curve>& vertices, const std::vector<Curve>& stills) {
  std::string text =
      "| what | error | slower [s] | faster [s] | factor (least .. most over seeds) | aimed at |\n"
      "|---|---|---|---|---|---|\n";
  for (const std::string& room : rooms_of(vertices))
    for (const double error : {0.02, 0.01, 0.005}) {
      const bool has_aim = room == "cornell_box" && error < 0.02;
      text += factor_row(vertices, "vertices, rms", room, "gathered", "gathered and smoothed", error,
                         has_aim ? (error == 0.01 ? "6" : "8") : "");
    }
  for (const std::string& room : rooms_of(stills)) {
    const char* const aim = room.starts_with("cornell") ? "40" : "15";
    for (const double error : {0.03, 0.015})
      text += factor_row(stills, "still, median", room, "path", "gather", error, "") +
              factor_row(stills, "still, median", room, "path", "smoothed", error, error < 0.02 ? aim : "");
    text += factor_row(stills, "still, median", room, "smoothed", "next view", 0.015, "3");
  }
  return text;
}

std::string pictures(const std::vector<Curve>& curves) {
  std::string text;
  for (const std::string& room : rooms_of(curves)) {
    const std::string& quantity = curves.front().quantity;
    text += fmt::format("![error over time: {}, {}](images/{})\n", quantity, room, plot_name(quantity, room));
  }
  return text;
}

}  // namespace

void write_page(const Table& table, const std::filesystem::path& folder) {
  PageTemplate page(std::filesystem::path(REEMIT_SOURCE_DIR) / "bench/convergence/page.md.in");
  const std::vector<Curve> zones = make_curves(table, "zones", Metric::kRms);
  const std::vector<Curve> vertices = make_curves(table, "vertices", Metric::kRms);
  const std::vector<Curve> stills = make_curves(table, "still", Metric::kMedian);
  const std::vector<Curve> stills_rms = make_curves(table, "still", Metric::kRms);
  page.put_notes("notes", table.notes);
  page.put("factors", factor_table(vertices, stills));
  page.put("zone_pictures", pictures(zones));
  page.put("zone_times", time_table(zones));
  page.put("zone_rates", rate_table(zones));
  page.put("vertex_pictures", pictures(vertices));
  page.put("vertex_times", time_table(vertices));
  page.put("vertex_rates", rate_table(vertices));
  page.put("still_pictures", pictures(stills));
  page.put("still_times", time_table(stills));
  page.put("still_times_rms", time_table(stills_rms));
  page.put("still_rates", rate_table(stills));
  page.write(folder / "convergence.md");
}

}  // namespace reemit::bench

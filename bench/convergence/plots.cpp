#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "bench/convergence/gnuplot.h"
#include "bench/convergence/report.h"
#include "bench/convergence/summary.h"

namespace reemit::bench {
namespace {

/// Methods keep their colour and marker from room to room: the number of a style in plot.gp.
int style_of(const std::string& method) {
  constexpr std::array<const char*, 9> kOrder{"walk random",    "walk sobol",     "shooting random",
                                              "shooting sobol", "zones averaged", "gathered",
                                              "zones",          "gather",         "path"};
  const auto at = std::find(kOrder.begin(), kOrder.end(), method) - kOrder.begin();
  constexpr std::array<int, 10> kStyle{1, 2, 3, 4, 1, 4, 1, 4, 2, 1};
  return kStyle.at(static_cast<std::size_t>(at));
}

void plot_room(const std::vector<Curve>& curves, const std::string& y_label,
               const std::filesystem::path& folder) {
  std::string titles;
  std::string styles;
  std::string data;
  for (const Curve& c : curves) {
    titles += fmt::format("'{}' ", c.method);
    styles += fmt::format("{} ", style_of(c.method));
    for (const Level& l : c.levels)
      data += fmt::format("{} {} {} {} {} {}\n", l.seconds.median, 100 * l.error.median, l.seconds.least,
                          l.seconds.most, 100 * l.error.least, 100 * l.error.most);
    data += "\n\n";
  }
  const std::filesystem::path file =
      folder / "images" / plot_name(curves.front().quantity, curves.front().room);
  run_gnuplot(fmt::format(
      "$data << EOD\n{}EOD\ntitles = \"{}\"\nstyles = \"{}\"\nheading = \"{}\"\ny_label = \"{}\"\n"
      "output_file = \"{}\"\nload \"{}/bench/convergence/plot.gp\"\n",
      data, titles, styles, curves.front().room, y_label, file.string(), REEMIT_SOURCE_DIR));
}

}  // namespace

std::string plot_name(const std::string& quantity, const std::string& room) {
  std::string name = fmt::format("convergence_{}_{}.svg", quantity, room);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

bool draw_plots(const Table& table, const std::filesystem::path& folder) {
  if (!gnuplot_runs()) return false;
  std::filesystem::create_directories(folder / "images");
  struct Quantity {
    const char* name;
    Metric metric;
    const char* y_label;
  };
  for (const Quantity& q : {Quantity{"zones", Metric::kRms, "relative rms error of radiosity [%]"},
                            Quantity{"vertices", Metric::kRms, "relative rms error of radiance [%]"},
                            Quantity{"still", Metric::kMedian, "median relative error per pixel [%]"}}) {
    const std::vector<Curve> curves = make_curves(table, q.name, q.metric);
    for (auto first = curves.begin(); first != curves.end();) {
      const auto last =
          std::find_if(first, curves.end(), [&](const Curve& c) { return c.room != first->room; });
      plot_room({first, last}, q.y_label, folder);
      first = last;
    }
  }
  return true;
}

}  // namespace reemit::bench

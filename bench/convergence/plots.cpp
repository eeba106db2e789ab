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
  struct Style {
    const char* method;
    int number;
  };
  constexpr std::array<Style, 13> kStyles{{{"walk random", 1},
                                           {"walk sobol", 2},
                                           {"shooting random", 3},
                                           {"shooting sobol", 4},
                                           {"zones averaged", 1},
                                           {"gathered", 4},
                                           {"gathered and smoothed", 5},
                                           {"zones", 1},
                                           {"gather", 4},
                                           {"smoothed", 5},
                                           {"refined", 6},
                                           {"next view", 7},
                                           {"path", 2}}};
  const auto* const found = std::find_if(kStyles.begin(), kStyles.end(),
                                         [&](const Style& style) { return style.method == method; });
  return found == kStyles.end() ? 3 : found->number;
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

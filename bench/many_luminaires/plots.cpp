#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/convergence/gnuplot.h"
#include "bench/many_luminaires/page.h"
#include "bench/many_luminaires/parts.h"

namespace reemit::bench {
namespace {

std::string data_line(const Spread& x, const Spread& y) {
  return fmt::format("{} {} {} {} {} {}\n", x.median, y.median, x.least, x.most, y.least, y.most);
}

void plot_stills(const Figures& figures, const std::filesystem::path& file) {
  constexpr std::array kStyles{1, 2, 4};  // of plot.gp, as kSelections
  std::string titles;
  std::string styles;
  std::string data;
  for (std::size_t k = 0; k < kSelections.size(); ++k) {
    const std::string name(name_of(kSelections[k]));
    std::string lines;
    for (const Figure& f : figures.rows) {
      if (f.part != "panels" || f.selection != name || f.quantity != "wall time [s]") continue;
      const Figure* error = figures.find(f.part, f.subject, f.count, name, "median error");
      if (error == nullptr) continue;
      const Spread& e = error->value;
      lines += data_line(f.value, {100 * e.median, 100 * e.least, 100 * e.most});
    }
    if (lines.empty()) continue;
    data += lines + "\n\n";
    titles += fmt::format("'{}' ", name);
    styles += fmt::format("{} ", kStyles[k]);
  }
  if (data.empty()) return;
  run_gnuplot(
      fmt::format("$data << EOD\n{}EOD\ntitles = \"{}\"\nstyles = \"{}\"\nheading = \"a hundred panels\"\n"
                  "y_label = \"median relative error per pixel [%]\"\noutput_file = \"{}\"\n"
                  "load \"{}/bench/convergence/plot.gp\"\n",
                  data, titles, styles, file.string(), REEMIT_SOURCE_DIR));
}

void plot_growth(const Figures& figures, const std::filesystem::path& file) {
  std::string titles;
  std::string styles;
  std::string data;
  int style = 0;
  for (const char* kind : {"spheres", "triangles"})
    for (const Selection s : kSelections) {
      ++style;
      const std::string name(name_of(s));
      std::string lines;
      for (const Figure& f : figures.rows) {
        if (f.part != "growth" || f.subject != kind || f.selection != name ||
            f.quantity != "time per sample [ns]")
          continue;
        const auto count = static_cast<double>(f.count);
        lines += data_line({count, count, count}, f.value);
      }
      if (lines.empty()) continue;
      data += lines + "\n\n";
      titles += fmt::format("'{}, {}' ", kind, name);
      styles += fmt::format("{} ", style);
    }
  if (data.empty()) return;
  run_gnuplot(
      fmt::format("$data << EOD\n{}EOD\ntitles = \"{}\"\nstyles = \"{}\"\noutput_file = \"{}\"\n"
                  "load \"{}/bench/many_luminaires/growth.gp\"\n",
                  data, titles, styles, file.string(), REEMIT_SOURCE_DIR));
}

}  // namespace

bool plot_many_luminaires(const Figures& figures, const std::filesystem::path& folder) {
  if (!gnuplot_runs()) return false;
  plot_stills(figures, folder / "images" / "many_luminaires_stills.svg");
  plot_growth(figures, folder / "images" / "many_luminaires_growth.svg");
  return true;
}

}  // namespace reemit::bench

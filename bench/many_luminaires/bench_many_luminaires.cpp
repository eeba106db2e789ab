// Choice of luminaires by constant, linear and spatial selection: time per sample, error over time, growth
// with their number; as a table, pictures and a page of text.
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "bench/convergence/jobs.h"
#include "bench/many_luminaires/figures.h"
#include "bench/many_luminaires/page.h"
#include "bench/many_luminaires/parts.h"
#include "bench/program_options.h"

namespace reemit::bench {
namespace {

struct Part {
  const char* name;
  void (*measure)(const RunSettings&, Figures&);
};

constexpr Part kParts[] = {
    {"sphereflake", measure_sphereflake}, {"panels", measure_panels}, {"growth", measure_growth}};

std::string machine_note(const RunSettings& settings) {
  double load = 0;
  const bool known = getloadavg(&load, 1) == 1;
  return fmt::format(
      "{} cores; times per sample are those of one thread; {} threads for stills, {} seeds{}{}",
      std::thread::hardware_concurrency(), settings.threads, settings.seeds,
      known ? fmt::format("; load average before the run {:.2f}", load) : "",
      settings.quick ? "; short run: fewer points, samples and luminaires" : "");
}

Figures measure(const RunSettings& settings, const std::vector<std::string>& only) {
  Figures figures;
  figures.notes.push_back(machine_note(settings));
  const double seconds = seconds_of([&] {
    for (const Part& part : kParts)
      if (only.empty() || std::find(only.begin(), only.end(), part.name) != only.end())
        part.measure(settings, figures);
  });
  figures.notes.push_back(fmt::format("the whole measurement took {:.0f} s", seconds));
  return figures;
}

}  // namespace
}  // namespace reemit::bench

int main(int argc, char** argv) {
  using namespace reemit::bench;
  ProgramOptions app("Time and error of the ways to choose one luminaire among many");
  RunSettings settings;
  std::string folder;
  std::vector<std::string> only;
  bool from_table = false;
  app.add_option("--write", folder, "Folder for many_luminaires.csv, many_luminaires.md and images/")
      .required();
  app.add_option("--threads", settings.threads, "Threads of references and stills")
      .show_default()
      .in_range(1, 1024);
  app.add_option("--seeds", settings.seeds, "Runs of each measured error").show_default().in_range(1, 100);
  app.add_option("--only", only, "Measure this part only (may be repeated)")
      .one_of({"sphereflake", "panels", "growth"});
  app.add_flag("--quick", settings.quick, "Short run: fewer points, samples and luminaires");
  app.add_flag("--from-table", from_table,
               "Measure nothing: page and plots from the many_luminaires.csv that is there");
  if (const auto exit_code = app.parse(argc, argv)) return *exit_code;
  try {
    settings.folder = folder;
    std::filesystem::create_directories(settings.folder / "images");
    const std::filesystem::path table = settings.folder / "many_luminaires.csv";
    if (!from_table) write_figures(measure(settings, only), table);
    const Figures figures = read_figures(table);
    write_many_luminaires_page(figures, settings.folder);
    if (!plot_many_luminaires(figures, settings.folder))
      fmt::print(stderr, "gnuplot does not run: no plots. Install it and run again with --from-table.\n");
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
  return 0;
}

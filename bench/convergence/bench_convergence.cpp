// Error over time of zones, vertices and stills, as a table, plots and a page of text.
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <string>

#include <fmt/format.h>

#include "bench/convergence/jobs.h"
#include "bench/convergence/report.h"
#include "bench/processor_name.h"
#include "bench/program_options.h"

namespace reemit::bench {

void report(const Measurement& row, Table& table) {
  fmt::print(stderr, "{:<17} {:<9} {:<16} seed {} level {}: {:8.3f} s  rms {:7.3f} %  median {:7.3f} %\n",
             row.room, row.quantity, row.method, row.seed, row.level, row.seconds, 100 * row.error.rms,
             100 * row.error.median);
  table.rows.push_back(row);
}

namespace {

std::string machine_note(const Options& options) {
  double load = 0;
  const bool known = getloadavg(&load, 1) == 1;
  return fmt::format("{}, {} threads, {} seeds{}{}", processor_name(), options.threads, options.seeds,
                     known ? fmt::format(", load average before the run {:.2f}", load) : "",
                     options.quick ? ", short run: less work in references, longest levels left out" : "");
}

struct Jobs {
  bool zones = true;
  bool vertices = true;
  bool stills = true;
};

Table measure(const Options& options, const Jobs& jobs, const std::vector<std::string>& only) {
  Table table;
  table.notes.push_back(machine_note(options));
  const ReferenceCache cache(options.reference_cache);
  const double seconds = seconds_of([&] {
    for (const StudiedRoom& room : find_rooms(options, table)) {
      if (!only.empty() && std::find(only.begin(), only.end(), room.name) == only.end()) continue;
      if (jobs.zones && !room.stills_only) measure_zones(room, options, cache, table);
      if (jobs.vertices && !room.stills_only) measure_vertices(room, options, cache, table);
      if (jobs.stills) measure_stills(room, options, cache, table);
    }
  });
  table.notes.push_back(fmt::format("the whole measurement took {:.0f} s, {}", seconds,
                                    options.reference_cache.empty()
                                        ? "references included"
                                        : "references kept from earlier runs not included"));
  return table;
}

}  // namespace
}  // namespace reemit::bench

int main(int argc, char** argv) {
  using namespace reemit::bench;
  ProgramOptions app("Error over time of zones, vertices and stills against long references");
  Options options;
  Jobs jobs;
  std::string folder;
  std::vector<std::string> only;
  std::vector<std::string> quantities;
  bool from_table = false;
  app.add_option("--write", folder, "Folder for convergence.csv, convergence.md and images/").required();
  app.add_option("--rooms", options.rooms,
                 "Folder below which erw5/scene3.mgf and erw5/scene6.mgf are looked for");
  app.add_option("--threads", options.threads, "Threads").show_default().in_range(1, 1024);
  app.add_option("--seeds", options.seeds, "Runs of each method and level").show_default().in_range(1, 100);
  app.add_option("--reference-cache", options.reference_cache,
                 "Folder in which references are kept from run to run");
  app.add_option("--only-room", only, "Measure this room only (may be repeated)");
  app.add_option("--only", quantities, "Measure this only (may be repeated)")
      .one_of({"zones", "vertices", "stills"});
  app.add_flag("--quick", options.quick,
               "Short run: longest levels left out, references with a quarter of the work");
  app.add_flag("--from-table", from_table,
               "Measure nothing: page and plots from the convergence.csv that is there");
  if (const auto exit_code = app.parse(argc, argv)) return *exit_code;
  try {
    const std::filesystem::path out(folder);
    std::filesystem::create_directories(out);
    const auto wanted = [&](const char* name) {
      return quantities.empty() || std::find(quantities.begin(), quantities.end(), name) != quantities.end();
    };
    jobs = {wanted("zones"), wanted("vertices"), wanted("stills")};
    if (!from_table) write_table(measure(options, jobs, only), out / "convergence.csv");
    const Table table = read_table(out / "convergence.csv");
    write_page(table, out);
    if (!draw_plots(table, out))
      fmt::print(stderr, "gnuplot does not run: no plots. Install it and run again with --from-table.\n");
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
  return 0;
}

#include "bench/zone_plans/plan_plot.h"

#include <algorithm>

#include <fmt/format.h>

#include "bench/convergence/gnuplot.h"

namespace reemit::bench {

void draw_plans(const std::vector<PlanRow>& rows, bool by_time, const std::filesystem::path& file) {
  std::vector<std::string> rooms;
  for (const PlanRow& row : rows)
    if (std::find(rooms.begin(), rooms.end(), row.room) == rooms.end()) rooms.push_back(row.room);
  std::string data;
  std::string panels[2];
  for (int k = 0; k < 2; ++k) {
    int colour = 0;
    for (const std::string& room : rooms) {
      ++colour;
      for (const bool fitting : {false, true}) {
        const std::string name = fmt::format("$d{}_{}_{}", k, colour, fitting ? 1 : 0);
        data += name + " << EOD\n";
        std::size_t count = 0;
        for (const PlanRow& r : rows) {
          const double y = k == 0 ? r.points : r.picture_zones;
          if (r.room != room || r.fitting != fitting || !(y > 0)) continue;
          data += fmt::format("{} {}\n", by_time ? r.zoning_s + r.solve_s : static_cast<double>(r.zones),
                              100 * y);
          ++count;
        }
        data += "EOD\n";
        if (count == 0) continue;
        panels[k] += fmt::format(
            "{}{} using 1:2 with linespoints lc rgb word(colours, {}) lw 1.6 dt {} pt {} ps 0.6 title '{}'",
            panels[k].empty() ? "plot " : ", ", name, colour, fitting ? 1 : 2, fitting ? 7 : 6,
            room + (fitting ? ", fit the light" : ", of one size"));
      }
    }
  }
  run_gnuplot(fmt::format(
      "{}set terminal svg noenhanced size 1100,620 font 'Helvetica,12' background 'white'\nset output '{}'\n"
      "colours = '#2a6f97 #c8553d #5b8c5a #7a5195'\n"
      "set multiplot layout 1,2\nset logscale xy\nset grid xtics ytics lc rgb '#dddddd'\n"
      "set key below font ',10' samplen 2 maxcols 2\nset xlabel '{}'\nset format y '%g %%'\n"
      "set title 'points against their zones'\n{}\nset title 'picture that shows the zones'\n{}\n"
      "unset multiplot\n",
      data, file.string(), by_time ? "seconds of zoning and solving" : "zones", panels[0], panels[1]));
}

}  // namespace reemit::bench

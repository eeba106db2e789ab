#include "bench/validation/plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "scenes/model/error.h"

namespace reemit::validation {
namespace {

void run_gnuplot(const std::string& script, const std::filesystem::path& svg) {
  const auto close = [](std::FILE* f) { return pclose(f); };
  std::unique_ptr<std::FILE, decltype(close)> pipe(popen("gnuplot", "w"), close);
  const std::string all =
      fmt::format("set terminal svg size 760,440 font 'sans-serif,13' background 'white'\nset output '{}'\n",
                  svg.string()) +
      script;
  const bool written = pipe && std::fwrite(all.data(), 1, all.size(), pipe.get()) == all.size();
  if (!written || pclose(pipe.release()) != 0)
    throw ResourceError(svg.string(), "gnuplot could not draw it", "Its message is above.");
}

}  // namespace

void require_gnuplot() {
  if (std::system("gnuplot --version > /dev/null 2>&1") != 0)
    throw ResourceError("plots", "gnuplot is not installed",
                        "Install it (apt-get install gnuplot-nox), or leave out --write.");
}

void plot_deviations(const std::vector<ValidationRow>& rows, const std::filesystem::path& svg) {
  constexpr double kWidth = 0.25;
  constexpr int kBins = 40;  // from -5 to 5
  std::array<int, kBins> counts{};
  std::vector<int> freedoms;
  for (const ValidationRow& r : rows) {
    if (!r.is_noisy()) continue;
    freedoms.push_back(r.freedom);
    const double bin = std::floor(r.deviation() / kWidth) + kBins / 2.0;
    ++counts[static_cast<std::size_t>(std::clamp(bin, 0.0, kBins - 1.0))];
  }
  std::string script =
      "set xlabel 'deviation / standard errors'\nset ylabel 'rows'\nset style fill solid 0.5\n"
      "set xrange [-5:5]\nset boxwidth 0.23\nset key top left\n"
      "plot '-' with boxes lc rgb '#4477aa' title 'measured', "
      "'-' with lines lw 2 lc rgb '#cc3311' title \"Student's t\"\n";
  for (int b = 0; b < kBins; ++b)
    script += fmt::format("{} {}\n", (b - kBins / 2 + 0.5) * kWidth, counts[static_cast<std::size_t>(b)]);
  script += "e\n";
  for (double t = -5; t <= 5; t += 0.05) {
    double density = 0;
    for (const int freedom : freedoms) density += student_density(t, freedom);
    script += fmt::format("{:.3f} {:.5f}\n", t, density * kWidth);
  }
  run_gnuplot(script + "e\n", svg);
}

void plot_convergence(const std::vector<CubeStep>& steps, const std::filesystem::path& svg) {
  std::string script =
      "set logscale xy\nset xlabel 'zones along an edge of the cube'\n"
      "set ylabel 'deviation from the continuous solution [%]'\nset format y '%g'\n"
      "set xrange [0.8:20]\nset xtics (1,2,4,8,16)\nset key bottom left\nset grid ytics\n"
      "plot '-' with linespoints pt 4 dt 2 lc rgb '#999999' title 'squares, exact zonal system', "
      "'-' with yerrorlines pt 7 lc rgb '#4477aa' title 'triangles, shooting', "
      "'-' with yerrorlines pt 9 lc rgb '#228833' title 'gather, every hit read', "
      "'-' with yerrorlines pt 5 lc rgb '#cc3311' title 'gather, close hits carried on'\n";
  const auto series = [&](const auto& value_and_error) {
    for (const CubeStep& s : steps) {
      if (s.face != "z0" || s.rho != 0.5) continue;
      const auto [value, error] = value_and_error(s);
      const double percent = 100 * std::fabs(value / s.continuous - 1);
      const double spread = 100 * error / s.continuous;
      script += fmt::format("{} {:.6g} {:.6g} {:.6g}\n", s.divisions, percent,
                            std::max(percent - spread, 1e-4), percent + spread);
    }
    script += "e\n";
  };
  const auto of_row = [](const ValidationRow& r) { return std::pair(r.measured, r.standard_error); };
  series([](const CubeStep& s) { return std::pair(s.square_zones, 0.0); });
  series([&](const CubeStep& s) { return of_row(s.zones); });
  series([&](const CubeStep& s) { return of_row(s.plain_gather); });
  series([&](const CubeStep& s) { return of_row(s.gather); });
  run_gnuplot(script, svg);
}

}  // namespace reemit::validation

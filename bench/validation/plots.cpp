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
  const std::string all = fmt::format(
                              "set terminal svg size 760,440 noenhanced font 'sans-serif,13' background "
                              "'white'\nset output '{}'\n",
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
  constexpr const char* kPlace = "x0(0.5,0.1)";
  std::string script =
      "set logscale x\nset xlabel 'N (2 N x N triangular zones on each face)'\n"
      "set ylabel 'deviation from the continuous solution [%]'\n"
      "set xrange [0.8:20]\nset xtics (1,2,4,8,16)\nset key bottom right\nset grid ytics\n"
      "plot '-' with yerrorlines pt 7 lc rgb '#4477aa' title 'value of the zone, rho 0.5', "
      "'-' with yerrorlines pt 6 lc rgb '#99bbdd' title 'value of the zone, rho 0.8', "
      "'-' with yerrorlines pt 9 lc rgb '#228833' title 'gather, every hit read, rho 0.5', "
      "'-' with yerrorlines pt 8 lc rgb '#88cc99' title 'gather, every hit read, rho 0.8', "
      "'-' with yerrorlines pt 5 lc rgb '#cc3311' title 'gather, close hits carried on, rho 0.5', "
      "'-' with yerrorlines pt 4 lc rgb '#ee9977' title 'gather, close hits carried on, rho 0.8'\n";
  for (const auto row : {&CubeStep::zones, &CubeStep::plain_gather, &CubeStep::gather})
    for (const double rho : {0.5, 0.8}) {
      for (const CubeStep& s : steps)
        if (s.place == kPlace && s.rho == rho)
          script +=
              fmt::format("{} {:.6g} {:.6g}\n", s.divisions, 100 * ((s.*row).measured / s.continuous - 1),
                          100 * (s.*row).standard_error / s.continuous);
      script += "e\n";
    }
  run_gnuplot(script, svg);
}

}  // namespace reemit::validation

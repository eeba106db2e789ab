// What gathering on small zones buys: the error of zones by size, with and without it, at equal time.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <exception>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/program_options.h"
#include "solver/progressive_solver.h"
#include "tests/support/variable_furnace.h"

namespace {

using namespace reemit;

/// A furnace of known radiosity whose zones have areas from 1e-8 to 1 of the largest.
test::VariableFurnace room_of_many_sizes() {
  test::VariableFurnace furnace(16);
  double x = 0.1;
  for (const double size : {0.3, 0.1, 0.03, 0.01, 0.003, 0.001, 0.0003, 0.0001}) {
    furnace.screen({x, 0.15, 0.3}, {size, 0, 0}, {0, 0.4 * size, size}, 6);
    x += size + 0.1;
  }
  return furnace;
}

/// Squared relative errors of the zones of one decile by size.
struct Decile {
  double largest_area = 0;
  double before2 = 0;
  double after2 = 0;
  std::int64_t count = 0;
};

void measure(int seeds, double seconds, int threads) {
  const test::VariableFurnace furnace = room_of_many_sizes();
  const MeshResult mesh = furnace.room().mesh();
  std::vector<ZoneId> by_area;
  for (std::size_t z = 0; z < mesh.mesh.zone_count(); ++z) by_area.push_back(ZoneId(z));
  std::stable_sort(by_area.begin(), by_area.end(),
                   [&](ZoneId a, ZoneId b) { return mesh.mesh.zone_area(a) < mesh.mesh.zone_area(b); });
  const double largest = mesh.mesh.zone_area(by_area.back());

  std::vector<Decile> deciles(10);
  const std::atomic<bool> never{false};
  double spent[2] = {0, 0};
  std::uint64_t gathered = 0;
  for (int seed = 1; seed <= seeds; ++seed)
    for (const bool gather : {false, true}) {
      SolverSettings settings;
      settings.time_limit_s = seconds;
      settings.gather_small_zones = gather;
      settings.seed = static_cast<std::uint64_t>(seed);
      settings.threads = threads;
      const Solution s = solve(furnace.room().scene(), mesh, settings, {}, never);
      spent[gather ? 1 : 0] += s.record.seconds / seeds;
      if (gather) gathered = s.record.gathered_zones;
      for (std::size_t i = 0; i < by_area.size(); ++i) {
        Decile& decile = deciles[10 * i / by_area.size()];
        const double d = s.irradiance(by_area[i], 0).mean / test::VariableFurnace::kRadiosity - 1;
        (gather ? decile.after2 : decile.before2) += d * d;
        decile.largest_area = s.mesh.zone_area(by_area[i]) / largest;
        if (gather) ++decile.count;
      }
    }
  fmt::print(
      "{} zones, the smallest {:.1e} of the largest; {} seeds; {:.2f} s without, {:.2f} s with gathering on "
      "{} zones\n\n",
      by_area.size(), mesh.mesh.zone_area(by_area.front()) / largest, seeds, spent[0], spent[1], gathered);
  fmt::print(
      "| decile of zones by area | areas up to | rms error, packets only | with gathering "
      "|\n|---|---|---|---|\n");
  for (std::size_t d = 0; d < deciles.size(); ++d) {
    const auto n = static_cast<double>(deciles[d].count);
    fmt::print("| {} | {:.1e} | {:.3g} % | {:.3g} % |\n", d + 1, deciles[d].largest_area,
               100 * std::sqrt(deciles[d].before2 / n), 100 * std::sqrt(deciles[d].after2 / n));
  }
}

}  // namespace

int main(int argc, char** argv) {
  bench::ProgramOptions app("Error of zones by size with and without gathering on small ones, at equal time");
  int seeds = 5;
  double seconds = 2;
  int threads = 2;
  app.add_option("--seeds", seeds, "Independent runs").show_default().in_range(1, 1000);
  app.add_option("--time", seconds, "Time of each solve [s]").show_default().positive();
  app.add_option("--threads", threads, "Threads").show_default();
  if (const auto exit_code = app.parse(argc, argv)) return *exit_code;
  try {
    measure(seeds, seconds, threads);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
  return 0;
}

// Where rounding shows: rooms of any size and anywhere, reflectance near 1, very large batches. The same seed
// gives the same random numbers, so a deviation from the room as given is rounding, and the packets that it
// sends elsewhere.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/program_options.h"
#include "mesh/build_mesh.h"
#include "scenes/io/scene_reader.h"
#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "solver/tally/batch_books.h"
#include "tests/support/transformed_room.h"
#include "tests/support/variable_furnace.h"
#include "viewer_export/still/render_still.h"

namespace {

using namespace reemit;

const std::atomic<bool> kNever{false};

struct Result {
  Solution solution;
  StillImage still;
};

constexpr std::uint64_t kPackets = 10'000'000;

Result run(const Scene& scene, double zone_area) {
  MeshSettings mesh;
  mesh.zone_area = zone_area;
  SolverSettings settings;
  settings.packets = kPackets;
  Result result;
  result.solution = solve(scene, build_mesh(scene, mesh), settings, {}, kNever);
  const Room walls(scene, result.solution.mesh);
  StillSettings still;
  still.width = still.height = 64;
  still.spp = 64;
  result.still = render_still(walls, result.solution, scene.cameras.at(0), still, {}, kNever);
  return result;
}

std::int64_t escaped(const Solution& s) {
  std::int64_t quanta = 0;
  for (const BandAudit& band : s.audit.bands) quanta += static_cast<std::int64_t>(band.total_escaped());
  return quanta;
}

/// Rms over the pixels, first band, of the difference in its standard errors.
double still_deviation(const StillImage& a, const StillImage& b) {
  const std::size_t bands = a.bands.count();
  double sum = 0;
  int count = 0;
  for (std::size_t k = 0; k < a.radiance.size(); k += bands) {
    const double variance = std::pow(static_cast<double>(a.radiance_stderr[k]), 2) +
                            std::pow(static_cast<double>(b.radiance_stderr[k]), 2);
    if (!(variance > 0)) continue;
    sum += std::pow(static_cast<double>(a.radiance[k] - b.radiance[k]), 2) / variance;
    ++count;
  }
  // With 7 degrees of freedom each, squares of independent differences have the mean 7/5.
  return std::sqrt(sum / count / 1.4);
}

void print_row(const std::string& name, const Result& result, const Result& original) {
  const Solution& a = result.solution;
  const Solution& b = original.solution;
  std::string same = "another triangulation";
  if (a.mesh.zone_count() == b.mesh.zone_count()) {
    std::size_t equal = 0;
    for (std::size_t z = 0; z < a.mesh.zone_count(); ++z) {
      const double x = a.irradiance(ZoneId(z), 0).mean;
      const double y = b.irradiance(ZoneId(z), 0).mean;
      if (std::abs(x - y) <= 1e-12 * y) ++equal;
    }
    same = fmt::format("{:.1f} %",
                       100.0 * static_cast<double>(equal) / static_cast<double>(a.mesh.zone_count()));
  }
  const std::vector<double> deviations = test::surface_deviations(a, b);
  const double worst = *std::max_element(deviations.begin(), deviations.end());
  fmt::print("| {} | {} | {:.2f} | {:.2f} | {:+.1e} | {} |\n", name, same, worst,
             still_deviation(result.still, original.still),
             static_cast<double>(escaped(a) - escaped(b)) /
                 static_cast<double>(std::max<std::int64_t>(1, escaped(b))),
             a.audit.balanced() ? "0" : "NOT 0");
  std::fflush(stdout);
}

void measure_transforms(const std::string& room) {
  const Scene scene = read_scene(room);
  const double size = test::room_size(scene);
  const double zone_area = size * size / 4000;
  const Result original = run(scene, zone_area);
  fmt::print(
      "{}, {} zones, {:.0e} packets, same seed. Deviations from the room as given in standard errors.\n\n",
      room, original.solution.mesh.zone_count(), static_cast<double>(kPackets));
  fmt::print(
      "| room | zones that agree to 1e-12 | surface means, largest deviation | pixels, rms deviation | "
      "escaped power | balance |\n|---|---|---|---|---|---|\n");
  const Vec3 direction = Vec3(1, -0.7, 0.4).normalized();
  struct Case {
    std::string name;
    double scale;
    double shift;  // in room sizes
  };
  for (const Case& c : std::vector<Case>{{"x 2^-10", 0x1p-10, 0},
                                         {"x 2^20", 0x1p20, 0},
                                         {"x 0.001", 1e-3, 0},
                                         {"x 0.37", 0.37, 0},
                                         {"x 1,000", 1e3, 0},
                                         {"x 1,000,000", 1e6, 0},
                                         {"moved by 1 room size", 1, 1},
                                         {"moved by 100", 1, 100},
                                         {"moved by 10,000", 1, 1e4},
                                         {"x 0.001, moved by 10,000", 1e-3, 1e4},
                                         {"x 1,000,000, moved by 10,000", 1e6, 1e4}})
    print_row(c.name,
              run(test::transformed(scene, c.scale, c.shift * c.scale * size * direction),
                  zone_area * c.scale * c.scale),
              original);
}

/// Furnace of one reflectance: every zone should have radiosity 1/(1 - rho).
void measure_reflectance() {
  fmt::print(
      "\nFurnace of 1,536 zones that emit 1 W/m2, 2e6 packets.\n\n"
      "| reflectance | method | mean over the truth - 1 | its standard error | zones, rms error | unshot | "
      "balance |\n|---|---|---|---|---|---|---|\n");
  for (const double rho : {0.5, 0.9, 0.99, 0.999})
    for (const SolveMethod method : {SolveMethod::kShooting, SolveMethod::kWalk}) {
      test::RoomBuilder room;
      const MaterialId all = room.material("all", rho, 1);
      room.box(Vec3::Zero(), Vec3(3, 2, 1), {all, all, all, all, all, all}, 8);
      SolverSettings settings;
      settings.method = method;
      settings.packets = 2'000'000;
      const Solution s = solve(room.scene(), room.mesh(), settings, {}, kNever);
      const double truth = 1 / (1 - rho);
      double area = 0;
      double mean = 0;
      double squares = 0;
      std::vector<double> groups(ZoneSums::kGroups, 0.0);
      for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
        const double a = s.mesh.zone_area(ZoneId(z));
        const double d = s.irradiance(ZoneId(z), 0).mean / truth - 1;
        area += a;
        mean += a * d;
        squares += a * d * d;
        for (std::size_t g = 0; g < groups.size(); ++g)
          groups[g] += a * (s.sums.group_total[g * s.mesh.zone_count() + z] /
                                static_cast<double>(s.sums.group_weight[g]) / truth -
                            1);
      }
      double spread = 0;
      for (const double g : groups) spread += std::pow((g - mean) / area, 2);
      const auto n = static_cast<double>(groups.size());
      const BandAudit& band = s.audit.bands[0];
      fmt::print("| {} | {} | {:+.1e} | {:.1e} | {:.3f} % | {:.1e} | {} |\n", rho, to_string(method),
                 mean / area, std::sqrt(spread / (n * (n - 1))), 100 * std::sqrt(squares / area),
                 static_cast<double>(band.unshot) / static_cast<double>(band.emitted),
                 s.audit.balanced() ? "0" : "NOT 0");
      std::fflush(stdout);
    }
}

/// The same number of packets in batches of very different size.
void measure_batches(double packets) {
  fmt::print(
      "\nVariable furnace of 4,096 zones of radiosity {}, {:.0e} packets.\n\n"
      "| packets in a batch | quanta of a packet | mean over the truth - 1 | zones, rms error | balance |\n"
      "|---|---|---|---|---|\n",
      test::VariableFurnace::kRadiosity, packets);
  const test::VariableFurnace furnace(17);
  for (const double batches : {1000.0, 10.0, 1.0}) {
    SolverSettings settings;
    settings.packets = static_cast<std::uint64_t>(packets);
    settings.batch_packets = static_cast<std::uint64_t>(packets / batches);
    settings.gather_small_zones = false;
    const Solution s = solve(furnace.room().scene(), furnace.room().mesh(), settings, {}, kNever);
    double area = 0;
    double mean = 0;
    double squares = 0;
    for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
      const double a = s.mesh.zone_area(ZoneId(z));
      const double d = s.irradiance(ZoneId(z), 0).mean / test::VariableFurnace::kRadiosity - 1;
      area += a;
      mean += a * d;
      squares += a * d * d;
    }
    fmt::print("| {:.0e} | {:.1e} | {:+.1e} | {:.4f} % | {} |\n", packets / batches,
               static_cast<double>(kBatchQuanta) / (packets / batches), mean / area,
               100 * std::sqrt(squares / area), s.audit.balanced() ? "0" : "NOT 0");
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  bench::ProgramOptions app(
      "Rounding: rooms of any size and anywhere, reflectance near 1, very large batches");
  std::string room;
  double packets = 1e8;
  app.add_option("room", room, "Room file").required();
  app.add_option("--packets", packets, "Packets of the comparison of batch sizes").show_default();
  if (const auto exit_code = app.parse(argc, argv)) return *exit_code;
  try {
    measure_transforms(room);
    measure_reflectance();
    measure_batches(packets);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
  return 0;
}

// Daylight in a room with a window: daylight factors along its depth, gathered and path traced, and the error
// of the sky's first flight by packets and by shadow rays. docs/sky.md has the tables.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "bench/program_options.h"
#include "bench/vector_option.h"
#include "scenes/io/scene_reader.h"
#include "scenes/model/stopwatch.h"
#include "solver/gather/direct_light.h"
#include "solver/gather/gather_batch.h"
#include "solver/gather/hemisphere_gather.h"
#include "solver/gather/path_tracer.h"
#include "solver/gather/point_sampler.h"
#include "solver/progressive_solver.h"
#include "solver/shoot/packet_batch.h"
#include "solver/zoning/build_zones.h"

namespace {

using namespace reemit;

struct Settings {
  std::filesystem::path room;
  ReadOptions read;
  std::uint64_t packets = 4'000'000;
  int zones = 4000;
  int rays = 1 << 14;  // of a point
  std::vector<double> from{2, 0.85, 0.25}, to{2, 0.85, 5.75}, normal{0, 1, 0};
  int points = 12;
};

MeshResult zones_of(const Scene& scene, int count) {
  MeshSettings mesh;
  mesh.default_zone_count = count;
  return build_zones(scene, mesh);
}

/// Mean over 32 independent runs, with its standard error.
struct Mean {
  double value = 0, error = 0;
};

template <class Run>
Mean mean_of_runs(Run&& run) {
  constexpr int kRuns = 32;
  std::array<double, kRuns> values;
  tbb::parallel_for(0, kRuns, [&](int r) { values[static_cast<std::size_t>(r)] = run(r); });
  double sum = 0;
  double squares = 0;
  for (const double v : values) sum += v;
  for (const double v : values) squares += (v - sum / kRuns) * (v - sum / kRuns);
  return {sum / kRuns, std::sqrt(squares / (kRuns * (kRuns - 1)))};
}

SurfacePoint surface_below(const Room& room, const Vec3& point, const Vec3& normal) {
  Hit hit;
  const Vec3f direction = (-normal).cast<float>();
  if (!room.rays().closest(room.rays().normalised(point), direction, hit))
    throw std::invalid_argument("nothing lies below the points: --from, --to, --normal");
  return surface_point(room.rays(), hit, direction);
}

/// Daylight factors of points in a solved room [%].
class DaylightFactors {
 public:
  /// `rays` of each run. Scene and solution must outlive it.
  DaylightFactors(const Scene& scene, const Solution& solution, int rays)
      : room_(scene, solution.mesh),
        direct_(room_),
        field_(room_, solution, 16),
        gather_(field_, direct_, {.caustics = true}),
        paths_(room_, direct_, 7),
        rays_(rays),
        efficacy_(scene.bands.efficacy_lm_per_w()),
        outside_((efficacy_ * horizontal_sky_irradiance(*scene.sky, scene.bands)).sum()) {}

  /// Straight from the sky, the rest by gathering or by paths.
  enum class Part { kDirect, kGathered, kTraced };

  const Room& room() const { return room_; }
  /// `p`: number of the point, for random numbers.
  Mean at(const SurfacePoint& x, int p, Part part) const {
    return mean_of_runs([&](int r) { return run(x, p, r, part); });
  }

 private:
  double run(const SurfacePoint& x, int p, int r, Part part) const {
    const std::size_t bands = room_.band_count();
    const PointSampler sampler(99, RngPurpose::kProbe, static_cast<std::uint64_t>(p), r, 20);
    std::vector<float> arrived(bands, 0.0F);
    const std::vector<float> weight(bands, 1.0F / static_cast<float>(rays_));
    GatherBatch batch(gather_);
    for (int i = 0; i < rays_; ++i) {
      const std::array<float, 2> u = sampler.hemisphere(i, 0, 1);
      const PathKey key{static_cast<std::uint64_t>(p), static_cast<std::uint32_t>(r),
                        static_cast<std::uint32_t>(i),
                        static_cast<std::uint32_t>(r % 16) % static_cast<std::uint32_t>(field_.parts())};
      std::vector<float> used = weight;
      if (part == Part::kDirect) direct_.add_sample(x, sampler.light(i, 0, 1), weight.data(), arrived.data());
      if (part == Part::kGathered) batch.add(x, u[0], u[1], key, weight.data(), arrived.data());
      if (part == Part::kTraced) paths_.add_indirect(x, u[0], u[1], key, used.data(), arrived.data());
    }
    batch.flush();
    const double factor = (part == Part::kDirect ? 100 : 100 * std::numbers::pi) / outside_;
    double sum = 0;
    for (std::size_t b = 0; b < bands; ++b)
      sum += factor * efficacy_[static_cast<Eigen::Index>(b)] * static_cast<double>(arrived[b]);
    return sum;
  }

  Room room_;
  DirectLight direct_;
  RadianceField field_;
  HemisphereGather gather_;
  PathTracer paths_;
  int rays_;
  Spectrum efficacy_;
  double outside_;  // on a horizontal plane [lx]
};

void daylight_factors(const Settings& settings) {
  const Scene scene = read_scene(settings.room, settings.read);
  if (!scene.sky) throw std::invalid_argument("the room has no sky: --sky");
  SolverSettings solver;
  solver.packets = settings.packets;
  const std::atomic<bool> never{false};
  const Solution solution = solve_zones(scene, zones_of(scene, settings.zones), solver, {}, never);
  const DaylightFactors factors(scene, solution, settings.rays / 32);
  const Room& room = factors.room();
  fmt::print(
      "| depth [m] | place [m] | direct [%] | gathered [%] | path traced [%] | difference [standard errors] "
      "|\n"
      "|---|---|---|---|---|---|\n");
  const Vec3 from = bench::vector_of(settings.from);
  const Vec3 to = bench::vector_of(settings.to);
  for (int p = 0; p < settings.points; ++p) {
    const double t = (p + 0.5) / settings.points;
    const SurfacePoint x = surface_below(room, from + t * (to - from), bench::vector_of(settings.normal));
    const Mean straight = factors.at(x, p, DaylightFactors::Part::kDirect);
    const Mean gathered = factors.at(x, p, DaylightFactors::Part::kGathered);
    const Mean traced = factors.at(x, p, DaylightFactors::Part::kTraced);
    const Vec3 at = room.rays().in_room(room.rays().point(x.triangle, x.u, x.v));
    fmt::print(
        "| {:.2f} | {:.2f} {:.2f} {:.2f} | {:.4g} +- {:.1g} | {:.4g} +- {:.1g} | {:.4g} +- {:.1g} | {:+.1f} "
        "|\n",
        (at - from).norm(), at.x(), at.y(), at.z(), straight.value, straight.error,
        straight.value + gathered.value, std::hypot(straight.error, gathered.error),
        straight.value + traced.value, std::hypot(straight.error, traced.error),
        (gathered.value - traced.value) / std::hypot(gathered.error, traced.error));
  }
}

/// What the sky sends straight to zones, first band [W/m2].
using ZoneLight = std::vector<double>;

ZoneLight by_shadow_rays(const Room& room, const DirectLight& direct, int rays, std::uint64_t seed) {
  const ZoneMesh& mesh = room.mesh();
  ZoneLight light(mesh.zone_count(), 0.0);
  tbb::parallel_for(std::size_t{0}, light.size(), [&](std::size_t z) {
    const PointSampler sampler(seed, RngPurpose::kProbe, z, 0, 20);
    std::vector<float> sum(room.band_count(), 0.0F);
    const std::vector<float> weight(room.band_count(), 1.0F / static_cast<float>(rays));
    for (int i = 0; i < rays; ++i) {
      const std::array<float, 2> u = sampler.place(i);
      float u0 = u[0];
      const SideCell cell = mesh.pick_cell(ZoneId(z), u0);
      const auto [a, b] = sample_triangle(u0, u[1]);
      const SidePoint at = cell_point(cell, a, b);
      direct.add_sample(surface_point(room.rays(), at.triangle, static_cast<float>(at.at.u),
                                      static_cast<float>(at.at.v), at.front),
                        sampler.light(i, 0, 1), weight.data(), sum.data());
    }
    light[z] = static_cast<double>(sum[0]);
  });
  return light;
}

ZoneLight by_packets(const PacketRoom& transport, const PacketSources& sources, std::uint32_t packets,
                     std::uint32_t batch) {
  SolverSettings settings;
  settings.seed = 11;
  BatchBooks books = transport.new_books();
  shoot_first_flight({transport, sources, settings, batch, packets}, books);
  ZoneLight light(transport.zones());
  for (std::size_t z = 0; z < light.size(); ++z)
    light[z] = static_cast<double>(books.direct[z * transport.channels().count()]) *
               sources.watts_per_quantum[0] / transport.mesh().zone_area(ZoneId(z));
  return light;
}

void first_flight(const Settings& settings) {
  const Scene scene = read_scene(settings.room, settings.read);
  if (!scene.sky) throw std::invalid_argument("the room has no sky: --sky");
  const MeshResult meshed = zones_of(scene, settings.zones);
  const Room room(scene, meshed.mesh);
  const PacketRoom transport(room);
  const DirectLight direct(room);
  const PacketSources directed = collect_packet_sources(transport);
  PacketSources by_power = directed;
  by_power.packet_share.clear();
  const ZoneLight reference = by_shadow_rays(room, direct, 1 << 13, 1);
  const auto print = [&](const char* method, double rays, double seconds, const ZoneLight& light) {
    // Zones whose view is sky by less than an eighth count as inside.
    std::array<double, 2> squares{}, sums{};
    std::vector<double> relative;
    for (std::size_t z = 0; z < light.size(); ++z) {
      const bool inside = transport.needs()[z] >= 4;
      const double area = room.mesh().zone_area(ZoneId(z));
      squares[inside ? 1 : 0] += area * std::pow(light[z] - reference[z], 2);
      sums[inside ? 1 : 0] += area * std::pow(reference[z], 2);
      if (inside && reference[z] > 0) relative.push_back(std::abs(light[z] / reference[z] - 1));
    }
    std::nth_element(relative.begin(), relative.begin() + static_cast<std::ptrdiff_t>(relative.size() / 2),
                     relative.end());
    fmt::print("| {} | {:.2g} | {:.3f} | {:.2f} | {:.2f} | {:.2f} |\n", method, rays, seconds,
               100 * std::sqrt(squares[1] / sums[1]),
               relative.empty() ? 0 : 100 * relative[relative.size() / 2],
               sums[0] > 0 ? 100 * std::sqrt(squares[0] / sums[0]) : 0);
  };
  fmt::print(
      "{} zones\n\n| method | rays | time [s] | error inside, rms [%] | median zone inside [%] | error "
      "outside, rms [%] |\n"
      "|---|---|---|---|---|---|\n",
      room.mesh().zone_count());
  for (const int rays : {4, 16, 64, 256}) {
    const std::uint64_t packets = static_cast<std::uint64_t>(rays) * room.mesh().zone_count();
    auto start = std::chrono::steady_clock::now();
    const ZoneLight gathered = by_shadow_rays(room, direct, rays, 2);
    print("shadow rays from zones", static_cast<double>(packets), seconds_since(start), gathered);
    for (const bool is_directed : {true, false}) {
      start = std::chrono::steady_clock::now();
      const ZoneLight light = by_packets(transport, is_directed ? directed : by_power,
                                         static_cast<std::uint32_t>(packets), is_directed ? 1 : 2);
      print(is_directed ? "packets where they are of use" : "packets by power alone",
            static_cast<double>(packets), seconds_since(start), light);
    }
  }
}

}  // namespace

int main(int argc, char** argv) try {
  Settings settings;
  bench::ProgramOptions program("Daylight in a room with a window");
  const auto add_room = [&](bench::ProgramOptions& command) {
    command.add_option("room", settings.room, "Room file").required().existing_file();
    command.add_option("--sky", settings.read.sky, "As reemit solve has it");
    command.add_option("--sun", settings.read.sun, "Likewise");
    command.add_option("--zones", settings.zones).positive().show_default();
  };
  bench::ProgramOptions factors = program.add_command("factors", "Daylight factors along a line");
  add_room(factors);
  factors.add_option("--packets", settings.packets, "Of the zone solution").show_default();
  factors.add_option("--rays", settings.rays, "Of each point").in_range(32, 1 << 24).show_default();
  factors.add_option("--points", settings.points).in_range(1, 10000).show_default();
  factors.add_option("--from", settings.from, "Ends of the line [m]").count(3).show_default();
  factors.add_option("--to", settings.to).count(3).show_default();
  factors.add_option("--normal", settings.normal, "Of the surfaces that the line looks down on")
      .count(3)
      .show_default();
  bench::ProgramOptions flight = program.add_command("first-flight", "Error of light straight from the sky");
  add_room(flight);
  if (const auto exit_code = program.parse(argc, argv)) return *exit_code;
  if (factors.is_given())
    daylight_factors(settings);
  else
    first_flight(settings);
  return 0;
} catch (const std::exception& problem) {
  fmt::print(stderr, "{}\n", problem.what());
  return 1;
}

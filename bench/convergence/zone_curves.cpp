// Error over time of the zone solution: walks and shooting, random and quasi-random.
#include <array>
#include <atomic>
#include <cstdint>

#include <fmt/format.h>

#include "bench/convergence/jobs.h"
#include "mesh/build_mesh.h"
#include "solver/progressive_solver.h"

namespace reemit::bench {
namespace {

/// Packets from luminaires, one level each; the reference gets a multiple of the most.
constexpr std::array<std::uint64_t, 5> kPackets{1U << 15, 1U << 17, 1U << 19, 1U << 21, 1U << 23};
constexpr std::uint64_t kReferenceFactor = 8;

/// Reflected radiosity rho E of every zone and band [W/m2] and its standard error.
Reference reflected_radiosity(const Solution& solution) {
  Reference result{solution.bands.count(), {}, {}};
  for (std::size_t i = 0; i < solution.mesh.zone_count(); ++i)
    for (std::size_t b = 0; b < result.bands; ++b) {
      const ZoneId z(i);
      const double rho = solution.zone_reflectance(z, b);
      const Estimate e = solution.irradiance(z, b);
      result.value.push_back(static_cast<float>(rho * e.mean));
      result.stderr_of_value.push_back(static_cast<float>(rho * e.stderr_of_mean));
    }
  return result;
}

std::string method_name(SolveMethod method, SamplingKind sampling) {
  return fmt::format("{} {}", to_string(method), to_string(sampling));
}

}  // namespace

void measure_zones(const StudiedRoom& room, const Options& options, const ReferenceCache& cache,
                   Table& table) {
  const std::atomic<bool> never{false};
  const MeshResult mesh = build_mesh(room.scene);
  const std::size_t levels = kPackets.size() - (options.quick ? 1 : 0);
  SolverSettings settings;
  settings.threads = options.threads;
  settings.seed = kReferenceSeed;
  settings.packets = kReferenceFactor * kPackets[levels - 1];
  const Reference reference = cache.get(
      fmt::format("zones-{}-{}-{}", content_hash(room.scene), mesh.mesh.zone_count(), settings.packets),
      [&] { return reflected_radiosity(solve(room.scene, mesh, settings, {}, never)); });
  ErrorNorm norm;
  for (std::size_t z = 0; z < mesh.mesh.zone_count(); ++z)
    norm.weight.push_back(mesh.mesh.zone_area(ZoneId(z)));
  const ErrorPair reference_error = own_error(reference, norm);
  table.notes.push_back(
      fmt::format("{}, zones: {} zones; reference: shooting, quasi-random, {} packets, {:.2g} % rms",
                  room.name, mesh.mesh.zone_count(), settings.packets, 100 * reference_error.rms));

  for (int seed = 1; seed <= options.seeds; ++seed)
    for (std::size_t level = 0; level < levels; ++level)
      for (const SolveMethod method : {SolveMethod::kWalk, SolveMethod::kShooting})
        for (const SamplingKind sampling : {SamplingKind::kRandom, SamplingKind::kSobol}) {
          settings.method = method;
          settings.sampling = sampling;
          settings.seed = static_cast<std::uint64_t>(seed);
          settings.packets = kPackets[level];
          MeshResult own_mesh = mesh;
          Solution solution;
          const double seconds =
              seconds_of([&] { solution = solve(room.scene, std::move(own_mesh), settings, {}, never); });
          report({room.name, "zones", method_name(method, sampling), settings.seed, static_cast<int>(level),
                  seconds, static_cast<double>(solution.record.rays), "rays",
                  deviation(reflected_radiosity(solution).value, reference, norm), reference_error},
                 table);
        }
}

}  // namespace reemit::bench

// Error over time of vertex values, solve included: zones around a vertex averaged, against gathering there.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "bench/convergence/jobs.h"
#include "mesh/build_mesh.h"
#include "solver/progressive_solver.h"
#include "viewer_export/vertex/vertex_gatherer.h"
#include "viewer_export/vertex/vertex_radiance.h"

namespace reemit::bench {
namespace {

/// One command line of a user: solve, then export.
struct Effort {
  std::uint64_t packets;
  int gather_rays;
  int light_samples;
};

/// Packets that the zones need when their mean is all there is.
constexpr std::array<std::uint64_t, 4> kAveragePackets{1U << 18, 1U << 20, 1U << 22, 1U << 24};
/// A gather averages the zones' noise: few packets do, and the rays of the gather decide.
constexpr std::array<Effort, 4> kGatherEfforts{
    {{1U << 17, 16, 16}, {1U << 18, 64, 32}, {1U << 19, 256, 64}, {1U << 20, 1024, 256}}};

/// The reference: more of everything, nearer to the vertex.
constexpr std::uint64_t kReferencePackets = 1U << 23;
constexpr int kReferenceGatherRays = 16384;
constexpr int kReferenceLightSamples = 4096;
constexpr double kReferenceReach = 0.02;

struct VertexChoice {
  std::size_t count = 0;            // of all vertices of the mesh
  std::vector<std::size_t> chosen;  // those that are compared
};

std::vector<float> chosen_values(const std::vector<float>& all, const VertexChoice& vertices,
                                 std::size_t bands) {
  std::vector<float> values;
  for (const std::size_t v : vertices.chosen)
    for (std::size_t b = 0; b < bands; ++b) values.push_back(all[v * bands + b]);
  return values;
}

/// Long gather at the chosen vertices.
Reference gather_reference(const Room& room, const Solution& solution, const RayScene& rays,
                           const VertexRings& rings, const VertexChoice& vertices, const Options& options) {
  VertexSettings settings;
  settings.average_zones = true;
  VertexData data = gather_vertices(room.scene, solution, rays, settings, {}, std::atomic<bool>{false});
  settings.average_zones = false;
  settings.seed = kReferenceSeed;
  settings.reach = kReferenceReach;
  settings.gather_rays = kReferenceGatherRays / (options.quick ? 4 : 1);
  settings.light_samples = kReferenceLightSamples / (options.quick ? 4 : 1);
  const int points = settings.points_per_replicate();
  const VertexGatherer gatherer(room.scene, solution, rays, rings, settings, points);
  tbb::task_arena arena(options.threads);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, vertices.chosen.size(), [&](std::size_t i) {
      std::vector<float> means(gatherer.values_per_vertex(), 0.0F);
      const std::size_t v = vertices.chosen[i];
      gatherer.gather(v, v + 1, {0, points}, means.data(), data);
    });
  });
  const std::size_t bands = room.scene.bands.count();
  return {bands, chosen_values(data.radiance, vertices, bands),
          chosen_values(data.radiance_stderr, vertices, bands)};
}

class VertexCurves {
 public:
  VertexCurves(const Room& room, const Options& options, const ReferenceCache& cache, Table& table)
      : room_(room), options_(options), table_(table), mesh_(build_mesh(room.scene, mesh_settings(room))) {
    SolverSettings settings;
    settings.threads = options.threads;
    settings.seed = kReferenceSeed;
    settings.packets = kReferencePackets / (options.quick ? 4 : 1);
    const Solution solution = solve(room.scene, mesh_, settings, {}, never_);
    const RayScene rays(solution.mesh);
    const VertexRings rings(room.scene, solution, false);
    vertices_.count = rings.size();
    for (std::size_t v = 0; v < rings.size(); v += static_cast<std::size_t>(room.vertex_stride)) {
      vertices_.chosen.push_back(v);
      norm_.weight.push_back(rings.area(v));
    }
    const std::string name = fmt::format("vertices-{}-{}-{}-{}", content_hash(room.scene), rings.size(),
                                         vertices_.chosen.size(), settings.packets);
    reference_ =
        cache.get(name, [&] { return gather_reference(room, solution, rays, rings, vertices_, options); });
    emitted_ = emitted_radiance(rings, solution);
    for (std::size_t k = 0; k < emitted_.size(); ++k) reference_.value[k] -= emitted_[k];
    reference_error_ = own_error(reference_, norm_);
    table.notes.push_back(fmt::format(
        "{}, vertices: {} vertices of {} zones, {} of them compared; reference: {} gather rays and {} shadow "
        "rays per vertex, {:.2g} % rms",
        room.name, rings.size(), mesh_.mesh.zone_count(), vertices_.chosen.size(),
        kReferenceGatherRays / (options.quick ? 4 : 1), kReferenceLightSamples / (options.quick ? 4 : 1),
        100 * reference_error_.rms));
  }

  void run(int seed, std::size_t level) {
    const bool leave_out = options_.quick;
    if (level + (leave_out ? 1 : 0) < kAveragePackets.size())
      measure("zones averaged", seed, level, {kAveragePackets[level], 0, 0});
    if (level + (leave_out ? 1 : 0) < kGatherEfforts.size())
      measure("gathered", seed, level, kGatherEfforts[level]);
  }

 private:
  static MeshSettings mesh_settings(const Room& room) {
    MeshSettings settings;
    settings.zone_area = room.vertex_zone_area;
    return settings;
  }

  std::vector<float> emitted_radiance(const VertexRings& rings, const Solution& solution) const {
    std::vector<float> emitted;
    for (const std::size_t v : vertices_.chosen)
      for (std::size_t b = 0; b < room_.scene.bands.count(); ++b)
        emitted.push_back(
            static_cast<float>(solution.emitted_radiosity(rings.begin(v)->zone, b) / std::numbers::pi));
    return emitted;
  }

  void measure(const std::string& method, int seed, std::size_t level, const Effort& effort) {
    SolverSettings solver;
    solver.threads = options_.threads;
    solver.seed = static_cast<std::uint64_t>(seed);
    solver.packets = effort.packets;
    VertexSettings vertices;
    vertices.threads = options_.threads;
    vertices.seed = solver.seed;
    vertices.average_zones = effort.gather_rays == 0;
    if (!vertices.average_zones) {
      vertices.gather_rays = effort.gather_rays;
      vertices.light_samples = effort.light_samples;
    }
    MeshResult own_mesh = mesh_;
    VertexData data;
    double rays_traced = 0;
    const double seconds = seconds_of([&] {
      const Solution solution = solve(room_.scene, std::move(own_mesh), solver, {}, never_);
      const RayScene rays(solution.mesh);
      data = gather_vertices(room_.scene, solution, rays, vertices, {}, never_);
      rays_traced = static_cast<double>(solution.record.rays);
    });
    if (data.vertex_count() != vertices_.count) {
      fmt::print(stderr, "{}, {}: left out, packets have not lit the same surfaces as in the reference\n",
                 room_.name, method);
      return;
    }
    rays_traced += static_cast<double>(data.vertex_count()) * (effort.gather_rays + effort.light_samples);
    std::vector<float> values = chosen_values(data.radiance, vertices_, room_.scene.bands.count());
    for (std::size_t k = 0; k < values.size(); ++k) values[k] -= emitted_[k];
    report({room_.name, "vertices", method, solver.seed, static_cast<int>(level), seconds, rays_traced,
            "rays", deviation(values, reference_, norm_), reference_error_},
           table_);
  }

  const std::atomic<bool> never_{false};
  const Room& room_;
  const Options& options_;
  Table& table_;
  MeshResult mesh_;
  VertexChoice vertices_;
  ErrorNorm norm_;
  Reference reference_;
  std::vector<float> emitted_;  // self-emitted radiance of the chosen vertices [W/(m2 sr)]
  ErrorPair reference_error_;
};

}  // namespace

void measure_vertices(const Room& room, const Options& options, const ReferenceCache& cache, Table& table) {
  VertexCurves curves(room, options, cache, table);
  for (int seed = 1; seed <= options.seeds; ++seed)
    for (std::size_t level = 0; level < std::max(kAveragePackets.size(), kGatherEfforts.size()); ++level)
      curves.run(seed, level);
}

}  // namespace reemit::bench

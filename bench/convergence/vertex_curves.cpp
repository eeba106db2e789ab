// Error over time of vertex values, solve included: zones around a vertex averaged, against gathering there.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "bench/convergence/jobs.h"
#include "mesh/build_mesh.h"
#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "viewer_export/vertex/vertex_gatherer.h"
#include "viewer_export/vertex/vertex_radiance.h"

namespace reemit::bench {
namespace {

/// One command line of a user: solve, then export.
struct VertexEffort {
  std::uint64_t packets;
  int gather_rays;
  int light_samples;
  bool smooth = false;
};

/// Packets that the zones need when their mean is all there is.
constexpr std::array<std::uint64_t, 4> kAveragePackets{1U << 18, 1U << 20, 1U << 22, 1U << 24};
/// A gather averages the zones' noise: few packets do, and the rays of the gather decide.
constexpr std::array<VertexEffort, 4> kVertexEfforts{
    {{1U << 18, 16, 16}, {1U << 19, 64, 32}, {1U << 20, 192, 64}, {1U << 21, 512, 128}}};

/// The reference: more of everything, nearer to the vertex.
constexpr std::uint64_t kReferencePackets = 1U << 23;
constexpr int kReferenceGatherRays = 16384;
constexpr int kReferenceLightSamples = 4096;
constexpr double kReferenceReach = 0.02;

/// Where the light of a vertex is that of the reference: vertices are split between sides and surfaces, so
/// the place alone does not tell.
using VertexKey = std::array<double, 7>;

VertexKey key_of(const Vec3& position, const Vec3& normal, SurfaceId surface) {
  const auto rounded = [](double x) { return std::round(x * 1e6); };
  return {position.x(),
          position.y(),
          position.z(),
          rounded(normal.x()),
          rounded(normal.y()),
          rounded(normal.z()),
          static_cast<double>(surface.index())};
}

/// Long gather at the chosen vertices.
Reference gather_reference(const StudiedRoom& room, const Solution& solution, const Room& walls,
                           const VertexRings& rings, const std::vector<std::size_t>& chosen,
                           const Options& options) {
  VertexSettings settings;
  settings.seed = kReferenceSeed;
  settings.reach = kReferenceReach;
  settings.gather_rays = kReferenceGatherRays / (options.quick ? 4 : 1);
  settings.light_samples = kReferenceLightSamples / (options.quick ? 4 : 1);
  const int points = settings.points_per_replicate();
  const std::atomic<bool> never{false};
  const VertexGatherer gatherer(walls, solution, rings, settings, points, StopToken(never));
  const std::size_t bands = room.scene.bands.count();
  VertexData data;
  for (auto* values : {&data.radiance, &data.irradiance, &data.radiance_stderr, &data.direct_radiance})
    values->assign(rings.size() * bands, 0.0F);
  tbb::task_arena arena(options.threads);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, chosen.size(), [&](std::size_t i) {
      std::vector<float> means(gatherer.values_per_vertex(), 0.0F);
      gatherer.gather(chosen[i], chosen[i] + 1, {0, points}, means.data(), data);
    });
  });
  Reference reference{bands, {}, {}};
  for (const std::size_t v : chosen)
    for (std::size_t k = v * bands; k < (v + 1) * bands; ++k) {
      reference.value.push_back(data.radiance[k]);
      reference.stderr_of_value.push_back(data.radiance_stderr[k]);
    }
  return reference;
}

class VertexCurves {
 public:
  VertexCurves(const StudiedRoom& room, const Options& options, const ReferenceCache& cache, Table& table)
      : room_(room),
        options_(options),
        cache_(cache),
        table_(table),
        mesh_(build_mesh(room.scene, mesh_settings(room))) {
    choose_vertices();
    reference_error_ = own_error(reference_, norm_);
    table.notes.push_back(fmt::format(
        "{}, vertices: {} vertices of {} zones, {} of them compared; reference: {} gather rays and {} shadow "
        "rays per vertex, {:.2g} % rms",
        room.name, vertex_count_, mesh_.mesh.zone_count(), keys_.size(),
        kReferenceGatherRays / (options.quick ? 4 : 1), kReferenceLightSamples / (options.quick ? 4 : 1),
        100 * reference_error_.rms));
  }

  void run(int seed, std::size_t level) {
    const bool leave_out = options_.quick;
    if (level + (leave_out ? 1 : 0) < kAveragePackets.size())
      measure("zones averaged", seed, level, {kAveragePackets[level], 0, 0});
    if (level + (leave_out ? 1 : 0) >= kVertexEfforts.size()) return;
    VertexEffort effort = kVertexEfforts[level];
    measure("gathered", seed, level, effort);
    effort.smooth = true;
    measure("gathered and smoothed", seed, level, effort);
  }

 private:
  static MeshSettings mesh_settings(const StudiedRoom& room) {
    MeshSettings settings;
    settings.zone_area = room.vertex_zone_area;
    return settings;
  }

  void choose_vertices() {
    // A short solve tells which backs are lit.
    SolverSettings settings;
    settings.threads = options_.threads;
    settings.seed = kReferenceSeed;
    settings.packets = 1U << 17;
    Solution solution = solve(room_.scene, mesh_, settings, {}, never_);
    const Room walls(room_.scene, solution.mesh);
    const VertexRings rings(walls.surfaces(), solution, false);
    vertex_count_ = rings.size();
    std::vector<VertexKey> keys;
    std::map<VertexKey, int> uses;
    for (std::size_t v = 0; v < rings.size(); ++v) {
      keys.push_back(
          key_of(rings.positions()[v], rings.normals()[v], mesh_.mesh.zone_surface(rings.begin(v)->zone)));
      ++uses[keys.back()];
    }
    std::vector<std::size_t> chosen;
    for (std::size_t v = 0; v < rings.size(); v += static_cast<std::size_t>(room_.vertex_stride)) {
      // Along the foot of a thing the floor has a vertex on either side, one of them dark.
      if (uses[keys[v]] > 1) continue;
      const ZoneId zone = rings.begin(v)->zone;
      chosen.push_back(v);
      norm_.weight.push_back(rings.area(v));
      keys_.push_back(keys[v]);
      for (std::size_t b = 0; b < room_.scene.bands.count(); ++b)
        emitted_.push_back(static_cast<float>(solution.emitted_radiosity(zone, b) / std::numbers::pi));
    }
    settings.packets = kReferencePackets / (options_.quick ? 4 : 1);
    const std::string name = fmt::format("vertices-{}-{}-{}-{}", content_hash(room_.scene), rings.size(),
                                         chosen.size(), settings.packets);
    reference_ = cache_.get(name, [&] {
      const Solution longer = solve(room_.scene, mesh_, settings, {}, never_);
      return gather_reference(room_, longer, walls, rings, chosen, options_);
    });
    for (std::size_t k = 0; k < emitted_.size(); ++k) reference_.value[k] -= emitted_[k];
  }

  /// Reflected radiance at the chosen vertices. One that was not exported, because packets have met no zone
  /// of its side, is dark.
  std::vector<float> chosen_values(const VertexData& data) const {
    std::map<VertexKey, std::size_t> index;
    for (std::size_t v = 0; v < data.vertex_count(); ++v)
      index.emplace(key_of(data.positions[v], data.normals[v], data.surfaces[v]), v);
    const std::size_t bands = data.bands.count();
    std::vector<float> values(keys_.size() * bands, 0.0F);
    for (std::size_t i = 0; i < keys_.size(); ++i) {
      const auto found = index.find(keys_[i]);
      if (found == index.end()) continue;
      for (std::size_t b = 0; b < bands; ++b)
        values[i * bands + b] = data.radiance[found->second * bands + b] - emitted_[i * bands + b];
    }
    return values;
  }

  void measure(const std::string& method, int seed, std::size_t level, const VertexEffort& effort) {
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
      vertices.smooth = effort.smooth;
    }
    MeshResult own_mesh = mesh_;
    VertexData data;
    double rays_traced = 0;
    const double seconds = seconds_of([&] {
      const Solution solution = solve(room_.scene, std::move(own_mesh), solver, {}, never_);
      const Room walls(room_.scene, solution.mesh);
      data = gather_vertices(walls, solution, vertices, {}, never_);
      rays_traced = static_cast<double>(solution.record.rays);
    });
    rays_traced += static_cast<double>(data.vertex_count()) * (effort.gather_rays + effort.light_samples);
    report({room_.name, "vertices", method, solver.seed, static_cast<int>(level), seconds, rays_traced,
            "rays", deviation(chosen_values(data), reference_, norm_), reference_error_},
           table_);
  }

  const std::atomic<bool> never_{false};
  const StudiedRoom& room_;
  const Options& options_;
  const ReferenceCache& cache_;
  Table& table_;
  MeshResult mesh_;
  std::size_t vertex_count_ = 0;
  std::vector<VertexKey> keys_;  // of the vertices that are compared
  ErrorNorm norm_;
  Reference reference_;
  std::vector<float> emitted_;  // self-emitted radiance of the chosen vertices [W/(m2 sr)]
  ErrorPair reference_error_;
};

}  // namespace

void measure_vertices(const StudiedRoom& room, const Options& options, const ReferenceCache& cache,
                      Table& table) {
  VertexCurves curves(room, options, cache, table);
  for (int seed = 1; seed <= options.seeds; ++seed)
    for (std::size_t level = 0; level < std::max(kAveragePackets.size(), kVertexEfforts.size()); ++level)
      curves.run(seed, level);
}

}  // namespace reemit::bench

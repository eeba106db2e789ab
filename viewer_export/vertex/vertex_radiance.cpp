#include "viewer_export/vertex/vertex_radiance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>
#include <numbers>
#include <string>
#include <vector>

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "scenes/model/error.h"
#include "solver/gather/direct_light.h"
#include "solver/gather/hemisphere_gather.h"
#include "solver/gather/point_sampler.h"
#include "solver/reflect/lambert.h"
#include "solver/tally/replicates.h"
#include "viewer_export/vertex/vertex_ring.h"

namespace reemit {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
/// Vertices of one task; fixed, so that packets of rays are the same for any number of threads.
constexpr std::size_t kChunk = 64;
/// Independent estimates of each vertex, each from its own part of the zone solution; their spread is the
/// standard error.
constexpr int kReplicates = static_cast<int>(ZoneSums::kGroups);

void check(const VertexSettings& s) {
  const auto require = [](bool good, const char* name, const char* range) {
    if (!good)
      throw InputError("vertices", std::string(name) + " is out of range", std::string("Choose ") + range);
  };
  require(s.gather_rays >= 1 && s.gather_rays <= 1 << 20, "number of gather rays", "1 to 1048576.");
  require(s.light_samples >= 1 && s.light_samples <= 1 << 16, "number of light samples", "1 to 65536.");
  require(s.reach > 0 && s.reach <= 1, "reach", "a share of the zone above 0 and up to 1.");
  require(s.close_hit >= 0 && std::isfinite(s.close_hit), "close-hit distance", "0 or more zone sizes.");
  require(s.threads >= 0, "number of threads", "0 (all cores) or more.");
}

/// Gathers light at vertices.
class VertexGatherer {
 public:
  VertexGatherer(const Scene& scene, const Solution& solution, const RayScene& rays, const VertexRings& rings,
                 const VertexSettings& settings)
      : rays_(rays),
        rings_(rings),
        settings_(settings),
        field_(scene, solution, rays, std::size_t{kReplicates}),
        direct_(scene, rays),
        gather_(rays, field_, direct_,
                GatherSettings{.close_hit = settings.close_hit, .seed = settings.seed}),
        bands_(scene.bands.count()) {
    const auto points = static_cast<unsigned>((settings.light_samples + kReplicates - 1) / kReplicates);
    points_ = static_cast<int>(std::bit_ceil(points));
    const int all_points = points_ * kReplicates;
    gathers_ = (settings.gather_rays + all_points - 1) / all_points;
  }
  VertexGatherer(const VertexGatherer&) = delete;
  VertexGatherer& operator=(const VertexGatherer&) = delete;

  const RadianceField& field() const { return field_; }

  /// Overwrites the values of vertices [first,last).
  void gather(std::size_t first, std::size_t last, VertexData& data) const {
    const auto replicates = std::size_t{kReplicates};
    // Per vertex and replicate: direct irradiance, then mean reflected radiance over the hemisphere.
    std::vector<float> sums((last - first) * replicates * 2 * bands_, 0.0F);
    GatherBatch batch(gather_);
    float* next = sums.data();
    for (std::size_t v = first; v < last; ++v)
      for (std::size_t r = 0; r < replicates; ++r, next += 2 * bands_)
        add_replicate(v, static_cast<int>(r), next, next + bands_, batch);
    batch.flush();
    for (std::size_t v = first; v < last; ++v) store(v, &sums[(v - first) * replicates * 2 * bands_], data);
  }

 private:
  void add_replicate(std::size_t v, int replicate, float* direct, float* indirect, GatherBatch& batch) const {
    const PointSampler sampler(settings_.seed, RngPurpose::kProbe, v, replicate,
                               std::countr_zero(static_cast<unsigned>(points_)));
    const auto part = static_cast<std::uint32_t>(replicate) % static_cast<std::uint32_t>(field_.parts());
    const std::vector<float> light_weight(bands_, 1.0F / static_cast<float>(points_));
    const std::vector<float> ray_weight(bands_, 1.0F / static_cast<float>(points_ * gathers_));
    for (int i = 0; i < points_; ++i) {
      const SurfacePoint x = point_beside(v, sampler.place(i));
      direct_.add_sample(x, sampler.light(i, 0, 1), light_weight.data(), direct);
      for (int j = 0; j < gathers_; ++j) {
        const std::array<float, 2> u = sampler.hemisphere(i, j, gathers_);
        const PathKey key{v, static_cast<std::uint32_t>(replicate),
                          static_cast<std::uint32_t>(i * gathers_ + j), part};
        batch.add(x, u[0], u[1], key, ray_weight.data(), indirect);
      }
    }
  }

  /// A point inside one of the zones around a vertex, zones in proportion to their areas, uniform in the copy
  /// of the zone that is shrunk towards the vertex by `reach`.
  SurfacePoint point_beside(std::size_t v, const std::array<float, 2>& u) const {
    const double total = 3 * rings_.area(v);
    double left = static_cast<double>(u[0]) * total;
    const RingZone* ring = rings_.begin(v);
    while (ring + 1 != rings_.end(v) && left >= ring->area) left -= (ring++)->area;
    const auto stretched = static_cast<float>(std::clamp(left / ring->area, 0.0, 1 - 0x1p-24));
    const auto [s, t] = sample_triangle(stretched, u[1]);
    const ZoneMesh& mesh = rays_.mesh();
    const auto corners = mesh.zone_barycentrics(ring->zone);
    const auto towards = [&](double Barycentric::*k) {
      const double inside = (1 - s - t) * corners[0].*k + s * corners[1].*k + t * corners[2].*k;
      return static_cast<float>(ring->vertex.*k + settings_.reach * (inside - ring->vertex.*k));
    };
    return surface_point(rays_, mesh.zone_triangle(ring->zone), towards(&Barycentric::u),
                         towards(&Barycentric::v), mesh.zone_is_front(ring->zone));
  }

  void store(std::size_t v, const float* sums, VertexData& data) const {
    const ZoneMesh& mesh = rays_.mesh();
    const ZoneId zone = rings_.begin(v)->zone;
    const float* emitted = field_.emitted(mesh.zone_triangle(zone).index(), mesh.zone_is_front(zone));
    const float* reflectance = field_.reflectance(mesh.zone_triangle(zone).index(), mesh.zone_is_front(zone));
    constexpr std::size_t n = kReplicates;
    for (std::size_t b = 0; b < bands_; ++b) {
      const auto value_of = [&](std::size_t r) {
        const float* replicate = sums + r * 2 * bands_;
        return static_cast<double>(replicate[b] + kPi * replicate[bands_ + b]);
      };
      const auto [mean, squared_error] = mean_of_replicates(n, field_.parts(), value_of);
      double direct = 0;
      for (std::size_t r = 0; r < n; ++r) direct += static_cast<double>(sums[r * 2 * bands_ + b]) / n;
      const double brdf = lambert_brdf_per_sr(reflectance[b]);
      const std::size_t k = v * bands_ + b;
      data.irradiance[k] = static_cast<float>(mean);
      data.radiance[k] = emitted[b] + static_cast<float>(brdf * mean);
      data.radiance_stderr[k] = static_cast<float>(brdf * std::sqrt(squared_error));
      data.direct_radiance[k] = static_cast<float>(brdf * direct);
    }
  }

  const RayScene& rays_;
  const VertexRings& rings_;
  const VertexSettings& settings_;
  RadianceField field_;
  DirectLight direct_;
  HemisphereGather gather_;
  std::size_t bands_;
  int points_ = 1;   // per replicate, each with one shadow ray
  int gathers_ = 1;  // per point
};

/// Vertex values as area-weighted means of the zones around. With two parts of the zone solution or more
/// their spread gives the error, which knows how the zones' errors go together; else zones count as
/// independent.
void average_zones(const Solution& solution, const VertexRings& rings, const RadianceField& field,
                   VertexData& data) {
  const ZoneMesh& mesh = solution.mesh;
  const std::size_t bands = data.bands.count();
  for (std::size_t v = 0; v < rings.size(); ++v)
    for (std::size_t b = 0; b < bands; ++b) {
      const double area = 3 * rings.area(v);
      double direct = 0;
      double all = 0;
      double variance = 0;
      for (const RingZone* r = rings.begin(v); r != rings.end(v); ++r) {
        const double share = r->area / area;
        const Estimate e = solution.irradiance(r->zone, b);
        direct += share * solution.direct_irradiance(r->zone, b).mean;
        all += share * e.mean;
        variance += share * share * e.stderr_of_mean * e.stderr_of_mean;
      }
      const ZoneId zone = rings.begin(v)->zone;
      const std::size_t t = mesh.zone_triangle(zone).index();
      const bool front = mesh.zone_is_front(zone);
      const double brdf = lambert_brdf_per_sr(field.reflectance(t, front)[b]);
      double error = brdf * std::sqrt(variance);
      if (field.parts() > 1) {
        const auto radiance_of = [&](std::size_t part) {
          double radiance = 0;
          for (const RingZone* r = rings.begin(v); r != rings.end(v); ++r)
            radiance += r->area / area * static_cast<double>(field.reflected(r->zone, part)[b]);
          return radiance;
        };
        error = std::sqrt(mean_of_replicates(field.parts(), field.parts(), radiance_of).squared_error);
      }
      const std::size_t k = v * bands + b;
      data.irradiance[k] = static_cast<float>(all);
      data.radiance[k] = field.emitted(t, front)[b] + static_cast<float>(brdf * all);
      data.radiance_stderr[k] = static_cast<float>(error);
      data.direct_radiance[k] = static_cast<float>(brdf * direct);
    }
}

/// sqrt(sum A s^2 / sum A L^2) over vertices, worst band.
double relative_error(const VertexRings& rings, const VertexData& data) {
  const std::size_t bands = data.bands.count();
  double worst = 0;
  for (std::size_t b = 0; b < bands; ++b) {
    double errors = 0;
    double values = 0;
    for (std::size_t v = 0; v < rings.size(); ++v) {
      const double area = rings.area(v);
      const double s = data.radiance_stderr[v * bands + b];
      const double l = data.radiance[v * bands + b];
      errors += area * s * s;
      values += area * l * l;
    }
    if (values > 0) worst = std::max(worst, std::sqrt(errors / values));
  }
  return worst;
}

VertexData make_vertices(const Scene& scene, const Solution& solution, const VertexRings& rings) {
  VertexData data;
  data.bands = scene.bands;
  for (const Surface& s : scene.surfaces) data.surface_names.push_back(s.name);
  for (const Material& m : scene.materials) data.material_names.push_back(m.name);
  data.positions = rings.positions();
  data.normals = rings.normals();
  data.triangles = rings.triangles();
  for (std::size_t v = 0; v < rings.size(); ++v) {
    const SurfaceId s = solution.mesh.zone_surface(rings.begin(v)->zone);
    data.surfaces.push_back(s);
    data.materials.push_back(scene.surfaces[s.index()].material);
  }
  for (auto* values : {&data.radiance, &data.irradiance, &data.radiance_stderr, &data.direct_radiance})
    values->assign(rings.size() * scene.bands.count(), 0.0F);
  return data;
}

void describe(const Scene& scene, const Solution& solution, const VertexSettings& settings,
              ExportInfo& info) {
  info.program_version = solution.program_version;
  info.room = scene.source.empty() ? scene.name : scene.source;
  info.room_hash = solution.room_hash;
  info.seed = solution.settings.seed;
  info.settings.emplace_back("vertex values", settings.average_zones ? "zone averages" : "final gather");
  if (settings.average_zones) return;
  info.settings.emplace_back("gather rays", std::to_string(settings.gather_rays));
  info.settings.emplace_back("light samples", std::to_string(settings.light_samples));
  info.settings.emplace_back("gather seed", std::to_string(settings.seed));
}

}  // namespace

VertexData gather_vertices(const Scene& scene, const Solution& solution, const RayScene& rays,
                           const VertexSettings& settings, const VertexProgressCallback& progress,
                           const std::atomic<bool>& interrupt) {
  check(settings);
  const VertexRings rings(scene, solution, settings.all_zones);
  const VertexGatherer gatherer(scene, solution, rays, rings, settings);
  VertexData data = make_vertices(scene, solution, rings);
  average_zones(solution, rings, gatherer.field(), data);
  if (!settings.average_zones) {
    const std::size_t chunks = (rings.size() + kChunk - 1) / kChunk;
    std::mutex progress_mutex;
    std::size_t done = 0;
    const int cores = tbb::info::default_concurrency();
    tbb::task_arena arena(settings.threads > 0 ? std::min(settings.threads, cores) : cores);
    arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
        if (interrupt) return;
        gatherer.gather(c * kChunk, std::min((c + 1) * kChunk, rings.size()), data);
        const std::lock_guard lock(progress_mutex);
        ++done;
        if (progress) progress(static_cast<double>(done) / static_cast<double>(chunks));
      });
    });
  }
  describe(scene, solution, settings, data.info);
  data.info.error = relative_error(rings, data);
  return data;
}

}  // namespace reemit

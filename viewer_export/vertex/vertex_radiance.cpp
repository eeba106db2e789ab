#include "viewer_export/vertex/vertex_radiance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "scenes/io/common/up_direction.h"
#include "scenes/model/error.h"
#include "solver/reflect/lambert.h"
#include "solver/solution/room_of_solution.h"
#include "solver/solution/thread_count.h"
#include "solver/tally/replicates.h"
#include "viewer_export/vertex/vertex_gatherer.h"
#include "viewer_export/vertex/vertex_refinement.h"
#include "viewer_export/vertex/vertex_ring.h"
#include "viewer_export/vertex/vertex_smoothing.h"

namespace reemit {
namespace {

void check(const VertexSettings& s) {
  const auto require = [](bool good, const char* name, const char* range) {
    if (!good)
      throw InputError("vertices", std::string(name) + " is out of range", std::string("Choose ") + range);
  };
  require(s.gather_rays >= 1 && s.gather_rays <= 1 << 20, "number of gather rays", "1 to 1048576.");
  require(s.light_samples >= 1 && s.light_samples <= 1 << 16, "number of light samples", "1 to 65536.");
  require(s.error_target >= 0 && s.error_target < 1, "error", "a share below 1, such as 1%.");
  if (s.average_zones && s.error_target > 0)
    throw InputError("vertices", "means of zones cannot be refined to an error",
                     "Leave out the error, or gather; a lower error of the solve makes better zones.");
  require(s.reach > 0 && s.reach <= 1, "reach", "a share of the zone above 0 and up to 1.");
  require(s.close_hit >= 0 && std::isfinite(s.close_hit), "close-hit distance", "0 or more zone sizes.");
  require(s.threads >= 0, "number of threads", "0 (all cores) or more.");
}

/// Exitance of a vertex by light that comes through from the other side [W/m2].
struct Through {
  double all = 0;
  double direct = 0;
  double caustic = 0;
  double variance = 0;  ///< Of `all`; zones count as independent.

  void add(const Solution& solution, ZoneId zone, std::size_t band, double share) {
    if (!(solution.zone_material(zone).diffuse_transmittance(band) > 0)) return;
    const Estimate e = solution.transmitted(zone, band, &Solution::irradiance);
    all += share * e.mean;
    direct += share * solution.transmitted(zone, band, &Solution::direct_irradiance).mean;
    caustic += share * solution.transmitted(zone, band, &Solution::caustic_irradiance).mean;
    variance += std::pow(share * e.stderr_of_mean, 2);
  }
};

/// Vertex values as area-weighted means of the zones around. With two parts of the zone solution or more
/// their spread gives the error, which knows how the zones' errors go together; else zones count as
/// independent.
void average_zones(const Solution& solution, const VertexRings& rings, const RadianceField& field,
                   VertexData& data) {
  const SurfaceModel& surfaces = field.room().surfaces();
  const std::size_t bands = data.bands.count();
  tbb::parallel_for(std::size_t{0}, rings.size(), [&](std::size_t v) {
    for (std::size_t b = 0; b < bands; ++b) {
      const double area = 3 * rings.area(v);
      double direct = 0;
      double caustic = 0;
      double all = 0;
      double variance = 0;
      Through through;
      for (const RingCell* r = rings.begin(v); r != rings.end(v); ++r) {
        const double share = r->area / area;
        const Estimate e = solution.irradiance(r->zone, b);
        direct += share * solution.direct_irradiance(r->zone, b).mean;
        caustic += share * solution.caustic_irradiance(r->zone, b).mean;
        all += share * e.mean;
        through.add(solution, r->zone, b, share);
        // Cells of one group share its value and its error.
        double same = 0;
        for (const RingCell* q = rings.begin(v); q != rings.end(v); ++q)
          if (q->zone == r->zone) same += q->area / area;
        variance += share * same * e.stderr_of_mean * e.stderr_of_mean;
      }
      SurfaceModel::PointValues here;
      const double brdf = lambert_brdf_per_sr(surfaces.reflectance(rings.point(v), here)[b]);
      const float own = surfaces.emitted(rings.point(v), here)[b];
      double error =
          std::hypot(brdf * std::sqrt(variance), std::sqrt(through.variance) * std::numbers::inv_pi);
      if (field.parts() > 1) {
        const auto radiance_of = [&](std::size_t part) {
          double radiance = 0;
          for (const RingCell* r = rings.begin(v); r != rings.end(v); ++r)
            radiance += r->area / area * static_cast<double>(field.reflected(r->zone, part)[b]);
          return radiance;
        };
        error = std::sqrt(mean_of_replicates(field.parts(), field.parts(), radiance_of).squared_error);
      }
      const std::size_t k = v * bands + b;
      data.irradiance[k] = static_cast<float>(all);
      data.radiance[k] = own + static_cast<float>(brdf * all + through.all * std::numbers::inv_pi);
      data.radiance_stderr[k] = static_cast<float>(error);
      data.direct_radiance[k] = static_cast<float>(brdf * direct + through.direct * std::numbers::inv_pi);
      if (!data.caustic_radiance.empty())
        data.caustic_radiance[k] =
            static_cast<float>(brdf * caustic + through.caustic * std::numbers::inv_pi);
    }
  });
}

VertexData make_vertices(const Scene& scene, const Solution& solution, const VertexRings& rings) {
  VertexData data;
  data.bands = scene.bands;
  data.up = up_direction(scene);
  if (scene.sky && scene.sky->kind != SkyKind::kNone)
    data.outside = horizontal_sky_irradiance(*scene.sky, scene.bands);
  for (const Surface& s : scene.surfaces) data.surface_names.push_back(s.name);
  for (const Material& m : scene.materials) data.material_names.push_back(m.name);
  data.positions = rings.positions();
  data.normals = rings.normals();
  data.triangles = rings.triangles();
  for (std::size_t v = 0; v < rings.size(); ++v) {
    const ZoneId zone = rings.begin(v)->zone;
    const SurfaceId s = solution.mesh.zone_surface(zone);
    data.surfaces.push_back(s);
    data.on_back.push_back(!solution.mesh.zone_is_front(zone));
    data.materials.push_back(scene.surfaces[s.index()].material);
  }
  for (auto* values : {&data.radiance, &data.irradiance, &data.radiance_stderr, &data.direct_radiance})
    values->assign(rings.size() * scene.bands.count(), 0.0F);
  if (scene.bends_light()) data.caustic_radiance.assign(data.radiance.size(), 0.0F);
  return data;
}

void describe(const Scene& scene, const Solution& solution, const VertexSettings& settings,
              VertexData& data) {
  ExportInfo& info = data.info;
  state_origin(scene, solution, info);
  if (scene.sky) info.settings.emplace_back("sky", scene.sky->description);
  info.settings.emplace_back("vertex values", data.gathered ? "final gather" : "zone averages");
  if (!data.gathered) return;
  if (data.smoothed) info.settings.emplace_back("smoothed", "over vertices that agree within their noise");
  info.settings.emplace_back("gather rays", static_cast<std::uint64_t>(settings.gather_rays));
  info.settings.emplace_back("light samples", static_cast<std::uint64_t>(settings.light_samples));
  info.settings.emplace_back("gather seed", settings.seed);
}

}  // namespace

int VertexSettings::points_per_replicate() const {
  return ReplicateEffort::of(gather_rays, light_samples, VertexGatherer::kReplicates).points;
}

int VertexSettings::gathers_per_point() const {
  return ReplicateEffort::of(gather_rays, light_samples, VertexGatherer::kReplicates).gathers;
}

VertexData gather_vertices(const Room& room, const Solution& solution, const VertexSettings& settings,
                           const VertexProgressCallback& progress, const std::atomic<bool>& interrupt) {
  check(settings);
  const Scene& scene = room.scene();
  check_is_room_of(solution, scene, room.mesh());
  tbb::task_arena arena(thread_count(settings.threads));
  const VertexRings rings = arena.execute(
      [&] { return VertexRings(room.surfaces(), solution, settings.all_zones, settings.only); });
  VertexData data = make_vertices(scene, solution, rings);
  arena.execute([&] {
    const VertexGatherer gatherer(room, solution, rings, settings, VertexRefinement::most_points(settings),
                                  StopToken(interrupt));
    average_zones(solution, rings, gatherer.field(), data);
    if (settings.average_zones) {
      if (const auto difference = solution.record.discretisation)
        data.info.zones = ZoneBias{*difference, *difference};
    } else {
      const double error_of_zones = relative_error(gatherer, rings, data);
      VertexRefinement refinement(gatherer, rings, settings, progress, interrupt, data);
      refinement.run();
      // A first pass towards a target has few samples for each vertex.
      data.gathered =
          !interrupt || settings.error_target == 0 || relative_error(gatherer, rings, data) <= error_of_zones;
      if (!data.gathered)
        average_zones(solution, rings, gatherer.field(), data);
      else if (settings.smooth)
        smooth_vertices(gatherer, rings, refinement.layers(), StopToken(interrupt), data);
      if (!interrupt)
        data.info.zones = gatherer.zone_bias(data, static_cast<double>(rings.size()) * settings.gather_rays);
    }
    data.info.error = relative_error(gatherer, rings, data);
    data.worst = worst_surface(gatherer, rings, data);
  });
  describe(scene, solution, settings, data);
  return data;
}

}  // namespace reemit

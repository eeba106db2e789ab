#include "solver/zoning/build_zones.h"

#include <algorithm>
#include <utility>

#include "mesh/zones/zone_plan.h"
#include "mesh/zones/zone_sizing.h"
#include "solver/reflect/surface_model.h"
#include "solver/zoning/sealed_sides.h"

namespace reemit {
namespace {

/// Sides of luminaires up to which they share no zones: packets leave zones of one piece faster.
constexpr std::size_t kFewLuminaires = 2000;

std::vector<SideUse> uses_of_sides(const Scene& scene, const ZoneMesh& mesh, const WorkWatch& watch) {
  const std::vector<std::uint8_t> sealed = sealed_sides(scene, mesh, watch);
  const SurfaceModel surfaces(scene, mesh);
  const auto emits = [&](std::size_t s) { return surfaces.emits(TriangleId(s / 2), s % 2 == 0); };
  std::size_t luminaires = 0;
  for (std::size_t s = 0; s < sealed.size(); ++s) luminaires += emits(s) ? 1 : 0;
  std::vector<SideUse> uses(sealed.size(), SideUse::kShared);
  for (std::size_t s = 0; s < uses.size(); ++s) {
    if (sealed[s] != 0)
      uses[s] = SideUse::kSealed;
    else if (luminaires <= kFewLuminaires && emits(s))
      uses[s] = SideUse::kOwn;
  }
  return uses;
}

/// Of all sides that have zones and are not sealed [m2].
double open_area(const ZoneMesh& mesh, const std::vector<SideUse>& uses) {
  double area = 0;
  for (std::size_t s = 0; s < uses.size(); ++s) {
    const TriangleId t(s / 2);
    if (uses[s] != SideUse::kSealed && mesh.has_zones(t, s % 2 == 0)) area += mesh.triangle_area(t);
  }
  return area;
}

}  // namespace

MeshResult build_zones(const Scene& scene, const MeshSettings& settings, const WorkWatch& watch) {
  if (!settings.share_zones) return build_mesh(scene, settings, watch);
  constexpr double kMeshing = 0.6;  // of the work
  MeshResult result = build_mesh(scene, settings, watch.part(0, kMeshing));
  const std::vector<SideUse> uses = uses_of_sides(scene, result.mesh, watch.part(kMeshing, 1));
  const double area = open_area(result.mesh, uses);
  if (!(area > 0)) return result;  // there is no light
  const double zone_area = wanted_zone_area(settings, area);
  BaseMesh base = std::move(result.mesh).release_base();
  size_zones(base, zone_area);
  result.mesh = ZoneMesh(std::move(base));
  ZonePlan plan = plan_zones(result.mesh, uses, wanted_zone_count(settings, area), zone_area);
  base = std::move(result.mesh).release_base();
  if (plan.zone_area > zone_area) size_zones(base, plan.zone_area);
  result.mesh = ZoneMesh(std::move(base), std::move(plan.groups));
  return result;
}

}  // namespace reemit

#include "solver/zoning/build_zones.h"

#include <algorithm>
#include <utility>

#include "mesh/zones/zone_plan.h"
#include "mesh/zones/zone_sizing.h"
#include "solver/room/room.h"
#include "solver/zoning/light_on_sides.h"
#include "solver/zoning/sealed_sides.h"

namespace reemit {
namespace {

/// Sides of luminaires up to which they share no zones: packets leave zones of one piece faster.
constexpr std::size_t kFewLuminaires = 2000;
/// Zones whose area nobody asked for grow up to this many times for the sake of their number: a room of very
/// many surfaces has at least one for each side of each, and its walls must not become coarse for that.
constexpr double kMostLarger = 4;

std::vector<SideUse> uses_of_sides(const Room& room, const WorkWatch& watch) {
  const std::vector<std::uint8_t> sealed = sealed_sides(room, watch);
  const auto emits = [&](std::size_t s) {
    return room.surfaces().emits(triangle_of(SideId(s)), is_front(SideId(s)));
  };
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
    const SideId side(s);
    if (uses[s] != SideUse::kSealed && mesh.has_zones(side)) area += mesh.triangle_area(triangle_of(side));
  }
  return area;
}

/// Triangles of which no side with zones gets light. Those of round shapes keep their patches, whose zones
/// become vertices.
std::vector<bool> dark_triangles(const ZoneMesh& mesh, const std::vector<SideUse>& uses) {
  std::vector<bool> dark(mesh.triangle_count(), true);
  for (std::size_t s = 0; s < uses.size(); ++s) {
    const TriangleId t = triangle_of(SideId(s));
    if (mesh.triangle(t).is_curved() || (mesh.has_zones(SideId(s)) && uses[s] != SideUse::kSealed))
      dark[t.index()] = false;
  }
  return dark;
}

/// What shadow rays and others find out about the sides of a mesh.
struct Survey {
  std::vector<SideUse> uses;
  std::vector<SideLightness> light;
  double open_area = 0;  // [m2]
  double zone_area = 0;  // such that there are as many as wanted [m2]
};

Survey survey(const Scene& scene, const ZoneMesh& mesh, const MeshSettings& settings,
              const WorkWatch& watch) {
  constexpr double kSealing = 0.5;  // of the work
  const Room room(scene, mesh);
  Survey result;
  result.uses = uses_of_sides(room, watch.part(0, kSealing));
  result.open_area = open_area(mesh, result.uses);
  if (!(result.open_area > 0)) return result;
  result.zone_area = wanted_zone_area(settings, result.open_area);
  result.light = light_on_sides(room, result.uses, result.zone_area, watch.part(kSealing, 1));
  return result;
}

}  // namespace

MeshResult build_zones(const Scene& scene, const MeshSettings& settings, const WorkWatch& watch) {
  if (!settings.share_zones) return build_mesh(scene, settings, watch);
  constexpr double kMeshing = 0.5;  // of the work
  MeshResult result = build_mesh(scene, settings, watch.part(0, kMeshing));
  const Survey found = survey(scene, result.mesh, settings, watch.part(kMeshing, 1));
  if (!(found.open_area > 0)) return result;  // there is no light
  std::vector<float> spread(found.light.size());
  for (std::size_t s = 0; s < spread.size(); ++s) spread[s] = found.light[s].spread;
  const std::vector<bool> dark = dark_triangles(result.mesh, found.uses);
  BaseMesh base = std::move(result.mesh).release_base();
  size_zones(base, found.zone_area, spread, dark);
  result.mesh = ZoneMesh(std::move(base));
  const double largest = settings.zone_area ? found.zone_area : kMostLarger * found.zone_area;
  ZonePlan plan = plan_zones(result.mesh, found.uses, found.light,
                             wanted_zone_count(settings, found.open_area), found.zone_area, largest);
  base = std::move(result.mesh).release_base();
  if (plan.zone_area > found.zone_area) size_zones(base, plan.zone_area, spread, dark);
  result.mesh = ZoneMesh(std::move(base), std::move(plan.groups));
  return result;
}

}  // namespace reemit

#include "solver/zoning/build_zones.h"

#include <algorithm>
#include <utility>

#include "mesh/zones/zone_plan.h"
#include "mesh/zones/zone_sizing.h"
#include "solver/room/room.h"
#include "solver/texture/zone_means.h"
#include "solver/zoning/light_on_sides.h"
#include "solver/zoning/pilot_light.h"
#include "solver/zoning/refine_cells.h"
#include "solver/zoning/sealed_sides.h"

namespace reemit {
namespace {

/// Sides of luminaires up to which they share no zones: packets leave zones of one piece faster.
constexpr std::size_t kFewLuminaires = 2000;
/// Zones whose area nobody asked for grow up to this many times for the sake of their number: a room of very
/// many surfaces has at least one for each side of each, and its walls must not become coarse for that.
constexpr double kMostLarger = 4;
/// Where light is even, cells are this many times as large as zones on average: what looks even from a few
/// points may not be.
constexpr double kCoarsest = 4;
/// Share of the room's area from which on a cell is looked at where exports have their vertices: smaller ones
/// are too small for a wrong vertex to be seen, and so very many zones cost no such looks.
constexpr double kSmallestRim = 1.0 / 16384;

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

/// A room without light that anything could be told from.
bool has_no_light(const Scene& scene) {
  return scene.lights.empty() && !scene.sky &&
         std::none_of(scene.materials.begin(), scene.materials.end(),
                      [](const Material& m) { return m.emits(); });
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

/// Sides that have cells of their own when these groups are made.
std::vector<SideId> sides_with_cells(const ZoneMesh& mesh, const ZoneGroups& groups) {
  std::vector<SideId> sides;
  for (std::size_t s = 0; s < mesh.side_count(); ++s)
    if (mesh.has_zones(SideId(s)) && (groups.of_side.empty() || groups.of_side[s] == ZoneGroups::kOwn))
      sides.emplace_back(s);
  return sides;
}

/// The mesh with cells for zones of `zone_area` [m2].
ZoneMesh with_cells(BaseMesh base, double zone_area, const std::vector<bool>& dark, ZoneGroups groups = {}) {
  size_zones(base, zone_area, dark);
  return ZoneMesh(std::move(base), std::move(groups));
}

/// build_zones, but for what is there of cut-outs.
MeshResult zones_of_whole_faces(const Scene& scene, const MeshSettings& settings, const WorkWatch& watch) {
  if (!settings.share_zones) return build_mesh(scene, settings, watch);
  // Shares of the work.
  constexpr double kMeshed = 0.4;
  constexpr double kSealed = 0.6;
  constexpr double kSolved = 0.75;
  constexpr double kGrouped = 0.9;
  MeshResult result = build_mesh(scene, settings, watch.part(0, kMeshed));
  const bool no_light = has_no_light(scene);
  // Without light no side is reached by any, but which would be is not known before there is some.
  const std::vector<SideUse> uses =
      no_light
          ? std::vector<SideUse>(result.mesh.side_count(), SideUse::kShared)
          : uses_of_sides(Room(scene, result.mesh, TextureMeans::kLeftOut), watch.part(kMeshed, kSealed));
  const double area = open_area(result.mesh, uses);
  if (!(area > 0)) return result;  // light that reaches nothing
  const double zone_area = wanted_zone_area(settings, area);
  const double wanted = wanted_zone_count(settings, area);
  const std::vector<bool> dark = dark_triangles(result.mesh, uses);
  const double largest = settings.zone_area ? zone_area : kMostLarger * zone_area;
  result.mesh = with_cells(std::move(result.mesh).release_base(), zone_area, dark);
  ZonePlan plan = plan_zones(result.mesh, uses, {}, wanted, zone_area, largest);
  if (no_light) {
    result.mesh =
        with_cells(std::move(result.mesh).release_base(), plan.zone_area, dark, std::move(plan.groups));
    return result;
  }
  const PilotLight pilot(
      scene, {with_cells(result.mesh.base(), plan.zone_area, dark, std::move(plan.groups)), result.report},
      watch.part(kSealed, kSolved));
  const std::vector<float> light = light_on_sides(pilot, uses, watch.part(kSolved, kGrouped));
  plan = plan_zones(result.mesh, uses, light, wanted, zone_area, largest);
  const std::vector<SideId> sides = sides_with_cells(result.mesh, plan.groups);
  const double cells = wanted - (plan.groups.count - plan.groups.sealed);
  const double root_area = std::min(kCoarsest * plan.zone_area, largest);
  BaseMesh base = std::move(result.mesh).release_base();
  size_zones(base, root_area, dark);
  CellSplits splits = refine_cells(pilot, base, sides, {cells, {plan.zone_area, kSmallestRim * area}},
                                   watch.part(kGrouped, 1));
  result.mesh = ZoneMesh(std::move(base), std::move(plan.groups), std::move(splits));
  return result;
}

}  // namespace

MeshResult build_zones(const Scene& scene, const MeshSettings& settings, const WorkWatch& watch) {
  MeshResult result = zones_of_whole_faces(scene, settings, watch);
  measure_cut_outs(scene, result.mesh);
  return result;
}

}  // namespace reemit

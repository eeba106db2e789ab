#include "bench/validation/matrix_rows.h"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "bench/validation/code_room.h"
#include "bench/validation/merged_zones.h"

namespace reemit::validation {
namespace {

using nlohmann::json;
/// Factors are exact to 1e-12; elimination loses some digits at high reflectance.
constexpr double kExactBound = 1e-9;
constexpr double kRoundBound = 3e-5;
constexpr int kSides = 512;

/// A room and its factors, kept for all reflectances.
struct Geometry {
  CodeRoom room;
  std::unique_ptr<MergedZones> zones;
};

Geometry with_factors(CodeRoom room, MergedZones::Merge merge, const std::string& name) {
  Geometry g{std::move(room), nullptr};
  g.zones = std::make_unique<MergedZones>(g.room, merge, seed_of(name));
  return g;
}

CodeRoom box(const Vec3& size, int n) {
  CodeRoom room;
  const MaterialId any = room.paint(0.5);
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const bool high = face % 2 != 0;
    room.add(kBoxFaces[static_cast<std::size_t>(face)], any,
             axis_grid(axis, high ? size[axis] : 0, 0, size[axis == 0 ? 1 : 0], 0, size[axis == 2 ? 1 : 2],
                       !high, n, n));
  }
  return room;
}

/// Of cases with square zones; 0 for those whose eight surfaces are the zones.
int zones_per_metre(const ReferenceCase& c) {
  return c.parameters.value("zones_per_metre", 0);
}

Geometry make_geometry(const ReferenceCase& c, const std::string& key) {
  const json& p = c.parameters;
  using Merge = MergedZones::Merge;
  if (c.kind == "zone_box") return with_factors(box(to_vec3(p.at("dims")), 1), Merge::kPolygons, key);
  if (c.kind == "zone_cube_NxN") return with_factors(box({1, 1, 1}, p.at("N")), Merge::kPolygons, key);
  if (c.kind == "zone_cube_triangles") return with_factors(box({1, 1, 1}, 1), Merge::kTriangles, key);
  CodeRoom room;
  const MaterialId any = room.paint(0.5);
  if (c.kind == "zone_icosphere") {
    std::vector<Polygon> triangles = unit_icosphere(p.at("subdivision"));
    for (Polygon& t : triangles) t = flipped(t);
    room.add("lamp", any, triangles.front());
    room.add("rest", any, std::vector<Polygon>(triangles.begin() + 1, triangles.end()));
    return with_factors(std::move(room), Merge::kTriangles, key);
  }
  if (c.kind == "zone_cylinder") {
    const double r = p.at("r");
    const double h = p.at("h");
    room.add("base", any, cylinder_cap({0, 0, 0}, Vec3::UnitZ(), r, kSides));
    room.add("top", any, cylinder_cap({0, 0, h}, -Vec3::UnitZ(), r, kSides));
    room.add("lateral", any, cylinder_side({0, 0, 0}, {0, 0, h}, r, kSides, true));
    return with_factors(std::move(room), Merge::kSurfaces, key);
  }
  for (const auto& [name, polygons] : l_room(2, 2, 1, std::max(1, zones_per_metre(c))))
    room.add(name, any, polygons);
  const bool whole_surfaces = zones_per_metre(c) == 0;
  return with_factors(std::move(room), whole_surfaces ? Merge::kSurfaces : Merge::kPolygons, key);
}

/// What of the parameters decides the geometry.
std::string key_of(const ReferenceCase& c) {
  std::string key = c.kind;
  for (const char* name : {"dims", "N", "subdivision"})
    if (c.parameters.contains(name)) key.append(1, ' ').append(c.parameters.at(name).dump());
  if (c.kind == "lroom_zone") key.append(1, ' ').append(std::to_string(zones_per_metre(c)));
  return key;
}

/// Reflectance or exitance by surface; parameters hold a number for all, one per surface, or some by name.
Eigen::VectorXd by_surface(const CodeRoom& room, const json& p) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(room.scene().surfaces.size()));
  for (Eigen::Index s = 0; s < values.size(); ++s) {
    const auto k = static_cast<std::size_t>(s);
    values[s] = p.is_number()  ? p.get<double>()
                : p.is_array() ? p[k].get<double>()
                               : p.value(room.scene().surfaces[k].name, 0.0);
  }
  return values;
}

/// The zone whose corners are given.
std::size_t triangle_at(const CodeRoom& room, const json& corners) {
  const Vec3 middle = (to_vec3(corners[0]) + to_vec3(corners[1]) + to_vec3(corners[2])) / 3;
  const MeshResult mesh = room.exact_zones();
  for (std::size_t z = 0; z < mesh.mesh.zone_count(); ++z)
    if ((mesh.mesh.zone_centroid(ZoneId(z)) - middle).norm() < 1e-9) return z;
  throw std::out_of_range("no zone with the corners of a reference value");
}

void add_rows(const ReferenceCase& c, Geometry& g, std::vector<ValidationRow>& rows) {
  const json& p = c.parameters;
  json exitance = p.value("E", json::object());
  if (c.kind == "zone_icosphere") exitance = {{"lamp", 1.0}};
  if (c.kind == "zone_cube_triangles") exitance = {{"z0", 1.0}};
  const Eigen::VectorXd rho = by_surface(g.room, p.at("rho"));
  const Eigen::VectorXd emitted = by_surface(g.room, exitance);
  g.zones->solve(rho, emitted);
  const double bound = c.kind == "zone_cylinder" ? kRoundBound : kExactBound;
  for (const ReferenceValue& v : c.values) {
    if (c.kind == "zone_cube_triangles") {
      rows.push_back(make_row(c, v, g.zones->zone(triangle_at(g.room, p.at("vertices"))), bound));
      continue;
    }
    if (c.kind == "zone_icosphere") {
      rows.push_back(make_row(c, v,
                              v.quantity == "H_mean"         ? g.zones->room()
                              : v.quantity == "H_on_emitter" ? g.zones->zone(0)
                                                             : g.zones->zone(g.zones->brightest_zone()),
                              bound));
      continue;
    }
    // "H_x0", "B_x0", "H_mean on face z0", "H zone W1", "mean H of face W1 in the zonal solution"
    for (std::size_t s = 0; s < g.room.scene().surfaces.size(); ++s) {
      const std::string& name = g.room.scene().surfaces[s].name;
      const std::string& q = v.quantity;
      const bool own = q == "H_" + name || q == "B_" + name || q.ends_with("face " + name) ||
                       q == "H zone " + name || q.find("face " + name + " ") != std::string::npos;
      if (!own) continue;
      ZonalValue value = g.zones->surface(s);
      if (q[0] == 'B') {
        const auto k = static_cast<Eigen::Index>(s);
        value.mean = emitted[k] + rho[k] * value.mean;
        value.standard_error *= rho[k];
      }
      rows.push_back(make_row(c, v, value, bound));
    }
  }
}

}  // namespace

std::vector<ValidationRow> evaluate_matrix(const std::vector<ReferenceCase>& cases) {
  std::vector<ValidationRow> rows;
  std::map<std::string, Geometry> geometries;
  for (const ReferenceCase& c : cases) {
    const std::string key = key_of(c);
    auto at = geometries.find(key);
    if (at == geometries.end()) at = geometries.emplace(key, make_geometry(c, key)).first;
    add_rows(c, at->second, rows);
  }
  return rows;
}

}  // namespace reemit::validation

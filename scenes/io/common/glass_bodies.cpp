#include "scenes/io/common/glass_bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "scenes/io/common/surface_geometry.h"
#include "scenes/model/measures.h"

namespace reemit {
namespace {

using Triangle = std::array<Vec3, 3>;

/// A closed surface of glass: faces of one material that share corners, or a sphere.
struct GlassBody {
  GlassBody(MaterialId its_material, std::size_t its_surface)
      : material(its_material), surface(its_surface) {}

  MaterialId material;
  std::size_t surface;                                       ///< That it begins in.
  std::vector<std::pair<std::size_t, std::size_t>> members;  ///< Surface and face; of a sphere, the shape.
  std::vector<Triangle> triangles;                           ///< Wound as the faces; empty for a sphere.
  Sphere sphere;
  double volume = 0;  ///< [m3], negative where fronts look inwards.
  Vec3 low{0, 0, 0}, high{0, 0, 0};
  bool is_hollow = false;  ///< It bounds air within glass.

  bool is_sphere() const { return triangles.empty(); }

  /// Whether a point lies inside.
  bool holds(const Vec3& p) const {
    if (is_sphere()) return (p - sphere.centre).squaredNorm() < sphere.radius * sphere.radius;
    // The solid angle that a closed surface fills from a point inside is 4 pi, from one outside 0; that of a
    // triangle by its corners' directions.
    double angle = 0;
    for (const Triangle& t : triangles) {
      const Vec3 a = t[0] - p, b = t[1] - p, c = t[2] - p;
      const double la = a.norm(), lb = b.norm(), lc = c.norm();
      angle +=
          2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return std::fabs(angle) > 2 * std::numbers::pi;
  }
  /// Some points of its surface.
  std::vector<Vec3> places() const {
    constexpr std::size_t kMost = 64;
    std::vector<Vec3> points;
    if (is_sphere()) {
      for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0})
          points.push_back(sphere.centre + side * sphere.radius * Vec3::Unit(axis));
      return points;
    }
    const std::size_t step = (triangles.size() + kMost - 1) / kMost;
    for (std::size_t t = 0; t < triangles.size(); t += step)
      points.push_back((triangles[t][0] + triangles[t][1] + triangles[t][2]) / 3);
    return points;
  }
};

/// All surfaces of one material, as a net of corners that are the same where their coordinates are.
class GlassNet {
 public:
  void add(const Surface& surface, std::size_t number) {
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      const Face& face = surface.faces[f];
      Part part{0, number, f, {}};
      part.corner = add_loop(surface, face.outer, part.triangles);
      const Vec3 area = outline_area(surface.positions, face.outer);
      for (std::vector<std::uint32_t> hole : face.holes) {
        if (outline_area(surface.positions, hole).dot(area) > 0) std::reverse(hole.begin(), hole.end());
        join(part.corner, add_loop(surface, hole, part.triangles));
      }
      parts_.push_back(std::move(part));
    }
  }

  /// Those that are closed. `is_open` by surface number: set for surfaces with a face that is part of none.
  std::vector<GlassBody> closed_bodies(MaterialId material, std::vector<bool>& is_open) {
    std::map<std::pair<std::size_t, std::size_t>, int> sides;
    for (const Edge& e : edges_)
      sides[{std::min(e.from, e.to), std::max(e.from, e.to)}] += e.from < e.to ? 1 : -1;
    std::map<std::size_t, bool> open;
    for (const auto& [ends, balance] : sides)
      if (balance != 0) open[root(ends.first)] = true;
    std::map<std::size_t, std::size_t> body_of;
    std::vector<GlassBody> bodies;
    for (Part& part : parts_) {
      const std::size_t corner = root(part.corner);
      if (open.contains(corner)) {
        is_open[part.surface] = true;
        continue;
      }
      const auto [entry, added] = body_of.try_emplace(corner, bodies.size());
      if (added) bodies.emplace_back(material, part.surface);
      GlassBody& body = bodies[entry->second];
      body.members.emplace_back(part.surface, part.face);
      for (const Triangle& t : part.triangles) {
        if (body.triangles.empty()) body.low = body.high = t[0];
        for (const Vec3& p : t) {
          body.low = body.low.cwiseMin(p);
          body.high = body.high.cwiseMax(p);
        }
        body.triangles.push_back(t);
      }
    }
    for (GlassBody& body : bodies)
      for (const Triangle& t : body.triangles)
        body.volume += (t[0] - body.low).dot((t[1] - body.low).cross(t[2] - body.low)) / 6;
    return bodies;
  }

 private:
  struct Edge {
    std::size_t from, to;
  };
  struct Part {
    std::size_t corner, surface, face;
    std::vector<Triangle> triangles;
  };

  std::size_t corner_at(const Vec3& p) {
    const auto [entry, added] = corners_.try_emplace({p.x(), p.y(), p.z()}, parents_.size());
    if (added) parents_.push_back(parents_.size());
    return entry->second;
  }
  std::size_t root(std::size_t c) {
    while (parents_[c] != c) c = parents_[c] = parents_[parents_[c]];
    return c;
  }
  void join(std::size_t a, std::size_t b) { parents_[root(a)] = root(b); }

  std::size_t add_loop(const Surface& surface, const std::vector<std::uint32_t>& loop,
                       std::vector<Triangle>& triangles) {
    const std::size_t first = corner_at(surface.positions[loop[0]]);
    std::size_t last = first;
    for (std::size_t k = 1; k <= loop.size(); ++k) {
      const std::size_t corner = corner_at(surface.positions[loop[k % loop.size()]]);
      edges_.push_back({last, corner});
      join(last, corner);
      last = corner;
    }
    for (std::size_t k = 2; k < loop.size(); ++k)
      triangles.push_back(
          {surface.positions[loop[0]], surface.positions[loop[k - 1]], surface.positions[loop[k]]});
    return first;
  }

  std::map<std::array<double, 3>, std::size_t> corners_;
  std::vector<std::size_t> parents_;
  std::vector<Edge> edges_;
  std::vector<Part> parts_;
};

MaterialId pane_of(Scene& scene, MaterialId solid) {
  Material pane = scene.materials[solid.index()];
  pane.name += " (pane)";
  pane.non_diffuse.is_solid = false;
  pane.non_diffuse.absorption_per_m.resize(0);
  const MaterialId id(scene.materials.size());
  scene.materials.push_back(std::move(pane));
  return id;
}

GlassBody ball(const Surface& surface, std::size_t number, std::size_t shape) {
  GlassBody body(surface.material, number);
  body.members.emplace_back(number, shape);
  body.sphere = std::get<Sphere>(surface.shapes[shape]);
  const double volume = 4 * std::numbers::pi / 3 * std::pow(body.sphere.radius, 3);
  body.volume = body.sphere.inward ? -volume : volume;
  std::tie(body.low, body.high) = shape_bounds(surface.shapes[shape]);
  return body;
}

/// The bodies of a material; its surfaces that enclose none become panes.
std::vector<GlassBody> settle_material(Scene& scene, MaterialId material) {
  GlassNet net;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
    if (scene.surfaces[s].material == material) net.add(scene.surfaces[s], s);
  std::vector<bool> is_open(scene.surfaces.size(), false);
  std::vector<GlassBody> bodies = net.closed_bodies(material, is_open);
  MaterialId pane;
  std::size_t open = 0;
  std::string first;
  bool any_round = false;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    Surface& surface = scene.surfaces[s];
    if (surface.material != material) continue;
    for (std::size_t k = 0; k < surface.shapes.size(); ++k)
      if (std::holds_alternative<Sphere>(surface.shapes[k]))
        bodies.push_back(ball(surface, s, k));
      else
        any_round = is_open[s] = true;
    if (!is_open[s]) continue;
    if (!pane.valid()) pane = pane_of(scene, material);
    surface.material = pane;
    if (open++ == 0) first = surface.name;
  }
  if (open > 0)
    scene.warnings.push_back(
        fmt::format("material '{}' is solid glass, but {} surface(s) of it enclose no body, the first '{}': "
                    "they are taken as thin panes, which light crosses straight on.{}",
                    scene.materials[material.index()].name, open, first,
                    any_round ? " Of exact round shapes only spheres are bodies: give cylinders and cones "
                                "\"segments\"."
                              : ""));
  // What shares a surface with a pane has become one.
  std::erase_if(bodies, [&](const GlassBody& body) {
    return std::any_of(body.members.begin(), body.members.end(),
                       [&](const auto& m) { return is_open[m.first]; });
  });
  return bodies;
}

/// How a body lies to another.
enum class Location { kOutside, kInside, kAcross };

Location place_of(const GlassBody& body, const GlassBody& other) {
  std::size_t inside = 0;
  const std::vector<Vec3> places = body.places();
  for (const Vec3& p : places) inside += other.holds(p) ? 1 : 0;
  if (inside == 0) return Location::kOutside;
  return inside == places.size() ? Location::kInside : Location::kAcross;
}

/// Bodies within others: air where both are of one glass, and else nothing that can be told apart.
class NestedBodies {
 public:
  explicit NestedBodies(std::vector<GlassBody>& bodies) : bodies_(bodies), around_(bodies.size()) {
    // Along x; only bodies whose boxes overlap are looked at.
    std::vector<std::size_t> order(bodies.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return bodies[a].low.x() < bodies[b].low.x(); });
    std::vector<std::size_t> begun;
    for (const std::size_t i : order) {
      std::erase_if(begun, [&](std::size_t k) { return bodies[k].high.x() < bodies[i].low.x(); });
      for (const std::size_t k : begun) compare(i, k);
      begun.push_back(i);
    }
  }

  /// Tells which bodies bound air, and how many stand in other glass or reach into it.
  void settle(Scene& scene) {
    std::vector<std::size_t> order(bodies_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    // What is around a body is settled before it.
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return around_[a].size() != around_[b].size() ? around_[a].size() < around_[b].size() : a < b;
    });
    for (const std::size_t i : order) {
      if (around_[i].empty()) continue;
      const std::size_t next =
          *std::min_element(around_[i].begin(), around_[i].end(), [&](std::size_t a, std::size_t b) {
            return std::fabs(bodies_[a].volume) < std::fabs(bodies_[b].volume);
          });
      if (bodies_[next].is_hollow) continue;
      if (is_air_within(bodies_[next], bodies_[i], scene))
        bodies_[i].is_hollow = true;
      else
        mixed_.emplace_back(i, next);
    }
    if (mixed_.empty()) return;
    const auto& [inner, outer] = mixed_.front();
    const auto name = [&](std::size_t body) {
      const Surface& surface = scene.surfaces[bodies_[body].surface];
      return fmt::format("'{}' of '{}'", surface.name, scene.materials[surface.material.index()].name);
    };
    scene.not_modelled["glass_in_glass"] += mixed_.size();
    scene.warnings.push_back(fmt::format(
        "{} pair(s) of glass bodies stand within each other or overlap, the first {} and {}: light "
        "that goes from one into the other is bent as if there was air between. Let them end where "
        "they meet, with a gap.",
        mixed_.size(), name(inner), name(outer)));
  }

 private:
  static bool is_air_within(const GlassBody& outer, const GlassBody& inner, const Scene& scene) {
    const auto index = [&](const GlassBody& body) {
      return scene.materials[body.material.index()].non_diffuse.index_of_refraction;
    };
    return outer.material == inner.material || (inner.volume < 0 && index(outer) == index(inner));
  }
  void compare(std::size_t a, std::size_t b) {
    const GlassBody& x = bodies_[a];
    const GlassBody& y = bodies_[b];
    if ((x.low.array() > y.high.array()).any() || (y.low.array() > x.high.array()).any()) return;
    const bool x_is_smaller = std::fabs(x.volume) < std::fabs(y.volume);
    const std::size_t inner = x_is_smaller ? a : b;
    const std::size_t outer = x_is_smaller ? b : a;
    const Location place = place_of(bodies_[inner], bodies_[outer]);
    if (place == Location::kInside)
      around_[inner].push_back(outer);
    else if (place == Location::kAcross || place_of(bodies_[outer], bodies_[inner]) == Location::kAcross)
      mixed_.emplace_back(inner, outer);
  }

  std::vector<GlassBody>& bodies_;
  std::vector<std::vector<std::size_t>> around_;            // by body, those that it lies in
  std::vector<std::pair<std::size_t, std::size_t>> mixed_;  // bodies that light does not tell apart
};

/// Turns a face; its shading normals may be those of others as well.
void flip_face(Surface& surface, Face& face) {
  std::reverse(face.outer.begin(), face.outer.end());
  for (auto& hole : face.holes) std::reverse(hole.begin(), hole.end());
  std::reverse(face.normals.begin(), face.normals.end());
  for (std::uint32_t& n : face.normals) {
    surface.normals.emplace_back(-surface.normals[n]);
    n = static_cast<std::uint32_t>(surface.normals.size() - 1);
  }
}

/// Fronts look out of the glass: away from a body, into a hollow.
void turn_fronts_out(const GlassBody& body, Scene& scene) {
  if ((body.volume < 0) == body.is_hollow) return;
  for (const auto& [s, k] : body.members) {
    Surface& surface = scene.surfaces[s];
    if (body.is_sphere())
      surface.shapes[k] = flipped(surface.shapes[k]);
    else
      flip_face(surface, surface.faces[k]);
  }
}

}  // namespace

void settle_glass_bodies(Scene& scene) {
  std::vector<GlassBody> bodies;
  const std::size_t count = scene.materials.size();
  for (std::size_t m = 0; m < count; ++m) {
    if (!scene.materials[m].non_diffuse.is_solid) continue;
    std::vector<GlassBody> more = settle_material(scene, MaterialId(m));
    std::move(more.begin(), more.end(), std::back_inserter(bodies));
  }
  if (bodies.empty()) return;
  NestedBodies(bodies).settle(scene);
  for (const GlassBody& body : bodies) turn_fronts_out(body, scene);
}

}  // namespace reemit

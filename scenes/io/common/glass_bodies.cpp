#include "scenes/io/common/glass_bodies.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "scenes/io/common/surface_geometry.h"

namespace reemit {
namespace {

/// All surfaces of one material, as a net of corners that are the same where their coordinates are.
class GlassNet {
 public:
  void add(const Surface& surface, std::size_t number) {
    for (const Face& face : surface.faces) {
      std::size_t corner = add_loop(surface, face.outer, number);
      for (const auto& hole : face.holes) join(corner, add_loop(surface, hole, number));
    }
  }

  /// By surface number, whether the bodies that it belongs to are closed, and the volume that they enclose,
  /// negative where fronts look inwards.
  struct Body {
    bool closed = true;
    double volume = 0;
  };
  std::map<std::size_t, Body> bodies() {
    std::map<std::pair<std::size_t, std::size_t>, int> sides;
    for (const Edge& e : edges_) {
      const bool up = e.from < e.to;
      sides[{std::min(e.from, e.to), std::max(e.from, e.to)}] += up ? 1 : -1;
    }
    std::map<std::size_t, Body> of_root;
    for (const auto& [ends, balance] : sides)
      if (balance != 0) of_root[root(ends.first)].closed = false;
    for (const Part& part : parts_) of_root[root(part.corner)].volume += part.volume;
    std::map<std::size_t, Body> result;
    for (const Part& part : parts_) {
      const Body& body = of_root[root(part.corner)];
      Body& own = result[part.surface];
      own.closed = own.closed && body.closed;
      own.volume += body.volume;
    }
    return result;
  }

 private:
  struct Edge {
    std::size_t from, to;
  };
  struct Part {
    std::size_t corner, surface;
    double volume;
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

  std::size_t add_loop(const Surface& surface, const std::vector<std::uint32_t>& loop, std::size_t number) {
    std::size_t first = 0;
    std::size_t last = 0;
    double volume = 0;
    const Vec3& apex = surface.positions[loop[0]];
    for (std::size_t k = 0; k <= loop.size(); ++k) {
      const std::size_t corner = corner_at(surface.positions[loop[k % loop.size()]]);
      if (k == 0) {
        first = corner;
      } else {
        edges_.push_back({last, corner});
        join(last, corner);
      }
      last = corner;
      if (k >= 2 && k < loop.size())
        volume += apex.dot(surface.positions[loop[k - 1]].cross(surface.positions[loop[k]])) / 6;
    }
    parts_.push_back({first, number, volume});
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

bool is_closed_shape(const CurvedShape& shape) {
  return std::holds_alternative<Sphere>(shape);
}

void settle_material(Scene& scene, MaterialId material) {
  GlassNet net;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
    if (scene.surfaces[s].material == material) net.add(scene.surfaces[s], s);
  std::map<std::size_t, GlassNet::Body> bodies = net.bodies();
  MaterialId pane;
  std::size_t open = 0;
  std::string first;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    Surface& surface = scene.surfaces[s];
    if (surface.material != material) continue;
    const GlassNet::Body body = surface.faces.empty() ? GlassNet::Body{} : bodies[s];
    const bool closed =
        body.closed && std::all_of(surface.shapes.begin(), surface.shapes.end(), is_closed_shape);
    if (closed) {
      if (body.volume < 0) flip_surface(surface);
      continue;
    }
    if (!pane.valid()) pane = pane_of(scene, material);
    surface.material = pane;
    if (open++ == 0) first = surface.name;
  }
  if (open > 0)
    scene.warnings.push_back(
        fmt::format("material '{}' is solid glass, but {} surface(s) of it enclose no body, the first '{}': "
                    "they are taken "
                    "as thin panes, which light crosses straight on.",
                    scene.materials[material.index()].name, open, first));
}

}  // namespace

void settle_glass_bodies(Scene& scene) {
  const std::size_t count = scene.materials.size();
  for (std::size_t m = 0; m < count; ++m)
    if (scene.materials[m].non_diffuse.is_solid) settle_material(scene, MaterialId(m));
}

}  // namespace reemit

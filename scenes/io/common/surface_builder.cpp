#include "scenes/io/common/surface_builder.h"

#include <bit>
#include <map>
#include <utility>

namespace reemit {

SurfaceBuilder::SurfaceBuilder(std::string name, std::string source, MaterialId material) {
  surface_.name = std::move(name);
  surface_.source = std::move(source);
  surface_.material = material;
}

void SurfaceBuilder::add(const Polygon& polygon, std::uint32_t source_line) {
  Face face;
  face.source_line = source_line;
  for (const Vec3& p : polygon.outer) face.outer.push_back(index_of(p, surface_.positions, positions_));
  for (const Vec3& n : polygon.normals) face.normals.push_back(index_of(n, surface_.normals, normals_));
  for (const TexturePoint& p : polygon.texture_points) {
    const Key key{p.uv[0][0] + 0.0, p.uv[0][1] + 0.0,
                  0};  // formats that use this have one set and no colours
    const auto [entry, added] =
        texture_points_.try_emplace(key, static_cast<std::uint32_t>(surface_.texture_points.size()));
    if (added) surface_.texture_points.push_back(p);
    face.texture_points.push_back(entry->second);
  }
  for (const auto& hole : polygon.holes) {
    auto& loop = face.holes.emplace_back();
    for (const Vec3& p : hole) loop.push_back(index_of(p, surface_.positions, positions_));
  }
  surface_.faces.push_back(std::move(face));
}

std::uint32_t SurfaceBuilder::index_of(const Vec3& p, std::vector<Vec3>& points, Index& index) {
  // -0 and 0 are the same place; NaN never equals itself and so stays apart until it is refused later.
  const auto [entry, added] = index.try_emplace(Key{p.x() + 0.0, p.y() + 0.0, p.z() + 0.0},
                                                static_cast<std::uint32_t>(points.size()));
  if (added) points.push_back(p);
  return entry->second;
}

std::size_t SurfaceBuilder::KeyHash::operator()(const Key& key) const {
  std::uint64_t hash = 0x9e3779b97f4a7c15ULL;
  for (const double x : key) {
    hash ^= std::bit_cast<std::uint64_t>(x);
    hash *= 0xff51afd7ed558ccdULL;  // mixing constants of MurmurHash3's finaliser [MUR3]
    hash ^= hash >> 33;
  }
  return static_cast<std::size_t>(hash);
}

void tell_surfaces_apart(Scene& scene) {
  std::map<std::string, int> uses;
  for (const Surface& surface : scene.surfaces) ++uses[surface.name];
  for (Surface& surface : scene.surfaces) {
    const std::string& material = scene.material_of(surface).name;
    if (uses[surface.name] > 1 && surface.name != material) surface.name += " (" + material + ")";
  }
}

}  // namespace reemit

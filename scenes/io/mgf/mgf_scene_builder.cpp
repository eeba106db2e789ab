#include "scenes/io/mgf/mgf_scene_builder.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "scenes/io/common/kind_counts.h"
#include "scenes/io/common/text_parse.h"
#include "scenes/io/mgf/mgf_material.h"
#include "scenes/model/error.h"
#include "scenes/model/limits.h"

namespace reemit {
namespace {

Polygon transformed(const Polygon& polygon, const Eigen::Affine3d& transform) {
  Polygon placed;
  for (const Vec3& p : polygon.outer) placed.outer.push_back(transform * p);
  for (const Vec3& n : polygon.normals) placed.normals.push_back((transform.linear() * n).stableNormalized());
  for (const auto& hole : polygon.holes) {
    auto& loop = placed.holes.emplace_back();
    for (const Vec3& p : hole) loop.push_back(transform * p);
  }
  if (transform.linear().determinant() < 0) {
    std::reverse(placed.outer.begin(), placed.outer.end());
    std::reverse(placed.normals.begin(), placed.normals.end());
  }
  return placed;
}

void check_place(const Vec3& place, const MgfSceneBuilder::Target& target) {
  const std::string problem = place_problem(place);
  if (!problem.empty()) throw InputError(at_line(target.file, target.line), problem, kLengthAdvice);
}

}  // namespace

void MgfSceneBuilder::add(const std::vector<Polygon>& faces, const Eigen::Affine3d& transform,
                          const Target& target) {
  if (faces.empty()) {
    ++refused["faces"];
    warnings.push_back(fmt::format("{}: the face has less than three different corners and was left out.",
                                   at_line(target.file, target.line)));
    return;
  }
  count(faces.size(), target);
  SurfaceBuilder& surface = surfaces_[surface_index(target)];
  for (const Polygon& face : faces) {
    const Polygon placed = transformed(face, transform);
    for (const Vec3& corner : placed.outer) check_place(corner, target);
    surface.add(placed, target.line);
  }
}

void MgfSceneBuilder::add(const CurvedShape& shape, const Eigen::Affine3d& transform, const Target& target) {
  count(1, target);
  const CurvedShape placed = transformed(shape, transform);
  const auto [low, high] = shape_bounds(placed);
  for (const Vec3& end : {low, high}) check_place(end, target);
  surfaces_[surface_index(target)].add(placed);
}

void MgfSceneBuilder::count(std::size_t faces, const Target& target) {
  face_count_ += faces;
  if (face_count_ > kMostFaces)
    throw InputError(at_line(target.file, target.line),
                     fmt::format("the room has more than {} faces", kMostFaces),
                     "Check the counts of its arrays (-a), or split the room.");
}

std::size_t MgfSceneBuilder::surface_index(const Target& target) {
  const MaterialId material = material_id(target);
  const auto [entry, added] =
      surface_indices_.try_emplace({target.object, material, target.file}, surfaces_.size());
  if (added) {
    const std::string& name = target.object.empty() ? materials_[material.index()].name : target.object;
    surfaces_.emplace_back(name, target.file, material);
  }
  return entry->second;
}

MaterialId MgfSceneBuilder::material_id(const Target& target) {
  const auto [entry, added] =
      material_ids_.try_emplace({target.material_name, target.material}, MaterialId(materials_.size()));
  if (added) {
    const std::string base = target.material_name.empty() ? "unnamed" : target.material_name;
    const int version =
        ++material_names_[base];  // a context that was changed after use counts as a new material
    const std::string name = version == 1 ? base : fmt::format("{}#{}", base, version);
    materials_.push_back(
        convert_mgf_material(target.material, name, at_line(target.file, target.line), warnings));
  }
  return entry->second;
}

void MgfSceneBuilder::finish(Scene& scene) {
  for (SurfaceBuilder& builder : surfaces_) scene.surfaces.push_back(builder.take());
  scene.materials = std::move(materials_);
  tell_surfaces_apart(scene);
  add_counts(refused, scene.refused);
  scene.warnings.insert(scene.warnings.end(), warnings.begin(), warnings.end());
}

}  // namespace reemit

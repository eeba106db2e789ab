#include "scenes/io/common/up_direction.h"

#include <algorithm>
#include <string>
#include <variant>

#include "scenes/io/common/text_parse.h"
#include "scenes/model/measures.h"

namespace reemit {
namespace {

/// Part of the emission that leaves downwards if luminaires tell which way is up.
constexpr double kMostlyDown = 0.8;
/// Share of its length that the `up` of a camera has along an axis it names.
constexpr double kAlongAxis = 0.9;

/// Mean of the normals of emitting faces, weighted by power: of unit length if all look the same way.
Vec3 mean_emission_direction(const Scene& scene) {
  Vec3 sum(0, 0, 0);
  double total = 0;
  for (const Surface& surface : scene.surfaces) {
    const Material& material = scene.material_of(surface);
    if (!material.emits()) continue;
    for (const Face& face : surface.faces) {
      const Vec3 weighted = material.emitted_radiance.sum() * outline_area(surface.positions, face.outer);
      total += weighted.norm();
      if (!material.emits_both_sides) sum += weighted;
    }
    for (const CurvedShape& shape : surface.shapes) {  // all but disks emit to all sides alike
      const double power = material.emitted_radiance.sum() * shape_area(shape);
      total += power;
      const auto* disk = std::get_if<Disk>(&shape);
      if (disk != nullptr && !material.emits_both_sides) sum += power * disk->normal;
    }
  }
  return total > 0 ? Vec3(sum / total) : Vec3(0, 0, 0);
}

bool all_cameras_say(const Scene& scene, const Vec3& up) {
  return !scene.cameras.empty() &&
         std::all_of(scene.cameras.begin(), scene.cameras.end(),
                     [&](const Camera& camera) { return camera.up.normalized().dot(up) > kAlongAxis; });
}

}  // namespace

Vec3 up_direction(const Scene& scene) {
  if (scene.sky)
    for (const Vec3& axis : {Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())})
      if (scene.sky->up.dot(axis) > kAlongAxis) return axis;
  const std::string extension = lower_case_extension(scene.source);
  const Vec3 custom = extension == ".mgf" ? Vec3::UnitZ() : Vec3::UnitY();
  const Vec3 other = Vec3::UnitY() + Vec3::UnitZ() - custom;
  if (extension == ".json" || extension == ".obj") {
    if (all_cameras_say(scene, custom)) return custom;
    if (all_cameras_say(scene, other)) return other;
  }
  if (extension != ".mgf" && extension != ".obj") return custom;
  const Vec3 size = bounds(scene).size();
  const bool lit_from_above = mean_emission_direction(scene).dot(other) < -kMostlyDown;
  return lit_from_above && size.dot(other) <= size.dot(custom) ? other : custom;
}

}  // namespace reemit

#include "solver/emit/light_places.h"

#include <algorithm>
#include <array>
#include <variant>

#include <Eigen/Geometry>

#include "mesh/geometry/box_pairs.h"
#include "scenes/model/measures.h"

namespace reemit {
namespace {

/// A face at a corner of the room moves the light against the others there; this many rounds settle it.
constexpr int kPlacingRounds = 8;

/// Position of a light that is in some place of the room; null for light from infinitely far away.
Vec3* position_of(PunctualLight& light) {
  return std::visit(
      [](auto& l) -> Vec3* {
        if constexpr (requires { l.position; })
          return &l.position;
        else
          return nullptr;
      },
      light);
}

/// A flat triangle near a light, with the normal of the side that the light is to shine on.
struct NearFace {
  std::array<Vec3, 3> corner;
  Vec3 normal;

  double height(const Vec3& p) const { return normal.dot(p - corner[0]); }
  bool is_within(const Vec3& p, double distance) const {
    if (std::abs(height(p)) >= distance) return false;
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& a = corner[k];
      const Vec3& b = corner[(k + 1) % 3];
      if (squared_distance_to_segment(p, a, b) < distance * distance) return true;
      const Vec3 inwards = normal.cross(b - a);
      inside = inside && (inwards.dot(p - a) > 0) == (inwards.dot(corner[(k + 2) % 3] - a) > 0);
    }
    return inside;
  }
};

NearFace face_at(const ZoneMesh& mesh, TriangleId t, const PunctualLight& light, const Vec3& position,
                 const Vec3& middle) {
  NearFace face{{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)}, mesh.triangle_normal(t)};
  if (!mesh.triangle(t).two_sided) return face;
  const auto* spot = std::get_if<SpotLight>(&light);
  const Vec3 meant = spot != nullptr ? spot->direction : Vec3(middle - position);
  if (face.normal.dot(meant) < 0) face.normal = -face.normal;
  return face;
}

void step_before(const std::vector<NearFace>& faces, double clearance, Vec3& position) {
  for (int round = 0; round < kPlacingRounds; ++round) {
    bool moved = false;
    for (const NearFace& face : faces) {
      if (!face.is_within(position, clearance)) continue;
      // A little more, so that rounding does not ask for another round.
      position += (1.001 * clearance - face.height(position)) * face.normal;
      moved = true;
    }
    if (!moved) return;
  }
}

}  // namespace

std::vector<PunctualLight> lights_before_faces(const Scene& scene, const RayTracer& rays) {
  std::vector<PunctualLight> lights = scene.lights;
  const ZoneMesh& mesh = rays.mesh();
  const double clearance = kLightClearance * rays.metres_per_unit();
  std::vector<IndexedBox> places;
  for (std::uint32_t i = 0; i < lights.size(); ++i)
    if (const Vec3* p = position_of(lights[i]))
      places.push_back({*p - Vec3::Constant(2 * clearance), *p + Vec3::Constant(2 * clearance), i});
  if (places.empty()) return lights;
  std::vector<IndexedBox> boxes;
  boxes.reserve(mesh.flat_count());
  for (std::uint32_t i = 0; i < mesh.flat_count(); ++i) {
    const TriangleId t(i);
    const Vec3& a = mesh.corner(t, 0);
    const Vec3& b = mesh.corner(t, 1);
    const Vec3& c = mesh.corner(t, 2);
    boxes.push_back({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c), i});
  }
  std::vector<std::vector<NearFace>> near(lights.size());
  for_each_box_pair(places, boxes, [&](std::uint32_t light, std::uint32_t triangle) {
    near[light].push_back(
        face_at(mesh, TriangleId(triangle), lights[light], *position_of(lights[light]), rays.centre()));
  });
  for (std::size_t i = 0; i < lights.size(); ++i)
    if (!near[i].empty()) step_before(near[i], clearance, *position_of(lights[i]));
  return lights;
}

}  // namespace reemit

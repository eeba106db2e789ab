#pragma once
#include "scenes/io/common/polygon_loops.h"
#include "scenes/model/measures.h"
#include "scenes/model/scene.h"

namespace reemit::test {

inline std::vector<Vec3> corners(const Surface& surface, const std::vector<std::uint32_t>& loop) {
  std::vector<Vec3> points;
  for (const std::uint32_t index : loop) points.push_back(surface.positions[index]);
  return points;
}

/// Area times unit normal of a face without its holes [m2].
inline Vec3 area_vector(const Surface& surface, const Face& face) {
  const Vec3 outer = loop_area(corners(surface, face.outer));
  double holes = 0;
  for (const auto& hole : face.holes) holes += loop_area(corners(surface, hole)).norm();
  return outer * (1 - holes / outer.norm());
}

inline Vec3 area_vector(const Polygon& polygon) {
  const Vec3 outer = loop_area(polygon.outer);
  double holes = 0;
  for (const auto& hole : polygon.holes) holes += loop_area(hole).norm();
  return outer * (1 - holes / outer.norm());
}

inline double total_area(const std::vector<Polygon>& polygons) {
  double sum = 0;
  for (const Polygon& p : polygons) sum += area_vector(p).norm();
  return sum;
}

inline double total_area(const Scene& scene) {
  double sum = 0;
  for (const Surface& s : scene.surfaces)
    for (const Face& f : s.faces) sum += area_vector(s, f).norm();
  return sum;
}

inline std::size_t face_count(const Scene& scene) {
  std::size_t sum = 0;
  for (const Surface& s : scene.surfaces) sum += s.faces.size();
  return sum;
}

/// Volume enclosed by a closed shell whose fronts look outwards; negative if they look inwards.
inline double enclosed_volume(const std::vector<Polygon>& shell) {
  double sum = 0;
  for (const Polygon& p : shell) sum += p.outer[0].dot(area_vector(p)) / 3;
  return sum;
}

}  // namespace reemit::test

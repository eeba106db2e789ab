#include "scenes/io/common/surface_geometry.h"

#include <algorithm>

#include "scenes/model/measures.h"

namespace reemit {

namespace {

void reverse_loops(Surface& surface) {
  for (Face& face : surface.faces) {
    std::reverse(face.outer.begin(), face.outer.end());
    std::reverse(face.normals.begin(), face.normals.end());
    std::reverse(face.texture_points.begin(), face.texture_points.end());
    for (auto& hole : face.holes) std::reverse(hole.begin(), hole.end());
  }
}

}  // namespace

double face_area(const Surface& surface, const Face& face) {
  double area = outline_area(surface.positions, face.outer).norm();
  for (const auto& hole : face.holes) area -= outline_area(surface.positions, hole).norm();
  return std::max(area, 0.0);
}

double surface_area(const Surface& surface) {
  double area = 0;
  for (const Face& face : surface.faces) area += face_area(surface, face);
  for (const CurvedShape& shape : surface.shapes) area += shape_area(shape);
  return area;
}

void flip_surface(Surface& surface) {
  reverse_loops(surface);
  for (Vec3& normal : surface.normals) normal = -normal;
  for (CurvedShape& shape : surface.shapes) shape = flipped(shape);
}

void transform_surface(const Eigen::Affine3d& transform, Surface& surface) {
  for (Vec3& position : surface.positions) position = transform * position;
  // Normals go with the cofactors, which is the inverse transpose times the determinant: no inverse is
  // needed.
  const Eigen::Matrix3d linear = transform.linear();
  Eigen::Matrix3d cofactors;
  cofactors.col(0) = linear.col(1).cross(linear.col(2));
  cofactors.col(1) = linear.col(2).cross(linear.col(0));
  cofactors.col(2) = linear.col(0).cross(linear.col(1));
  const bool mirrors = linear.determinant() < 0;
  if (mirrors) cofactors = -cofactors;
  for (Vec3& normal : surface.normals) normal = (cofactors * normal).normalized();
  if (mirrors) reverse_loops(surface);
  for (CurvedShape& shape : surface.shapes) shape = transformed(shape, transform);
}

}  // namespace reemit

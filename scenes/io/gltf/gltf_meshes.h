#pragma once
#include <string>
#include <vector>

#include "scenes/io/gltf/gltf_accessors.h"
#include "scenes/model/scene.h"

namespace reemit {

/// A primitive of a glTF mesh as triangles in the coordinates of the mesh.
struct GltfPrimitive {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;                 ///< One per position, or none.
  std::vector<TexturePoint> texture_points;  ///< Likewise.
  bool has_colours = false;                  ///< They have colours of their own.
  std::vector<Face> faces;
  MaterialId material;
};

/// What was left out, for one warning each.
struct GltfOmissions {
  std::size_t other_modes = 0;  ///< Primitives made of points or lines.
  std::size_t collapsed = 0;    ///< Triangles that name a vertex twice.
  std::size_t plain = 0;        ///< Primitives without a material.
};

/// The triangles of a mesh, one entry per primitive; empty for points and lines. The material with the number
/// of glTF materials stands for "none". `weights`: of its morph targets, by which positions and normals are
/// moved; missing ones are 0. Throws InputError naming mesh and primitive.
std::vector<GltfPrimitive> read_gltf_mesh(const GltfModel& gltf, const GltfAccessors& accessors, int mesh,
                                          const std::vector<double>& weights, GltfOmissions& omissions);

}  // namespace reemit

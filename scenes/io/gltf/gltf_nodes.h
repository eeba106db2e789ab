#pragma once
#include <vector>

#include "scenes/io/gltf/gltf_accessors.h"
#include "scenes/model/scene.h"

namespace reemit {

/// A node of the scene that is read, with its place in the room.
struct GltfPlacedNode {
  std::size_t node;
  Eigen::Affine3d to_world;
};

/// The nodes of the default scene (else the first scene, else all roots), parents before children, without
/// those that are hidden. Warns about these and about other scenes. Throws InputError for cycles, nodes with
/// two parents, and indices and transforms that make no sense.
std::vector<GltfPlacedNode> place_gltf_nodes(const GltfModel& gltf, Scene& scene);

/// The instances that EXT_mesh_gpu_instancing gives the node, or one identity. Throws InputError.
std::vector<Eigen::Affine3d> gltf_instances(const GltfModel& gltf, const GltfAccessors& accessors,
                                            std::size_t node);

}  // namespace reemit

#include "scenes/io/gltf/gltf_nodes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenes/model/error.h"

namespace reemit {

namespace {

constexpr int kNone = -1;

/// Where a node stands, and its name.
std::string node_place(const GltfModel& gltf, std::size_t node) {
  return gltf.at(fmt::format("/nodes/{}: node \"{}\"", node, gltf.model.nodes[node].name));
}

Eigen::Quaterniond rotation_of(double x, double y, double z, double w, const std::string& where) {
  const Eigen::Quaterniond rotation(w, x, y, z);
  if (!(rotation.norm() > 1e-6) || !rotation.coeffs().allFinite()) {
    throw InputError(where, "its rotation is no unit quaternion", "Export the file anew.");
  }
  return rotation.normalized();
}

Eigen::Affine3d local_transform(const GltfModel& gltf, std::size_t index) {
  const tinygltf::Node& node = gltf.model.nodes[index];
  const auto check = [&](const std::vector<double>& values, std::size_t size, const char* what) {
    const bool finite = std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    if ((!values.empty() && values.size() != size) || !finite) {
      throw InputError(node_place(gltf, index),
                       fmt::format("its {} is not made of {} finite numbers", what, size),
                       "Export the file anew.");
    }
    return !values.empty();
  };
  if (check(node.matrix, 16, "matrix")) {
    Eigen::Affine3d transform;
    transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());  // Both are column-major.
    if ((transform.matrix().row(3) - Eigen::RowVector4d(0, 0, 0, 1)).norm() > 1e-6) {
      throw InputError(node_place(gltf, index), "its matrix is not affine", "Export the file anew.");
    }
    return transform;
  }
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (check(node.translation, 3, "translation")) {
    transform.translate(Vec3(node.translation[0], node.translation[1], node.translation[2]));
  }
  if (check(node.rotation, 4, "rotation")) {
    const auto& r = node.rotation;
    transform.rotate(rotation_of(r[0], r[1], r[2], r[3], node_place(gltf, index)));
  }
  if (check(node.scale, 3, "scale")) transform.scale(Vec3(node.scale[0], node.scale[1], node.scale[2]));
  return transform;
}

/// The parent of each node, or kNone.
std::vector<int> parents_of(const GltfModel& gltf) {
  const auto& nodes = gltf.model.nodes;
  std::vector<int> parents(nodes.size(), kNone);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const int child : nodes[i].children) {
      if (child < 0 || static_cast<std::size_t>(child) >= nodes.size()) {
        throw InputError(node_place(gltf, i), fmt::format("there is no child node {}", child),
                         "Export the file anew.");
      }
      int& parent = parents[static_cast<std::size_t>(child)];
      if (parent != kNone) {
        throw InputError(node_place(gltf, static_cast<std::size_t>(child)),
                         fmt::format("it is a child of node {} and again of node {}", parent, i),
                         "The nodes must form trees; export the file anew.");
      }
      parent = static_cast<int>(i);
    }
  }
  return parents;
}

/// Without two parents anywhere, a cycle is a set of nodes that no root reaches.
void check_for_cycles(const GltfModel& gltf, const std::vector<int>& parents) {
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < parents.size(); ++i) {
    if (parents[i] == kNone) open.push_back(i);
  }
  std::vector<bool> reached(parents.size(), false);
  while (!open.empty()) {
    const std::size_t node = open.back();
    open.pop_back();
    reached[node] = true;
    for (const int child : gltf.model.nodes[node].children) open.push_back(static_cast<std::size_t>(child));
  }
  const auto lost = std::find(reached.begin(), reached.end(), false);
  if (lost == reached.end()) return;
  throw InputError(node_place(gltf, static_cast<std::size_t>(lost - reached.begin())),
                   "it is its own ancestor", "The nodes must form trees; export the file anew.");
}

/// A node to begin with, and what its parents, which are not read, make of its place.
std::vector<GltfPlacedNode> roots_to_read(const GltfModel& gltf, const std::vector<int>& parents,
                                          Scene& scene) {
  const tinygltf::Model& model = gltf.model;
  std::vector<GltfPlacedNode> roots;
  if (model.scenes.empty()) {
    for (std::size_t i = 0; i < parents.size(); ++i) {
      if (parents[i] == kNone) roots.push_back({i, Eigen::Affine3d::Identity()});
    }
    return roots;
  }
  const int chosen = std::max(model.defaultScene, 0);
  if (static_cast<std::size_t>(chosen) >= model.scenes.size()) {
    throw InputError(gltf.at("/scene"), fmt::format("there is no scene {}", chosen), "Export the file anew.");
  }
  const tinygltf::Scene& source = model.scenes[static_cast<std::size_t>(chosen)];
  if (model.scenes.size() > 1) {
    scene.warnings.push_back(fmt::format("scene {} \"{}\" of {} is read, the others are not", chosen,
                                         source.name, model.scenes.size()));
  }
  std::vector<bool> named(parents.size(), false);
  for (const int node : source.nodes) {
    if (node < 0 || static_cast<std::size_t>(node) >= parents.size()) {
      throw InputError(gltf.at(fmt::format("/scenes/{}/nodes", chosen)),
                       fmt::format("scene {} names node {}, which does not exist", chosen, node),
                       "Export the file anew.");
    }
    named[static_cast<std::size_t>(node)] = true;
  }
  // Some exporters name children of a node that the scene leaves out.
  std::size_t children = 0;
  std::string first;
  std::vector<bool> read(parents.size(), false);
  int parent = kNone;  // of the last node, and what was found of it: many have the same
  Eigen::Affine3d to_parent = Eigen::Affine3d::Identity();
  bool is_below_another = false;
  for (const int node : source.nodes) {
    const auto index = static_cast<std::size_t>(node);
    if (parents[index] != parent) {
      parent = parents[index];
      to_parent.setIdentity();
      is_below_another = false;
      for (int p = parent; p != kNone && !is_below_another; p = parents[static_cast<std::size_t>(p)]) {
        to_parent = local_transform(gltf, static_cast<std::size_t>(p)) * to_parent;
        is_below_another = named[static_cast<std::size_t>(p)];
      }
    }
    if ((parents[index] != kNone || read[index]) && children++ == 0) first = node_place(gltf, index);
    if (!is_below_another && !read[index]) roots.push_back({index, to_parent});
    read[index] = true;
  }
  if (children > 0)
    scene.warnings.push_back(
        fmt::format("the scene names {} node(s) that are children of others or named before; each is read "
                    "once, where its parents put it. The first is {}",
                    children, first));
  return roots;
}

/// KHR_node_visibility: a node that is hidden hides what is below it.
bool is_hidden(const tinygltf::Node& node) {
  const auto extension = node.extensions.find("KHR_node_visibility");
  if (extension == node.extensions.end() || !extension->second.IsObject()) return false;
  const tinygltf::Value& visible = extension->second.Get("visible");
  return visible.IsBool() && !visible.Get<bool>();
}

}  // namespace

std::vector<GltfPlacedNode> place_gltf_nodes(const GltfModel& gltf, Scene& scene) {
  const std::vector<int> parents = parents_of(gltf);
  check_for_cycles(gltf, parents);
  std::vector<GltfPlacedNode> open = roots_to_read(gltf, parents, scene);
  std::vector<GltfPlacedNode> placed;
  std::reverse(open.begin(), open.end());
  std::size_t hidden = 0;
  while (!open.empty()) {
    GltfPlacedNode node = open.back();
    open.pop_back();
    if (is_hidden(gltf.model.nodes[node.node])) {
      ++hidden;
      continue;
    }
    node.to_world = node.to_world * local_transform(gltf, node.node);
    placed.push_back(node);
    const auto& children = gltf.model.nodes[node.node].children;
    for (auto it = children.rbegin(); it != children.rend(); ++it) {
      open.push_back({static_cast<std::size_t>(*it), node.to_world});
    }
  }
  if (hidden > 0)
    scene.warnings.push_back(fmt::format(
        "{} node(s) that are not visible (KHR_node_visibility) are left out with all below", hidden));
  return placed;
}

std::vector<Eigen::Affine3d> gltf_instances(const GltfModel& gltf, const GltfAccessors& accessors,
                                            std::size_t node) {
  const auto& extensions = gltf.model.nodes[node].extensions;
  const auto it = extensions.find("EXT_mesh_gpu_instancing");
  if (it == extensions.end()) return {Eigen::Affine3d::Identity()};
  const std::string where = fmt::format("/nodes/{}/extensions/EXT_mesh_gpu_instancing/attributes", node);
  const tinygltf::Value* attributes =
      it->second.IsObject() && it->second.Has("attributes") ? &it->second.Get("attributes") : nullptr;
  const auto accessor = [&](const char* name) {
    if (!attributes || !attributes->IsObject() || !attributes->Has(name)) return kNone;
    const tinygltf::Value& value = attributes->Get(name);
    if (!value.IsInt() || value.GetNumberAsInt() < 0) {
      throw InputError(gltf.at(fmt::format("{}/{}", where, name)), "it is no accessor",
                       "Export the file anew.");
    }
    return value.GetNumberAsInt();
  };
  const int translation = accessor("TRANSLATION"), rotation = accessor("ROTATION"), scale = accessor("SCALE");
  std::vector<Vec3> translations, scales;
  std::vector<Eigen::Vector4d> rotations;
  if (translation != kNone) translations = accessors.vec3(translation, where + "/TRANSLATION");
  if (rotation != kNone) rotations = accessors.vec4(rotation, where + "/ROTATION");
  if (scale != kNone) scales = accessors.vec3(scale, where + "/SCALE");
  const std::size_t count = std::max({translations.size(), rotations.size(), scales.size()});
  for (const std::size_t size : {translations.size(), rotations.size(), scales.size()}) {
    if (size != 0 && size != count) {
      throw InputError(gltf.at(where), "its attributes differ in length", "Export the file anew.");
    }
  }
  std::vector<Eigen::Affine3d> instances(count, Eigen::Affine3d::Identity());
  for (std::size_t i = 0; i < count; ++i) {
    if (!translations.empty()) instances[i].translate(translations[i]);
    if (!rotations.empty()) {
      const Eigen::Vector4d& r = rotations[i];
      instances[i].rotate(rotation_of(r[0], r[1], r[2], r[3], gltf.at(where + "/ROTATION")));
    }
    if (!scales.empty()) instances[i].scale(scales[i]);
  }
  return instances;
}

}  // namespace reemit

#include "scenes/io/gltf/gltf_reader.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scenes/io/common/surface_geometry.h"
#include "scenes/io/gltf/gltf_materials.h"
#include "scenes/io/gltf/gltf_meshes.h"
#include "scenes/io/gltf/gltf_nodes.h"
#include "scenes/model/error.h"
#include "scenes/model/limits.h"
#include "scenes/model/memory.h"

namespace reemit {

namespace {

/// Turns placed nodes into surfaces, lights and cameras.
class NodeReader {
 public:
  NodeReader(const GltfModel& gltf, const GltfAccessors& accessors, const GltfUnits& units, Scene& scene)
      : gltf_(gltf), accessors_(accessors), units_(units), scene_(scene) {}

  void read(const GltfPlacedNode& placed) {
    const tinygltf::Node& node = gltf_.model.nodes[placed.node];
    node_ = placed.node;
    name_ = node.name.empty() ? fmt::format("node {}", placed.node) : node.name;
    if (!placed.to_world.matrix().allFinite())
      fail("its place in the room is not finite", "Check its transforms.");
    check_place(placed.to_world.translation());
    if (node.mesh >= 0) read_mesh(placed, node);
    if (node.camera >= 0) read_camera(placed, node.camera);
    const auto light = node.extensions.find("KHR_lights_punctual");
    if (light != node.extensions.end()) read_light(placed, light->second);
    if (node.extensions.contains("EXT_lights_ies")) ++measured_;
    if (node.skin >= 0) ++skins_;
  }

  /// Faces with all instances, which may be far more than the file has.
  std::size_t count_faces(const std::vector<GltfPlacedNode>& placed) {
    std::size_t count = 0;
    for (const GltfPlacedNode& p : placed) {
      node_ = p.node;
      const tinygltf::Node& node = gltf_.model.nodes[p.node];
      if (node.mesh < 0) continue;
      std::size_t faces = 0;
      for (const GltfPrimitive& primitive : mesh(node)) faces += primitive.faces.size();
      count += faces * gltf_instances(gltf_, accessors_, p.node).size();
    }
    return count;
  }

  void report() {
    const auto warn = [&](std::size_t count, KindCounts& counts, const char* kind, const char* what) {
      if (count == 0) return;
      counts[kind] += count;
      scene_.warnings.push_back(fmt::format("{} {}", count, what));
    };
    KindCounts& refused = scene_.refused;
    KindCounts& not_modelled = scene_.not_modelled;
    warn(omissions_.other_modes, refused, "points_and_lines",
         "mesh primitive(s) made of points or lines are left out");
    warn(omissions_.plain, refused, "materials",
         "mesh primitive(s) have no material: grey with reflectance 0.5 is used");
    warn(flattened_, refused, "nodes_of_scale_0", "mesh node(s) are left out because their scale is 0");
    warn(measured_, refused, "luminaires",
         "measured luminaire(s) (EXT_lights_ies) are left out; a native room can place them");
    warn(skins_, not_modelled, "skins",
         "skinned node(s) are read as their meshes stand, without their skeletons: where these scale or move "
         "them, size and place are others");
    if (!gltf_.model.animations.empty()) {
      not_modelled["animations"] += gltf_.model.animations.size();
      scene_.warnings.push_back(
          "animations are ignored: the room is read as it stands in the node hierarchy");
    }
    if (soft_spots_)
      scene_.notes.push_back(
          "Between its cones a spot falls off as KHR_lights_punctual recommends; by Blender's own curve it "
          "would have up to 28 % more light there.");
    if (omissions_.collapsed > 0) {
      scene_.notes.push_back(
          fmt::format("{} triangle(s) that name a vertex twice are dropped", omissions_.collapsed));
    }
  }

 private:
  /// How often a name was given; instances of a collection bring the names of its nodes again.
  using NameUses = std::map<std::string, int>;
  /// Its number and the weights of its morph targets.
  using MorphedMesh = std::pair<int, std::vector<double>>;
  static std::string own_name(const std::string& name, NameUses& uses) {
    const int count = ++uses[name];
    return count == 1 ? name : fmt::format("{} #{}", name, count);
  }

  [[noreturn]] void fail(const std::string& problem, const std::string& advice) const {
    fail_at(fmt::format("/nodes/{}: node \"{}\"", node_, gltf_.model.nodes[node_].name), problem, advice);
  }

  [[noreturn]] void fail_at(const std::string& pointer, const std::string& problem,
                            const std::string& advice) const {
    throw InputError(gltf_.at(pointer), problem, advice);
  }

  void check_place(const Vec3& place) const {
    const std::string problem = place_problem(place);
    if (!problem.empty()) fail(problem, kLengthAdvice);
  }

  const std::vector<GltfPrimitive>& mesh(const tinygltf::Node& node) {
    const int index = node.mesh;
    if (static_cast<std::size_t>(index) >= gltf_.model.meshes.size()) {
      fail(fmt::format("there is no mesh {}", index), "Export the file anew.");
    }
    const std::vector<double>& of_mesh = gltf_.model.meshes[static_cast<std::size_t>(index)].weights;
    const MorphedMesh key{index, node.weights.empty() ? of_mesh : node.weights};
    const auto known = meshes_.find(key);
    if (known != meshes_.end()) return known->second;
    return meshes_.emplace(key, read_gltf_mesh(gltf_, accessors_, index, key.second, omissions_))
        .first->second;
  }

  void read_mesh(const GltfPlacedNode& placed, const tinygltf::Node& node) {
    const std::vector<GltfPrimitive>& primitives = mesh(node);
    const std::vector<Eigen::Affine3d> instances = gltf_instances(gltf_, accessors_, placed.node);
    const std::string mesh_name = own_name(name_, mesh_names_);
    for (std::size_t i = 0; i < instances.size(); ++i) {
      const Eigen::Affine3d to_world = placed.to_world * instances[i];
      if (to_world.linear().determinant() == 0 || !to_world.matrix().allFinite()) {
        ++flattened_;
        continue;
      }
      const std::string name = instances.size() > 1 ? fmt::format("{}[{}]", mesh_name, i) : mesh_name;
      for (std::size_t k = 0; k < primitives.size(); ++k) {
        append(primitives[k], to_world, primitives.size() > 1 ? fmt::format("{}/{}", name, k) : name);
      }
    }
  }

  void append(const GltfPrimitive& primitive, const Eigen::Affine3d& to_world, const std::string& name) {
    if (primitive.faces.empty()) return;
    faces_ += primitive.faces.size();
    if (faces_ > kMostFaces) {
      fail(fmt::format("the room has more than {} triangles with all instances", kMostFaces), "Simplify it.");
    }
    Surface surface;
    surface.name = name;
    surface.source = gltf_.file;
    surface.material = primitive.material;
    surface.positions = primitive.positions;
    surface.normals = primitive.normals;
    surface.texture_points = primitive.texture_points;
    surface.has_vertex_colours = primitive.has_colours;
    surface.faces = primitive.faces;
    transform_surface(to_world, surface);
    for (const Vec3& corner : surface.positions) check_place(corner);
    scene_.surfaces.push_back(std::move(surface));
  }

  void read_camera(const GltfPlacedNode& placed, int index) {
    if (static_cast<std::size_t>(index) >= gltf_.model.cameras.size()) {
      fail(fmt::format("there is no camera {}", index), "Export the file anew.");
    }
    const tinygltf::Camera& source = gltf_.model.cameras[static_cast<std::size_t>(index)];
    Camera camera;
    camera.name = source.name.empty() ? name_ : source.name;
    if (source.type != "perspective") {
      leave_out("cameras", fmt::format("the camera \"{}\" is orthographic", camera.name));
      return;
    }
    const double yfov = source.perspective.yfov;
    if (!(yfov > 0 && yfov < std::numbers::pi)) {
      fail_at(fmt::format("/cameras/{}/perspective/yfov", index),
              fmt::format("the field of view of camera \"{}\" is {} rad", camera.name, yfov),
              "Set it between 0 and pi.");
    }
    const Eigen::Matrix3d axes = placed.to_world.linear();
    const Vec3 forward = -axes.col(2), up = axes.col(1);
    if (!(forward.norm() > 0) || !(forward.cross(up).norm() > 0)) {
      leave_out("cameras", fmt::format("the camera \"{}\" has a scale of 0", camera.name));
      return;
    }
    camera.vertical_fov_deg = yfov * 180 / std::numbers::pi;
    camera.eye = placed.to_world.translation();
    camera.look_at = camera.eye + forward.normalized();
    camera.up = up.normalized();
    const double aspect = source.perspective.aspectRatio;
    if (aspect > 0) {
      constexpr double kWidest = 16;
      camera.width = static_cast<int>(std::lround(camera.height * std::clamp(aspect, 1 / kWidest, kWidest)));
    }
    scene_.cameras.push_back(camera);
  }

  void read_light(const GltfPlacedNode& placed, const tinygltf::Value& reference) {
    const bool indexed = reference.IsObject() && reference.Has("light") && reference.Get("light").IsInt();
    const int index = indexed ? reference.Get("light").GetNumberAsInt() : -1;
    if (index < 0 || static_cast<std::size_t>(index) >= gltf_.model.lights.size()) {
      fail("its light does not exist", "Export the file anew.");
    }
    const tinygltf::Light& source = gltf_.model.lights[static_cast<std::size_t>(index)];
    const std::string name = own_name(source.name.empty() ? name_ : source.name, light_names_);
    std::vector<double> colour = source.color.empty() ? std::vector<double>{1, 1, 1} : source.color;
    const bool valid =
        colour.size() == 3 && source.intensity >= 0 && std::isfinite(source.intensity) &&
        std::all_of(colour.begin(), colour.end(), [](double c) { return c >= 0 && std::isfinite(c); });
    const std::string at_light = fmt::format("/extensions/KHR_lights_punctual/lights/{}", index);
    if (!valid)
      fail_at(at_light, fmt::format("the light \"{}\" has no valid colour or intensity", name),
              "Export the file anew.");
    const Spectrum strength =
        Eigen::Array3d(colour[0], colour[1], colour[2]) *
        (source.intensity * (source.type == "directional" ? units_.watts_per_m2() : units_.watts_per_sr()));
    const std::string problem = strength_problem(
        strength, source.type == "directional" ? "the irradiance [W/m2]" : "the intensity [W/sr]");
    if (!problem.empty()) fail_at(at_light + "/intensity", problem, kStrengthAdvice);
    const Vec3 position = placed.to_world.translation();
    const Vec3 forward = -placed.to_world.linear().col(2);
    if (!(strength > 0).any()) {
      scene_.notes.push_back(fmt::format("the light \"{}\" is switched off: its intensity is 0", name));
      return;
    }
    if (source.type != "point" && !(forward.norm() > 0)) {
      leave_out("luminaires", fmt::format("the light \"{}\" has a scale of 0", name));
      return;
    }
    if (source.type == "point") {
      scene_.lights.emplace_back(PointLight{name, position, strength});
    } else if (source.type == "directional") {
      scene_.lights.emplace_back(DirectionalLight{name, forward.normalized(), strength});
    } else if (source.type == "spot") {
      const double outer = source.spot.outerConeAngle;
      double inner = source.spot.innerConeAngle;
      // Programs write the same angle twice for a cone of sharp edge, which the format has no other way to
      // say.
      constexpr double kSharp = 1e-3;
      if (outer > 0 && inner <= outer * (1 + 1e-6)) inner = std::min(inner, (1 - kSharp) * outer);
      if (!(inner >= 0 && inner < outer && outer <= std::numbers::pi / 2 + 1e-6)) {
        fail_at(at_light + "/spot",
                fmt::format("the cone angles {} and {} of the spot \"{}\"", inner, outer, name),
                "They must satisfy 0 <= inner < outer <= pi/2.");
      }
      if (units_.by_blender && inner < (1 - 2 * kSharp) * outer) soft_spots_ = true;
      scene_.lights.emplace_back(SpotLight{name, position, forward.normalized(), strength, inner,
                                           std::min(outer, std::numbers::pi / 2)});
    } else {
      fail_at(at_light + "/type", fmt::format("the light \"{}\" is of an unknown type", name),
              "Known are: point, spot, directional.");
    }
  }

  void leave_out(const char* kind, const std::string& why) {
    ++scene_.refused[kind];
    scene_.warnings.push_back(why + " and is left out");
  }

  const GltfModel& gltf_;
  const GltfAccessors& accessors_;
  const GltfUnits& units_;
  Scene& scene_;
  std::map<MorphedMesh, std::vector<GltfPrimitive>> meshes_;
  GltfOmissions omissions_;
  std::size_t faces_ = 0;
  std::size_t flattened_ = 0;
  std::size_t skins_ = 0;
  std::size_t measured_ = 0;
  bool soft_spots_ = false;  // of Blender
  std::size_t node_ = 0;
  std::string name_;
  NameUses mesh_names_, light_names_;
};

void state_conversions(const GltfUnits& units, Scene& scene) {
  const bool emits = std::any_of(scene.materials.begin(), scene.materials.end(),
                                 [](const Material& material) { return material.emits(); });
  if (emits) scene.notes.push_back("emissive meshes: values are taken " + units.emissive_assumption);
  if (!scene.lights.empty()) scene.notes.push_back("lamps: strengths are taken " + units.lamp_assumption);
  if (units.by_blender && !emits && scene.lights.empty())
    scene.warnings.push_back(
        "no lamp is in the file: Blender exports points, spots and suns (tick Punctual Lights), but no area "
        "lamps; a "
        "plane with an emissive material stands for one");
  std::string options;
  if (emits && units.emission_open) options += " --emissive-units W/sr/m2";
  if (!scene.lights.empty() && units.lamps_open) options += " --gltf-light-efficacy 683";
  if (!options.empty())
    scene.warnings.push_back(
        fmt::format("{} rewrote the file and did not keep the name of the program it comes from, whose units "
                    "may be others; if that was Blender (3.4 or later), give{}",
                    units.rewritten_by, options));
}

}  // namespace

Scene read_gltf_scene(const std::filesystem::path& file, const ReadOptions& options) {
  const GltfModel gltf = load_gltf_model(file);
  Scene scene;
  scene.name = file.stem().string();
  scene.source = gltf.file;
  scene.bands = BandSet::rgb();
  scene.warnings = gltf.warnings;
  const GltfAccessors accessors(gltf);
  const GltfUnits units = gltf_units(gltf.model.asset.generator, options);
  read_gltf_materials(gltf, accessors, units, scene);
  NodeReader reader(gltf, accessors, units, scene);
  const std::vector<GltfPlacedNode> nodes = place_gltf_nodes(gltf, scene);
  const std::size_t faces = reader.count_faces(nodes);
  if (faces <= kMostFaces)
    check_memory(fmt::format("{}: {} triangles with all instances", scene.source, faces),
                 kLeastBytesPerFace * static_cast<double>(faces), available_memory());
  for (const GltfPlacedNode& node : nodes) reader.read(node);
  reader.report();
  state_conversions(units, scene);
  return scene;
}

}  // namespace reemit

#include "scenes/io/native/native_objects.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/io/common/surface_geometry.h"
#include "scenes/io/native/native_transform.h"

namespace reemit {

namespace {

constexpr std::size_t kMostObjects = 1'000'000;
constexpr int kDeepestGroup = 32;

/// What an object may be, and how it is read. Groups and files are no shapes of their own.
struct ShapeKind {
  const char* key;
  Surface (*read)(const JsonCursor&);
};
constexpr ShapeKind kShapes[] = {{"polygon", read_polygon},  {"quad", read_quad}, {"box", read_box},
                                 {"sphere", read_sphere},    {"disk", read_disk}, {"mesh", read_mesh},
                                 {"cylinder", read_cylinder}};

std::string content_key(const JsonCursor& at) {
  at.expect_object({"name", "material", "materials", "transform", "array", "flip", "polygon", "quad", "box",
                    "sphere", "cylinder", "disk", "mesh", "group", "objects", "file"});
  const std::vector<std::string> content{"polygon", "quad", "box",   "sphere",  "cylinder",
                                         "disk",    "mesh", "group", "objects", "file"};
  std::string found;
  for (const std::string& key : content) {
    if (!at.find(key.c_str())) continue;
    if (!found.empty()) {
      at.fail(fmt::format("an object cannot be both a {} and a {}", found, key), "Write two objects.");
    }
    found = key;
  }
  if (found.empty())
    at.fail("the object has no content", fmt::format("Give one of {}.", fmt::join(content, ", ")));
  return found;
}

}  // namespace

double read_unit(const JsonCursor& at) {
  const std::string& unit = at.choice({"m", "mm", "cm", "ft", "in"});
  if (unit == "mm") return 1e-3;
  if (unit == "cm") return 1e-2;
  if (unit == "ft") return 0.3048;
  if (unit == "in") return 0.0254;
  return 1;
}

NativeObjects::NativeObjects(std::filesystem::path folder, const ReadOptions& options, double unit,
                             std::optional<JsonCursor> groups, NativeMaterials& materials, Scene& scene)
    : folder_(std::move(folder)),
      options_(options),
      unit_(unit),
      groups_(groups),
      materials_(materials),
      scene_(scene) {
  if (groups_) groups_->expect_object();
}

void NativeObjects::read(const JsonCursor& objects) {
  read_list(objects, {Eigen::Affine3d(Eigen::Scaling(unit_)), "", std::nullopt, 0});
}

void NativeObjects::read_list(const JsonCursor& objects, const Placement& placement) {
  objects.expect_array(0);
  for (std::size_t i = 0; i < objects.size(); ++i) read_object(objects[i], i, placement);
}

void NativeObjects::read_object(const JsonCursor& at, std::size_t number, const Placement& placement) {
  const std::string kind = content_key(at);
  const auto given_name = at.find("name");
  const std::string name = given_name ? given_name->string() : fmt::format("{} {}", kind, number);
  Placement own = placement;
  if (const auto material = at.find("material")) own.material = materials_.find(*material);
  const auto transform = at.find("transform");
  const Eigen::Affine3d local = transform ? read_transform(*transform) : Eigen::Affine3d::Identity();
  const auto array = at.find("array");
  if (!array) {
    own.to_world = placement.to_world * local;
    read_content(at, kind, own, name);
    return;
  }
  for (const ArrayPlacement& element : read_array(*array)) {
    own.to_world = placement.to_world * element.transform * local;
    read_content(at, kind, own, fmt::format("{}[{}]", name, fmt::join(element.index, ",")));
  }
}

void NativeObjects::read_content(const JsonCursor& at, const std::string& kind, const Placement& placement,
                                 const std::string& name) {
  if (++objects_ > kMostObjects) {
    at.fail(fmt::format("the room has more than {} objects after the expansion of groups and arrays",
                        kMostObjects),
            "Use fewer, or read large geometry from a file.");
  }
  const JsonCursor content = at.at(kind.c_str());
  const auto per_part = at.find("materials");
  if (per_part && kind != "box" && kind != "file") {
    per_part->fail(fmt::format("a {} has no parts with materials of their own", kind), "Use \"material\".");
  }
  Placement inner = placement;
  inner.prefix = placement.prefix + name + "/";
  if (kind == "objects" || kind == "group") {
    if (at.find("flip")) at.at("flip").fail("flip does not apply to groups", "Put it on the objects inside.");
    if (++inner.depth > kDeepestGroup) {
      content.fail(fmt::format("groups are nested deeper than {}", kDeepestGroup), "Flatten them.");
    }
    kind == "group" ? read_group(content, inner) : read_list(content, inner);
    return;
  }
  if (kind == "file") {
    read_file(content, at, inner, name);
    return;
  }
  const auto shape_kind = std::find_if(std::begin(kShapes), std::end(kShapes),
                                       [&](const ShapeKind& candidate) { return kind == candidate.key; });
  Surface shape = shape_kind->read(content);
  const auto flipped = at.find("flip");
  if (flipped && flipped->boolean()) flip_surface(shape);
  if (per_part) {
    read_box_with_materials(at, std::move(shape), placement, name);
  } else {
    shape.material = demand_material(at, placement);
    append(std::move(shape), at, placement, placement.prefix + name);
  }
}

void NativeObjects::read_box_with_materials(const JsonCursor& at, Surface shape, const Placement& placement,
                                            const std::string& name) {
  const JsonCursor materials = at.at("materials");
  materials.expect_object({"x-", "x+", "y-", "y+", "z-", "z+"});
  for (std::size_t i = 0; i < shape.faces.size(); ++i) {
    const auto material = materials.find(kBoxFaces[i]);
    if (shape.faces[i].outer.empty()) {
      if (material)
        material->fail("this face of the box is open", "Remove the face from \"open\" or from here.");
      continue;
    }
    Surface side;
    side.faces.push_back({{0, 1, 2, 3}, {}, {}, 0, shape.faces[i].texture_points});
    side.texture_points = shape.texture_points;
    for (const std::uint32_t corner : shape.faces[i].outer) side.positions.push_back(shape.positions[corner]);
    side.material = material ? materials_.find(*material) : demand_material(at, placement);
    append(std::move(side), at, placement, fmt::format("{}{}/{}", placement.prefix, name, kBoxFaces[i]));
  }
}

void NativeObjects::read_group(const JsonCursor& name, const Placement& placement) {
  const std::string& wanted = name.string();
  const std::optional<JsonCursor> group = groups_ ? groups_->find(wanted.c_str()) : std::nullopt;
  if (!group) {
    std::vector<std::string> known;
    if (groups_) {
      for (const auto& [key, value] : groups_->members()) known.push_back(key);
    }
    name.fail(fmt::format("there is no group \"{}\"", wanted), known_names(wanted, known));
  }
  if (!open_groups_.insert(wanted).second) {
    name.fail(fmt::format("the group \"{}\" contains itself", wanted), "Break the cycle.");
  }
  read_list(*group, placement);
  open_groups_.erase(wanted);
}

MaterialId NativeObjects::demand_material(const JsonCursor& at, const Placement& placement) const {
  if (placement.material) return *placement.material;
  at.fail("the object has no material", "Add \"material\" here or in a group around it.");
}

void NativeObjects::append(Surface surface, const JsonCursor& at, const Placement& placement,
                           const std::string& name) {
  std::erase_if(surface.faces, [](const Face& face) { return face.outer.empty(); });  // Open sides of a box.
  faces_ += surface.faces.size() + surface.shapes.size();
  if (faces_ > kMostFaces) {
    at.fail(fmt::format("the room has more than {} faces", kMostFaces),
            "Use fewer segments or smaller arrays.");
  }
  if (surface.empty()) return;
  if (!surface.shapes.empty() && !is_similarity(placement.to_world))
    at.fail("a round shape is scaled by different factors in different directions",
            "Scale it evenly, or give it \"segments\", which makes it of flat faces.");
  if (surface.source.empty()) surface.source = scene_.source;
  const int uses = ++names_[name];
  surface.name = uses == 1 ? name : fmt::format("{} #{}", name, uses);
  transform_surface(placement.to_world, surface);
  scene_.surfaces.push_back(std::move(surface));
}

}  // namespace reemit

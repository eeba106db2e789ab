#include <algorithm>
#include <array>
#include <utility>

#include <nlohmann/json.hpp>

#include "viewer_export/formats/glb_file.h"
#include "viewer_export/formats/vertex_export.h"
#include "viewer_export/inspection/inspection_picture.h"
#include "viewer_export/inspection/side_kinds.h"
#include "viewer_export/output/export_info.h"
#include "viewer_export/output/file_extension.h"

#include "reemit/version.h"

namespace reemit {
namespace {

using Json = nlohmann::ordered_json;

struct PictureFormat {
  std::string_view extension;
};
constexpr PictureFormat kFormats[] = {{".glb"}};

// Of the materials of the document.
constexpr int kSurfaceMaterial = 0;
constexpr int kLineMaterial = 1;

Json extras_of(const InspectionPicture& picture, const Scene& scene) {
  Json legend;
  for (std::size_t k = 0; k < kSideKindCount; ++k) {
    const SideKindStyle& style = style_of(static_cast<SideKind>(k));
    legend[style.name] = style.hex();
  }
  Json extras{
      {"room", one_line(scene.source.empty() ? scene.name : scene.source)},
      {"room hash", content_hash(scene)},
      {"colours", legend},
      {"zones",
       "red: smallest, over green to blue: largest, logarithmic, the last 2 % alike; grey: no light"}};
  for (const PictureSet& set : picture.sets) extras["shift_m"][set.name] = set.shift.x();
  return extras;
}

Json point_json(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

// Makes accessors, meshes and nodes of the objects, whose vertices and indices lie one after the other.
class Document {
 public:
  Document(const InspectionPicture& picture, const Scene& scene) : picture_(picture) {
    gltf_["asset"] = {{"version", "2.0"},
                      {"generator", std::string("reemit ") + kProgramVersion},
                      {"extras", extras_of(picture, scene)}};
    gltf_["extensionsUsed"] = {"KHR_materials_unlit"};
  }

  Json make() && {
    Json roots = Json::array();
    for (const PictureSet& set : picture_.sets) {
      Json children = Json::array();
      for (const PictureObject& object : set.objects) children.push_back(add_object(object));
      if (children.empty()) continue;
      roots.push_back(nodes_.size());
      nodes_.push_back({{"name", set.name}, {"children", std::move(children)}});
      const Vec3 place = picture_.origin + set.shift;
      if (place != Vec3::Zero()) nodes_.back()["translation"] = point_json(place);
    }
    add_scene(gltf_, std::move(nodes_), std::move(roots), picture_.up);
    gltf_["meshes"] = std::move(meshes_);
    gltf_["materials"] = {material("coloured by vertex"), material("luminaires")};
    gltf_["materials"][kLineMaterial]["extensions"]["KHR_materials_unlit"] = Json::object();
    gltf_["accessors"] = std::move(accessors_);
    BufferViews views;
    views.add(sizeof(PictureObject::Vertex) * vertices_, Gltf::kArrayBuffer, sizeof(PictureObject::Vertex));
    views.add(sizeof(std::uint32_t) * indices_, Gltf::kElementArrayBuffer);
    std::move(views).add_to(gltf_);
    return std::move(gltf_);
  }

 private:
  static Json material(const char* name) {
    return {{"name", name}, {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 1.0}}}};
  }

  std::size_t add_accessor(Json accessor) {
    accessors_.push_back(std::move(accessor));
    return accessors_.size() - 1;
  }

  std::size_t add_positions(const PictureObject& object) {
    std::array<float, 3> low = object.vertices().front().position;
    std::array<float, 3> high = low;
    for (const PictureObject::Vertex& v : object.vertices())
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], v.position[k]);
        high[k] = std::max(high[k], v.position[k]);
      }
    return add_accessor({{"bufferView", 0},
                         {"byteOffset", sizeof(PictureObject::Vertex) * vertices_},
                         {"componentType", Gltf::kFloat},
                         {"count", object.vertices().size()},
                         {"type", "VEC3"},
                         {"min", low},
                         {"max", high}});
  }

  /// Returns the number of its node.
  std::size_t add_object(const PictureObject& object) {
    Json primitive;
    primitive["attributes"]["POSITION"] = add_positions(object);
    primitive["attributes"]["COLOR_0"] = add_accessor(
        {{"bufferView", 0},
         {"byteOffset", sizeof(PictureObject::Vertex) * vertices_ + offsetof(PictureObject::Vertex, colour)},
         {"componentType", Gltf::kUnsignedByte},
         {"normalized", true},
         {"count", object.vertices().size()},
         {"type", "VEC4"}});
    primitive["indices"] = add_accessor({{"bufferView", 1},
                                         {"byteOffset", sizeof(std::uint32_t) * indices_},
                                         {"componentType", Gltf::kUnsignedInt},
                                         {"count", object.indices().size()},
                                         {"type", "SCALAR"}});
    primitive["material"] = object.has_lines() ? kLineMaterial : kSurfaceMaterial;
    primitive["mode"] = object.has_lines() ? Gltf::kLines : Gltf::kTriangles;
    vertices_ += object.vertices().size();
    indices_ += object.indices().size();
    meshes_.push_back({{"name", object.name()}, {"primitives", Json::array({std::move(primitive)})}});
    nodes_.push_back({{"name", object.name()}, {"mesh", meshes_.size() - 1}});
    return nodes_.size() - 1;
  }

  const InspectionPicture& picture_;
  Json gltf_;
  Json nodes_ = Json::array();
  Json meshes_ = Json::array();
  Json accessors_ = Json::array();
  std::size_t vertices_ = 0;
  std::size_t indices_ = 0;
};

}  // namespace

void check_inspection_name(const std::filesystem::path& file) {
  format_by_extension(std::span<const PictureFormat>(kFormats), file);
}

void write_inspection(const InspectionPicture& picture, const Scene& scene,
                      const std::filesystem::path& file) {
  check_inspection_name(file);
  OutputFile output(file);
  begin_glb(Document(picture, scene).make(), "Look at a part of the room at a time.", output);
  const auto for_each_object = [&](const auto& visit) {
    for (const PictureSet& set : picture.sets)
      for (const PictureObject& object : set.objects) visit(object);
  };
  for_each_object([&](const PictureObject& object) {
    output.write(object.vertices().data(), sizeof(PictureObject::Vertex) * object.vertices().size());
  });
  for_each_object([&](const PictureObject& object) {
    output.write(object.indices().data(), sizeof(std::uint32_t) * object.indices().size());
  });
  output.commit();
}

}  // namespace reemit

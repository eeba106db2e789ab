#include "scenes/io/gltf/gltf_extensions.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <limits>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/io/common/json_cursor.h"
#include "scenes/io/gltf/gltf_draco.h"
#include "scenes/io/gltf/gltf_meshopt.h"
#include "scenes/model/error.h"

namespace reemit {
namespace {

/// A required extension outside these lists may change what the file means. Materials (KHR_materials_*) only
/// change how a surface looks; those that are not taken over are warned of.
constexpr std::array<std::string_view, 12> kReadExtensions{
    kDracoCompression, kMeshoptCompression, "KHR_mesh_quantization", "KHR_texture_transform",
    "KHR_lights_punctual", "KHR_node_visibility", "EXT_mesh_gpu_instancing", "EXT_texture_webp",
    // Images that count as white, with a warning.
    "KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds",
    // A coarser copy for what is far.
    "MSFT_lod"};

/// What moves, sounds, or says things about the file, but does not change the light of the room at rest.
constexpr std::array<std::string_view, 12> kHarmlessExtensions{
    "KHR_animation_pointer",   "KHR_xmp",
    "KHR_xmp_json_ld",         "KHR_audio_emitter",
    "KHR_node_hoverability",   "KHR_node_selectability",
    "KHR_interactivity",       "KHR_physics_rigid_bodies",
    "KHR_implicit_shapes",     "EXT_mesh_features",
    "EXT_structural_metadata", "EXT_instance_features"};

constexpr std::array<const char*, 3> kTextureExtensions{"EXT_texture_webp", "EXT_texture_avif",
                                                        "MSFT_texture_dds"};

bool is_supported(const std::string& extension) {
  return extension.starts_with("KHR_materials_") || std::ranges::count(kReadExtensions, extension) > 0 ||
         std::ranges::count(kHarmlessExtensions, extension) > 0;
}

std::string advice_for(const std::string& extension, const std::string& file) {
  if (extension != "KHR_meshopt_compression") return "Export without this extension.";
  return fmt::format(
      "The geometry is compressed in a way that is newer than EXT_meshopt_compression; decode it with: "
      "gltf-transform copy '{}' decoded.glb (npm install -g @gltf-transform/cli); it takes out who wrote the "
      "file: if that was Blender, see --emissive-units and --gltf-light-efficacy",
      file);
}

/// The value at a path of keys, or null.
nlohmann::json* find_path(nlohmann::json& value, std::initializer_list<const char*> keys) {
  nlohmann::json* at = &value;
  for (const char* key : keys) {
    if (!at->is_object()) return nullptr;
    const auto next = at->find(key);
    if (next == at->end()) return nullptr;
    at = &*next;
  }
  return at;
}

nlohmann::json::array_t* find_list(nlohmann::json& document, const char* key) {
  nlohmann::json* list = find_path(document, {key});
  return list && list->is_array() ? list->get_ptr<nlohmann::json::array_t*>() : nullptr;
}

bool empty_fallback_buffers(nlohmann::json& document) {
  bool changed = false;
  if (nlohmann::json::array_t* buffers = find_list(document, "buffers"))
    for (nlohmann::json& buffer : *buffers) {
      const nlohmann::json* fallback = find_path(buffer, {"extensions", kMeshoptCompression, "fallback"});
      if (!fallback || !fallback->is_boolean() || !fallback->get<bool>()) continue;
      buffer["uri"] = "data:application/octet-stream;base64,AA==";
      buffer["byteLength"] = 1;
      changed = true;
    }
  return changed;
}

/// A URI as the name of a file, without its escapes.
std::string unescaped(std::string_view uri) {
  std::string name;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned char byte = 0;
    const char* digits = uri.data() + i + 1;
    if (uri[i] == '%' && i + 2 < uri.size() &&
        std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
      name += static_cast<char>(byte);
      i += 2;
    } else {
      name += uri[i];
    }
  }
  return name;
}

/// Bytes of a data URI in base 64; 0 if it is none.
std::uintmax_t size_of_data(std::string_view uri) {
  constexpr std::string_view kMark = ";base64,";
  const std::size_t mark = uri.find(kMark);
  if (!uri.starts_with("data:") || mark == std::string_view::npos) return 0;
  uri.remove_prefix(mark + kMark.size());
  while (uri.ends_with('=')) uri.remove_suffix(1);
  return uri.size() * 3 / 4;
}

/// Files and data URIs may be longer than their buffers say; the parser wants them to be the same.
bool lengthen_buffers(nlohmann::json& document, const std::filesystem::path& folder) {
  bool changed = false;
  if (nlohmann::json::array_t* buffers = find_list(document, "buffers"))
    for (nlohmann::json& buffer : *buffers) {
      const nlohmann::json* uri = find_path(buffer, {"uri"});
      const nlohmann::json* length = find_path(buffer, {"byteLength"});
      if (!uri || !uri->is_string() || !length || !length->is_number_unsigned()) continue;
      const auto& text = uri->get_ref<const std::string&>();
      std::uintmax_t bytes = size_of_data(text);
      std::error_code error;
      if (!text.starts_with("data:")) bytes = std::filesystem::file_size(folder / unescaped(text), error);
      if (error || bytes <= length->get<std::uintmax_t>() || bytes > kLargestGltf) continue;
      buffer["byteLength"] = bytes;
      changed = true;
    }
  return changed;
}

bool rename_image_types(nlohmann::json& document) {
  constexpr std::array<std::string_view, 3> kTypes{"data:image/webp;", "data:image/avif;",
                                                   "data:image/ktx2;"};
  bool changed = false;
  if (nlohmann::json::array_t* images = find_list(document, "images"))
    for (nlohmann::json& image : *images) {
      nlohmann::json* uri = find_path(image, {"uri"});
      if (!uri || !uri->is_string()) continue;
      auto& text = uri->get_ref<std::string&>();
      for (const std::string_view type : kTypes) {
        if (!text.starts_with(type)) continue;
        text = "data:application/octet-stream;" + text.substr(type.size());
        changed = true;
      }
    }
  return changed;
}

bool take_out_draco_indices(nlohmann::json& document) {
  bool changed = false;
  const nlohmann::json::array_t* accessors = find_list(document, "accessors");
  const auto has_bytes = [&](const nlohmann::json& index) {
    const auto i = index.is_number_unsigned() ? index.get<std::size_t>() : 0;
    return accessors && index.is_number_unsigned() && i < accessors->size() &&
           (*accessors)[i].contains("bufferView");
  };
  if (nlohmann::json::array_t* meshes = find_list(document, "meshes"))
    for (nlohmann::json& mesh : *meshes)
      if (nlohmann::json::array_t* primitives = find_list(mesh, "primitives"))
        for (nlohmann::json& primitive : *primitives) {
          const nlohmann::json* indices = find_path(primitive, {"indices"});
          if (!indices || !find_path(primitive, {"extensions", kDracoCompression}) || has_bytes(*indices))
            continue;
          primitive.erase("indices");
          changed = true;
        }
  return changed;
}

}  // namespace

void check_gltf_extensions(const nlohmann::json& document, const std::string& file) {
  const auto list = document.find("extensionsRequired");
  if (list == document.end() || !list->is_array()) return;  // for the parser to refuse
  for (const nlohmann::json& value : *list) {
    if (!value.is_string()) continue;
    const auto name = value.get<std::string>();
    if (!is_supported(name))
      throw InputError(
          file, fmt::format("the file requires the glTF extension \"{}\", which is not supported", name),
          advice_for(name, file));
  }
}

std::optional<nlohmann::json> simplified_for_parser(const nlohmann::json& document,
                                                    const std::filesystem::path& folder) {
  nlohmann::json simplified = document;
  const bool emptied = empty_fallback_buffers(simplified);
  const bool lengthened = lengthen_buffers(simplified, folder);
  const bool renamed = rename_image_types(simplified);
  if (!take_out_draco_indices(simplified) && !emptied && !lengthened && !renamed) return std::nullopt;
  return simplified;
}

void take_extended_texture_sources(const nlohmann::json& document, GltfModel& gltf) {
  const auto textures = JsonCursor(document, gltf.file).find("textures");
  for (std::size_t i = 0; i < gltf.model.textures.size(); ++i) {
    tinygltf::Texture& texture = gltf.model.textures[i];
    if (texture.source >= 0) continue;
    const auto extensions = (*textures)[i].find("extensions");
    if (!extensions) continue;
    for (const char* name : kTextureExtensions)
      if (const auto extension = extensions->find(name))
        texture.source = extension->at("source").integer_in(0, std::numeric_limits<int>::max());
  }
}

}  // namespace reemit

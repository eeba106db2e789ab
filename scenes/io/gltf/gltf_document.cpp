#include "scenes/io/gltf/gltf_document.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/io/common/json_cursor.h"

namespace reemit {
namespace {

constexpr const char* kAdvice = "Check the file with the Khronos glTF validator, or export it anew.";

enum class Kind {
  kIndex,
  kIndices,
  kNumber,
  kNumbers,
  kText,
  kFlag,
  kComponentType,
  kElementType,
  kAlphaMode
};

/// What stands at `path`, keys apart by '/', in each entry of a list; rules of one list stand together.
struct Rule {
  const char* list;
  const char* path;
  Kind kind;
  bool required = false;
  std::size_t count = 0;  ///< Of kNumbers.
};

constexpr Rule kRules[] = {
    {"buffers", "byteLength", Kind::kIndex, true},
    {"buffers", "uri", Kind::kText},
    {"bufferViews", "buffer", Kind::kIndex, true},
    {"bufferViews", "byteLength", Kind::kIndex, true},
    {"bufferViews", "byteOffset", Kind::kIndex},
    {"bufferViews", "byteStride", Kind::kIndex},
    {"accessors", "bufferView", Kind::kIndex},
    {"accessors", "byteOffset", Kind::kIndex},
    {"accessors", "componentType", Kind::kComponentType, true},
    {"accessors", "count", Kind::kIndex, true},
    {"accessors", "type", Kind::kElementType, true},
    {"accessors", "normalized", Kind::kFlag},
    {"accessors", "sparse/count", Kind::kIndex},
    {"accessors", "sparse/indices/bufferView", Kind::kIndex},
    {"accessors", "sparse/indices/componentType", Kind::kComponentType},
    {"accessors", "sparse/values/bufferView", Kind::kIndex},
    {"nodes", "mesh", Kind::kIndex},
    {"nodes", "camera", Kind::kIndex},
    {"nodes", "children", Kind::kIndices},
    {"nodes", "translation", Kind::kNumbers, false, 3},
    {"nodes", "rotation", Kind::kNumbers, false, 4},
    {"nodes", "scale", Kind::kNumbers, false, 3},
    {"nodes", "matrix", Kind::kNumbers, false, 16},
    {"nodes", "extensions/KHR_lights_punctual/light", Kind::kIndex},
    {"scenes", "nodes", Kind::kIndices},
    {"materials", "emissiveFactor", Kind::kNumbers, false, 3},
    {"materials", "doubleSided", Kind::kFlag},
    {"materials", "alphaMode", Kind::kAlphaMode},
    {"materials", "alphaCutoff", Kind::kNumber},
    {"materials", "extensions/KHR_materials_emissive_strength/emissiveStrength", Kind::kNumber},
    {"materials", "extensions/KHR_materials_ior/ior", Kind::kNumber},
    {"materials", "pbrMetallicRoughness/baseColorFactor", Kind::kNumbers, false, 4},
    {"materials", "pbrMetallicRoughness/metallicFactor", Kind::kNumber},
    {"materials", "pbrMetallicRoughness/roughnessFactor", Kind::kNumber},
    {"materials", "pbrMetallicRoughness/baseColorTexture/index", Kind::kIndex},
    {"materials", "emissiveTexture/index", Kind::kIndex},
    {"textures", "source", Kind::kIndex},
    {"images", "uri", Kind::kText},
    {"images", "bufferView", Kind::kIndex},
    {"cameras", "type", Kind::kText, true},
    {"cameras", "perspective/yfov", Kind::kNumber},
    {"cameras", "perspective/aspectRatio", Kind::kNumber},
};

constexpr Rule kPrimitiveRules[] = {
    {"primitives", "indices", Kind::kIndex},
    {"primitives", "material", Kind::kIndex},
    {"primitives", "mode", Kind::kIndex},
};

constexpr Rule kLightRules[] = {
    {"lights", "type", Kind::kText, true},
    {"lights", "intensity", Kind::kNumber},
    {"lights", "color", Kind::kNumbers, false, 3},
    {"lights", "spot/innerConeAngle", Kind::kNumber},
    {"lights", "spot/outerConeAngle", Kind::kNumber},
};

/// What may be left out may also be -1, as some programs write it for none.
void check_index(const JsonCursor& at, bool required = false) {
  constexpr double kMost = 1LL << 53;
  const double value = at.number_in(required ? 0 : -1, kMost);
  if (value != std::floor(value)) at.fail(fmt::format("{} is not a whole number", value), kAdvice);
}

void check_value(const JsonCursor& at, const Rule& rule) {
  constexpr int kFirstType = 5120, kLastType = 5126;  // BYTE ... FLOAT
  switch (rule.kind) {
    case Kind::kIndex:
      return check_index(at, rule.required);
    case Kind::kIndices:
      for (std::size_t i = 0; i < at.size(); ++i) check_index(at[i]);
      return;
    case Kind::kNumber:
      at.number();
      return;
    case Kind::kNumbers:
      if (const std::size_t count = at.numbers().size(); count != rule.count)
        at.fail(fmt::format("there are {} numbers in place of {}", count, rule.count), kAdvice);
      return;
    case Kind::kText:
      at.string();
      return;
    case Kind::kFlag:
      at.boolean();
      return;
    case Kind::kElementType:
      at.choice({"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"});
      return;
    case Kind::kAlphaMode:
      at.choice({"OPAQUE", "MASK", "BLEND"});
      return;
    case Kind::kComponentType:
      at.number_in(kFirstType, kLastType);
  }
}

void check_path(const JsonCursor& entry, const Rule& rule) {
  JsonCursor at = entry;
  for (std::string_view rest = rule.path; !rest.empty();) {
    const std::string key(rest.substr(0, rest.find('/')));
    rest.remove_prefix(std::min(key.size() + 1, rest.size()));
    const auto next = at.find(key.c_str());
    if (!next && rule.required) at.fail(fmt::format("the key \"{}\" is missing", key), kAdvice);
    if (!next) return;
    at = *next;
  }
  check_value(at, rule);
}

void check_entries(const JsonCursor& list, std::span<const Rule> rules) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    list[i].expect_object();
    for (const Rule& rule : rules) check_path(list[i], rule);
  }
}

void check_meshes(const JsonCursor& meshes) {
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const auto primitives = meshes[i].find("primitives");
    if (!primitives) meshes[i].fail("the key \"primitives\" is missing", kAdvice);
    check_entries(*primitives, kPrimitiveRules);
    for (std::size_t k = 0; k < primitives->size(); ++k) {
      const auto attributes = (*primitives)[k].find("attributes");
      if (!attributes) (*primitives)[k].fail("the key \"attributes\" is missing", kAdvice);
      for (const auto& [name, accessor] : attributes->members()) check_index(accessor, true);
    }
  }
}

}  // namespace

void check_gltf_document(const nlohmann::json& document, const std::string& file) {
  const JsonCursor root(document, file);
  for (std::span<const Rule> rest = kRules; !rest.empty();) {
    const std::string_view name = rest.front().list;
    const auto end = std::find_if(rest.begin(), rest.end(), [&](const Rule& r) { return r.list != name; });
    const auto of_list = rest.first(static_cast<std::size_t>(end - rest.begin()));
    if (const auto list = root.find(of_list.front().list)) check_entries(*list, of_list);
    rest = rest.subspan(of_list.size());
  }
  if (const auto meshes = root.find("meshes")) check_meshes(*meshes);
  if (const auto extensions = root.find("extensions"))
    if (const auto punctual = extensions->find("KHR_lights_punctual"))
      if (const auto lights = punctual->find("lights")) check_entries(*lights, kLightRules);
}

}  // namespace reemit

#include "scenes/io/native_reader.h"
#include "scenes/io/gltf_reader.h"
#include "scenes/io/obj_reader.h"
namespace reemit {
Scene read_native_scene(const std::filesystem::path&, const ReadOptions&) { return {}; }
Scene read_gltf_scene(const std::filesystem::path&, const ReadOptions&) { return {}; }
Scene read_obj_scene(const std::filesystem::path&, const ReadOptions&) { return {}; }
}

#include "scenes/io/scene_reader.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include "scenes/io/gltf_reader.h"
#include "scenes/io/mgf_reader.h"
#include "scenes/io/native_reader.h"
#include "scenes/io/obj_reader.h"
#include "scenes/io/text_file.h"
#include "scenes/model/error.h"

namespace reemit {
namespace {

struct Reader {
  const char* extension;
  Scene (*read)(const std::filesystem::path&, const ReadOptions&);
};

constexpr std::array kReaders = {
    Reader{".json", read_native_scene}, Reader{".obj", read_obj_scene}, Reader{".gltf", read_gltf_scene},
    Reader{".glb", read_gltf_scene},    Reader{".mgf", read_mgf_scene},
};

const Reader& reader_for(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const Reader& reader : kReaders)
    if (extension == reader.extension) return reader;
  std::string known;
  for (const Reader& reader : kReaders) known += fmt::format(" {}", reader.extension);
  throw InputError(file.string(),
                   extension.empty() ? "the file name has no extension, so its format is not known"
                                     : fmt::format("'{}' is not a known room format", extension),
                   "Known extensions:" + known);
}

}  // namespace

Scene read_scene(const std::filesystem::path& file, const ReadOptions& options) {
  check_readable_file(file);
  Scene scene = reader_for(file).read(file, options);
  if (options.force_two_sided)
    for (Material& material : scene.materials) material.two_sided = true;
  finish_scene(scene);
  return scene;
}

}  // namespace reemit

#include "scenes/io/scene_reader.h"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "scenes/io/common/files_read.h"
#include "scenes/io/common/glass_bodies.h"
#include "scenes/io/common/scene_bands.h"
#include "scenes/io/common/text_file.h"
#include "scenes/io/common/text_parse.h"
#include "scenes/io/common/up_direction.h"
#include "scenes/io/gltf/gltf_reader.h"
#include "scenes/io/mgf/mgf_reader.h"
#include "scenes/io/native/native_reader.h"
#include "scenes/io/native/sky_option.h"
#include "scenes/io/obj/obj_reader.h"
#include "scenes/model/error.h"
#include "scenes/model/measures.h"
#include "scenes/model/scene_checks.h"

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
  const std::string extension = lower_case_extension(file);
  for (const Reader& reader : kReaders)
    if (extension == reader.extension) return reader;
  std::string known;
  for (const Reader& reader : kReaders) known += fmt::format(" {}", reader.extension);
  if (extension == ".ply") known += "; a PLY mesh is an object of a JSON room, by its \"file\"";
  if (extension == ".ies" || extension == ".ldt")
    known += "; a measured luminaire is a light of a JSON room, by its \"file\" (\"type\": \"ies\")";
  throw InputError(file.string(),
                   extension.empty() ? "the file name has no extension, so its format is not known"
                                     : fmt::format("'{}' is not a known room format", extension),
                   "Known extensions:" + known);
}

/// Whether `other` may be one room with `first`.
void check_joins(const std::filesystem::path& first, const std::filesystem::path& other) {
  for (const std::filesystem::path& file : {first, other})
    if (reader_for(file).read != read_mgf_scene)
      throw InputError(
          file.string(),
          fmt::format("{} and {} cannot be read as one room: only MGF files can", first.string(),
                      other.string()),
          "Put OBJ, PLY and glTF files together in a JSON room, each as an object with a \"file\".");
}

/// Says which way is up for the sky, if the room does not.
void settle_sky(Scene& scene) {
  Sky& sky = *scene.sky;
  const bool is_given = !sky.up.isZero();
  place_sky(sky, up_direction(scene));
  const auto text = [](const Vec3& v) {
    return fmt::format("({:.3g}, {:.3g}, {:.3g})", v.x(), v.y(), v.z());
  };
  std::string note = fmt::format("sky: {}; up is {}{}, north {}", sky.description, text(sky.up),
                                 is_given ? "" : " by the format or the cameras", text(sky.north));
  if (sky.sun)
    note += fmt::format("; the sun stands {:.2f} degrees high, {:.2f} from north towards east",
                        sky.sun->altitude / kRadiansPerDegree, sky.sun->azimuth / kRadiansPerDegree);
  scene.notes.push_back(std::move(note));
}

}  // namespace

Scene read_scene(const std::filesystem::path& file, const ReadOptions& options) {
  return read_scene(std::span(&file, 1), options);
}

Scene read_scene(std::span<const std::filesystem::path> files, const ReadOptions& options) {
  const FilesRead read;
  for (const std::filesystem::path& file : files) check_readable_file(file);
  for (const std::filesystem::path& file : files.subspan(1)) check_joins(files.front(), file);
  Scene scene =
      files.size() > 1 ? read_mgf_files(files) : reader_for(files.front()).read(files.front(), options);
  if (options.force_two_sided)
    for (Material& material : scene.materials) material.two_sided = true;
  settle_glass_bodies(scene);
  if (options.bands.given()) {
    check_materials(scene);
    check_lights(scene);
    give_bands(scene, options.bands);
  }
  if (!options.sky.empty() || !options.sun.empty()) add_sky(options.sky, options.sun, scene);
  finish_scene(scene);
  if (scene.sky) settle_sky(scene);
  scene.files = read.list();
  return scene;
}

}  // namespace reemit

#include "scenes/io/native/native_reader.h"

#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/io/common/json_cursor.h"
#include "scenes/io/common/spectral_bands.h"
#include "scenes/io/common/text_file.h"
#include "scenes/io/native/native_materials.h"
#include "scenes/io/native/native_objects.h"
#include "scenes/io/native/native_sky.h"
#include "scenes/io/native/native_view.h"

namespace reemit {

namespace {

constexpr int kFormatVersion = 1;

BandSet read_bands(const JsonCursor& at) {
  if (at.is_string()) return at.choice({"grey", "rgb"}) == "grey" ? BandSet::grey() : BandSet::rgb();
  at.expect_object({"wavelengths_nm"});
  const JsonCursor listed = at.at("wavelengths_nm");
  listed.expect_array(1, kMostBands);
  for (std::size_t i = 0; i < listed.size(); ++i) {
    listed[i].number_in(1, 1e6);
    if (i > 0 && listed[i].number() <= listed[i - 1].number()) {
      listed[i].fail("the wavelengths do not increase", "Sort them and name each once.");
    }
  }
  return BandSet::spectral(listed.numbers());
}

void read_format(const JsonCursor& room) {
  room.expect_object({"format", "version", "name", "bands", "unit", "materials", "groups", "objects",
                      "lights", "cameras", "sky"});
  const auto format = room.find("format");
  if (!format || !format->is_string() || format->string() != "reemit-room") {
    room.fail("the file does not say that it is a room",
              "Start it with \"format\": \"reemit-room\", \"version\": 1.");
  }
  const JsonCursor version = room.at("version");
  const int number = version.integer_in(0, 1'000'000);
  if (number != kFormatVersion) {
    version.fail(fmt::format("version {} of the format is not known", number),
                 fmt::format("This program reads version {}.", kFormatVersion));
  }
}

void read_room(const JsonCursor& room, const std::filesystem::path& folder, const ReadOptions& options,
               Scene& scene) {
  read_format(room);
  if (const auto name = room.find("name")) scene.name = name->string();
  if (const auto bands = room.find("bands")) scene.bands = read_bands(*bands);
  const auto given_unit = room.find("unit");
  const double unit = given_unit ? read_unit(*given_unit) : 1;
  if (unit != 1) scene.notes.push_back(fmt::format("lengths in the file are in {}", given_unit->string()));
  NativeMaterials materials(room.at("materials"), folder, scene);
  if (const auto objects = room.find("objects")) {
    NativeObjects(folder, options, unit, room.find("groups"), materials, scene).read(*objects);
  }
  materials.share_total_powers(scene);
  if (const auto sky = room.find("sky")) read_sky(*sky, folder, scene);
  if (const auto cameras = room.find("cameras")) read_cameras(*cameras, unit, scene);
  // After what says which way is up.
  if (const auto lights = room.find("lights")) read_lights(*lights, unit, folder, scene);
}

}  // namespace

Scene read_native_scene(const std::filesystem::path& file, const ReadOptions& options) {
  const std::string source = file.string();
  const nlohmann::json document = parse_json(load_file(file), source);
  Scene scene;
  scene.source = source;
  scene.name = file.stem().string();
  read_room(JsonCursor(document, source), file.parent_path(), options, scene);
  return scene;
}

}  // namespace reemit

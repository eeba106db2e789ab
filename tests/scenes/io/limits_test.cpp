// Numbers beyond what a room may hold are refused where they stand, and those just inside are not.
#include "scenes/model/limits.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scenes/io/scene_reader.h"
#include "tests/scenes/io/expect_input_error.h"
#include "tests/scenes/io/gltf_building.h"
#include "tests/support/small_rooms.h"
#include "tests/support/temp_folder.h"

namespace reemit {
namespace {

using test::expect_input_error;
using test::replaced;
using test::TempFolder;

/// The small JSON room with `from` replaced, and with members such as lights.
std::string json_room(const std::string& from, const std::string& to, const std::string& members = "") {
  return replaced(replaced(test::small_json_room(), from, to), "\"cameras\"", members + "\"cameras\"");
}

std::string with_light(const std::string& fields) {
  return json_room("", "", R"("lights": [{"name": "far", )" + fields + "}], ");
}

void refuse(const std::string& name, const std::string& text, std::initializer_list<const char*> parts) {
  const TempFolder folder;
  folder.write("room.mtl", test::small_obj_materials());
  const auto file = folder.write(name, text);
  SCOPED_TRACE(*parts.begin());
  expect_input_error([&] { read_scene(file); }, parts);
}

void accept(const std::string& name, const std::string& text) {
  const TempFolder folder;
  EXPECT_NO_THROW(read_scene(folder.write(name, text)));
}

TEST(Limits, PlacesInJsonAreNamedByTheirPointer) {
  refuse("room.json", json_room("[0.4, 0.98, 0.4]", "[0.4, 1e19, 0.4]"),
         {"room.json#/objects/1/quad/corner/1: 1e+19", "10000000000"});
  refuse("room.json", json_room("[1, 1, 1]", "[1, 1, 4e30]"), {"#/objects/0/box/max/2"});
  refuse("room.json", json_room("[0.5, 0.5, 0.05]", "[-1e20, 0.5, 0.05]"), {"#/cameras/0/eye/0"});
  refuse("room.json", with_light(R"("type": "point", "position": [0, 1e19, 0], "intensity": 1)"),
         {"#/lights/0/position/1"});
  refuse("room.json",
         json_room(R"("quad": {"corner": [0.4, 0.98, 0.4], "u": [0.2, 0, 0], "v": [0, 0, 0.2]})",
                   R"("sphere": {"center": [0, 0, 0], "radius": 1e300})"),
         {"#/objects/1/sphere/radius"});
  // Only a transform makes it large.
  refuse("room.json",
         json_room(R"("material": "lamp", )", R"("material": "lamp", "transform": {"scale": 1e12}, )"),
         {"surface 'lamp'", "farther out than 1e+10 m"});
}

TEST(Limits, LightsAndCamerasStayWithinReachOfTheRoom) {
  const double reach = limits::kFarthestInRooms;  // the room measures 1 m
  const auto light = [](double y) {
    return with_light(fmt::format(R"("type": "point", "position": [0, {}, 0], "intensity": 1)", y));
  };
  refuse("room.json", light(1.1 * reach), {"light 'far'", "100000 times its size of 1 m", "directional"});
  accept("room.json", light(0.9 * reach));
  const auto camera = [](double x) {
    return json_room("[0.5, 0.5, 0.05]", fmt::format("[{}, 0.5, 0.05]", x));
  };
  refuse("room.json", camera(1.1 * reach), {"camera 'front'", "100000 times"});
  accept("room.json", camera(0.9 * reach));
}

TEST(Limits, PowersInJsonAreNamedByTheirPointer) {
  for (const char* power : {"1e300", "1e-300", "2e18", "1e-17"}) {
    const std::string number = power;
    refuse("room.json", json_room("[30, 25, 20]", number), {"#/materials/lamp/exitance", "radiance"});
    refuse("room.json", json_room("\"exitance\": [30, 25, 20]", "\"total_power\": " + number),
           {"#/materials/lamp/total_power", "radiance"});
    refuse("room.json", json_room("\"exitance\": [30, 25, 20]", "\"luminance_cd_m2\": " + number),
           {"#/materials/lamp/luminance_cd_m2"});
    refuse("room.json", with_light(R"("type": "point", "position": [0, 0, 0], "power": )" + number),
           {"#/lights/0/power", "between 1e-15 and 1e+15"});
    refuse("room.json",
           with_light(R"("type": "directional", "direction": [0, -1, 0], "irradiance": )" + number),
           {"#/lights/0/irradiance"});
  }
  for (const char* power : {"1e15", "1e-14"}) accept("room.json", json_room("[30, 25, 20]", power));
}

TEST(Limits, NumbersInTextFilesAreNamedByTheirLine) {
  refuse("room.obj", replaced(test::small_obj_room(), "v 1 1 1", "v 1 1e300 1"), {"room.obj:8: "});
  refuse("room.mgf", replaced(test::small_mgf_room(), "p 1 1 1", "p 1 -1e+308 1"),
         {"room.mgf:21: ", "farther out"});
  refuse("room.mgf", "m w =\n\trd 0.5\nv a =\n\tp 0 0 0\nm w\nxf -s 1e9\nsph a 1e3\nxf\n",
         {"room.mgf:7: ", "farther out"});
}

TEST(Limits, StrengthsInTextFilesAreNamedByTheirLine) {
  for (const char* strength : {"1e300", "1e-300", "1e19", "1e-13"}) {
    refuse("room.mgf", replaced(test::small_mgf_room(), "ed 100", fmt::format("ed {}", strength)),
           {"room.mgf:7: material 'lamp' with ed 1e", "radiance", "between 1e-15 and 1e+15"});
  }
  // Materials may come by a template, from a library that is included.
  const TempFolder folder;
  folder.write("library.mgf", "m bright =\n\tsides 1\n\ted 1e19\n");
  const std::string room =
      "i library.mgf\nm lamp = bright\n\trd .5\nv a =\n\tp 0 0 0\nv b =\n\tp 1 0 0\nv c =\n\tp 0 1 0\n";
  const auto file = folder.write("room.mgf", room + "f a b c\n");
  expect_input_error([&] { read_scene(file); }, {"library.mgf:3: material 'lamp' with ed 1e+19"});
  // What nobody uses may be anything.
  EXPECT_NO_THROW(read_scene(folder.write("room.mgf", room + "m\n\trd .5\nf a b c\n")));

  const auto refuse_mtl = [&](const char* from, const char* to, std::initializer_list<const char*> parts) {
    folder.write("room.mtl", replaced(test::small_obj_materials(), from, to));
    const auto obj = folder.write("room.obj", test::small_obj_room());
    expect_input_error([&] { read_scene(obj); }, parts);
  };
  for (const char* strength : {"Ke 1e300 0 0", "Ke 0 2e15 0", "Ke 1e-300 1e-16 0"})
    refuse_mtl("Ke 10 10 10", strength, {"room.mtl:5: ", "radiance Ke", "between 1e-15 and 1e+15"});
}

TEST(Limits, MeasuredLuminairesOfMgfAreNamedByTheirLine) {
  const TempFolder folder;
  folder.write("lamp.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 90\n0\n100 100\n");
  const auto refuse_ies = [&](const std::string& line, std::initializer_list<const char*> parts) {
    const auto file = folder.write("room.mgf", test::small_mgf_room() + line);
    expect_input_error([&] { read_scene(file); }, parts);
  };
  const auto lines = std::ranges::count(test::small_mgf_room(), '\n');
  const std::string place = fmt::format("room.mgf:{}: ", lines + 1);
  refuse_ies("ies lamp.ies -m 1e20\n", {place.c_str(), "greatest intensity", "1e+15"});
  refuse_ies("ies lamp.ies -t 1e19 0 0\n", {place.c_str(), "farther out"});
}

TEST(Limits, PlacesInGltfAreNamedByTheirPointer) {
  refuse("room.glb", test::small_glb_room(1e30F), {"room.glb#/nodes/0: ", "farther out"});
  const auto gltf = [](auto change) {
    test::GltfBuilder builder;
    builder.square();
    change(builder);
    return builder;
  };
  const auto emissive = [&](const nlohmann::json& factor, double strength) {
    return gltf([&](test::GltfBuilder& g) {
      g.json["materials"][0]["emissiveFactor"] = factor;
      if (strength != 1)
        g.json["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] =
            strength;
    });
  };
  test::expect_gltf_refused(emissive({0, 1e20, 0}, 1),
                            {"room.gltf#/materials/0/emissiveFactor: ", "radiance", "1e+15"});
  test::expect_gltf_refused(
      emissive({0, 1, 0}, 1e20),
      {"#/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength: ", "radiance"});
  test::expect_gltf_refused(emissive({0, 1e-30, 0}, 1), {"#/materials/0/emissiveFactor: "});
  for (const char* type : {"point", "directional", "spot"}) {
    test::expect_gltf_refused(gltf([&](test::GltfBuilder& g) {
                                nlohmann::json light = {{"type", type}, {"intensity", 1e25}};
                                light["spot"] = {{"outerConeAngle", 0.5}};
                                g.json["extensions"]["KHR_lights_punctual"]["lights"] =
                                    nlohmann::json::array({light});
                                g.node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
                              }),
                              {"room.gltf#/extensions/KHR_lights_punctual/lights/0/intensity: ", "1e+15"});
  }
  test::expect_gltf_refused(
      gltf([](test::GltfBuilder& g) {
        g.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}};
        g.node({{"camera", 0}, {"translation", {0, 1e20, 0}}});
      }),
      {"#/nodes/1: ", "farther out"});
}

TEST(Limits, OpeningsOfMeasuredLuminairesAreNamedByTheirLine) {
  const TempFolder folder;
  folder.write("lamp.ies",
               "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0.5 1e30 0\n1 1 0\n0 90\n0\n100 100\n");
  const auto file =
      folder.write("room.json", with_light(R"("type": "ies", "file": "lamp.ies", "position": [0, 0, 0])"));
  expect_input_error([&] { read_scene(file); }, {"#/lights/0/file", "lamp.ies:3: ", "1e+30"});
}

TEST(Limits, RoomsOfNoSizeAreRefused) {
  refuse("room.obj", "mtllib room.mtl\nv 0 0 0\nv 1e-8 0 0\nv 0 1e-8 0\nusemtl lamp\nf 1 2 3\n",
         {"longest side is 1e-08 m"});
}

}  // namespace
}  // namespace reemit

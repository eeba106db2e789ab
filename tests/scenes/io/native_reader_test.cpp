#include "scenes/io/native/native_reader.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/io/common/surface_geometry.h"
#include "tests/scenes/io/native_reading.h"

namespace reemit {
namespace {

using test::expect_input_error;
using test::expect_refused;
using test::read_text;
using test::room;
using test::TempFolder;

constexpr double kPi = std::numbers::pi;

Material only_material(const std::string& fields, const std::string& bands = R"("grey")") {
  return read_text(room(R"("bands": )" + bands + R"(, "materials": {"m": {)" + fields + R"(}})"))
      .materials.at(0);
}

const std::string kTwoBands = R"({"wavelengths_nm": [500, 520]})";

TEST(NativeReader, DemandsFormatAndVersion) {
  expect_refused(R"({"version": 1, "materials": {}})", {"room.json#", "reemit-room"});
  expect_refused(R"({"format": "reemit-room", "version": 2, "materials": {}})", {"#/version", "version 2"});
  expect_refused(R"([])", {"expected an object"});
  expect_refused(room(R"("materials": {}, "objcts": [])"), {"#/objcts", "Did you mean \"objects\"?"});
  EXPECT_EQ(read_text(room(R"("materials": {}, "name": "hall")")).name, "hall");
}

TEST(NativeMaterials, Defaults) {
  const Material material = only_material("");
  EXPECT_EQ(material.name, "m");
  EXPECT_EQ(material.reflectance[0], 0);
  EXPECT_FALSE(material.emits());
  EXPECT_TRUE(material.two_sided);
  EXPECT_FALSE(material.emits_both_sides);
}

TEST(NativeMaterials, ReflectanceInAllForms) {
  EXPECT_TRUE((only_material(R"("reflectance": 0.3)", R"("rgb")").reflectance == 0.3).all());
  const Spectrum rgb = only_material(R"("reflectance": [0.1, 0.2, 0.3])", R"("rgb")").reflectance;
  EXPECT_EQ(rgb[2], 0.3);
  const Spectrum srgb = only_material(R"("reflectance": {"srgb": "#ff8000"})", R"("rgb")").reflectance;
  EXPECT_NEAR(srgb[0], 1, 1e-12);
  EXPECT_NEAR(srgb[1], 0.2158605, 1e-6);  // IEC 61966-2-1 at 128/255.
  EXPECT_EQ(srgb[2], 0);
  const double grey = only_material(R"("reflectance": {"srgb": "#ff8000"})").reflectance[0];
  EXPECT_NEAR(grey, 0.2126 + 0.7152 * 0.2158605, 1e-6);
}

TEST(NativeMaterials, SampledReflectanceIsAveragedOverEachBand) {
  // Bands 490-510 and 510-530; the samples rise from 0.2 at 495 to 0.6 at 535 and are constant outside.
  const Spectrum reflectance =
      only_material(R"("reflectance": {"nm": [495, 535], "value": [0.2, 0.6]})", kTwoBands).reflectance;
  EXPECT_NEAR(reflectance[0], (5 * 0.2 + 15 * 0.275) / 20, 1e-12);
  EXPECT_NEAR(reflectance[1], 0.45, 1e-12);
}

TEST(NativeMaterials, SampledEmissionIsIntegratedOverEachBand) {
  const Spectrum radiance =
      only_material(R"("radiance": {"nm": [495, 535], "value": [0.2, 0.6]})", kTwoBands).emitted_radiance;
  EXPECT_NEAR(radiance[0], 15 * 0.275, 1e-12);
  EXPECT_NEAR(radiance[1], 20 * 0.45, 1e-12);
}

TEST(NativeMaterials, EmissionInAllQuantities) {
  EXPECT_NEAR(only_material(R"("radiance": 3)").emitted_radiance[0], 3, 1e-12);
  EXPECT_NEAR(only_material(R"("exitance": 3)").emitted_radiance[0], 3 / kPi, 1e-12);
  EXPECT_NEAR(only_material(R"("luminance_cd_m2": 358)").emitted_radiance[0], 2, 1e-12);
  EXPECT_NEAR(only_material(R"("exitance_lm_m2": 358)").emitted_radiance[0], 2 / kPi, 1e-12);
  const BandSet bands = BandSet::rgb();
  const Spectrum warm =
      only_material(R"("luminance_cd_m2": 1000, "emission_color": [1, 0.8, 0.5])", R"("rgb")")
          .emitted_radiance;
  EXPECT_NEAR((warm * bands.efficacy_lm_per_w()).sum(), 1000, 1e-9);
  EXPECT_NEAR(warm[2] / warm[0], 0.5, 1e-12);
}

TEST(NativeMaterials, TotalPowerIsSharedByArea) {
  const auto radiance = [](const std::string& emission) {
    return read_text(room(R"("materials": {"lamp": {)" + emission + R"(}}, "objects": [
        {"material": "lamp", "quad": {"corner": [0,0,0], "u": [1,0,0], "v": [0,1,0]}, "array": {"count": 3, "step": [5,0,0]}},
        {"material": "lamp", "quad": {"corner": [0,0,9], "u": [1,0,0], "v": [0,2,0]}}])"))
        .materials[0]
        .emitted_radiance[0];
  };
  EXPECT_NEAR(radiance(R"("total_power": 10)"), 10 / (kPi * 5), 1e-12);
  EXPECT_NEAR(radiance(R"("total_power": 10, "emission_sides": "both")"), 10 / (kPi * 10), 1e-12);
  EXPECT_NEAR(radiance(R"("total_flux_lm": 1790)"), 10 / (kPi * 5), 1e-12);
  // A lamp taken out of the room, whose material is still there.
  const Scene unused = read_text(room(R"("materials": {"lamp": {"total_power": 5}})"));
  EXPECT_EQ(unused.materials[0].emitted_radiance[0], 0);
  EXPECT_THAT(unused.warnings,
              testing::Contains(testing::AllOf(testing::HasSubstr("room.json#/materials/lamp/total_power"),
                                               testing::HasSubstr("no surface"))));
}

TEST(NativeMaterials, RefusesWrongValues) {
  const auto refused = [](const std::string& fields, std::initializer_list<const char*> parts) {
    expect_refused(room(R"("bands": "rgb", "materials": {"m": {)" + fields + "}}"), parts);
  };
  refused(R"("reflectance": 1.2)", {"#/materials/m/reflectance", "1.2 is out of range"});
  refused(R"("reflectance": [0.1, -0.2, 0.3])", {"#/materials/m/reflectance/1"});
  refused(R"("reflectance": [0.1, 0.2])", {"2 values, expected 3"});
  refused(R"("reflectance": {"nm": [400, 500], "value": [1, 1]})", {"spectral bands"});
  refused(R"("reflectance": {"srgb": "red"})", {"#rrggbb"});
  refused(R"("radiance": -1)", {"#/materials/m/radiance"});
  refused(R"("radiance": 1, "exitance": 1)", {"already given by \"radiance\""});
  refused(R"("emission_color": [1, 1, 1])", {"without a photometric emission"});
  refused(R"("sides": "front", "emission_sides": "both")", {"cannot emit from its back"});
  refused(R"("luminance_cd_m2": 5, "emission_color": [0, 0, 0])", {"no luminance"});
  refused(R"("colour": 1)", {"unknown key \"colour\""});
}

TEST(NativeBands, Forms) {
  EXPECT_EQ(read_text(room(R"("materials": {})")).bands, BandSet::grey());
  EXPECT_EQ(read_text(room(R"("bands": "rgb", "materials": {})")).bands, BandSet::rgb());
  EXPECT_EQ(read_text(room(R"("bands": )" + kTwoBands + R"(, "materials": {})")).bands,
            BandSet::spectral({500, 520}));
  expect_refused(room(R"("bands": {"wavelengths_nm": [500, 500]}, "materials": {})"),
                 {"#/bands/wavelengths_nm/1"});
  expect_refused(room(R"("bands": "RGB", "materials": {})"), {"Did you mean \"rgb\"?"});
}

TEST(NativeLights, AllTypes) {
  const Scene scene = read_text(room(R"("materials": {}, "lights": [
      {"type": "point", "name": "p", "position": [1, 2, 3], "flux_lm": 2249.3803},
      {"type": "spot", "position": [0, 3, 0], "look_at": [0, 0, 0], "outer_angle_deg": 30, "inner_angle_deg": 10, "intensity_cd": 358},
      {"type": "directional", "direction": [0, -2, 0], "irradiance": 4},
      {"type": "point", "position": [0, 0, 0], "power": 12.566370614359172}])"));
  ASSERT_EQ(scene.lights.size(), 4u);
  const auto& point = std::get<PointLight>(scene.lights[0]);
  EXPECT_EQ(point.position, Vec3(1, 2, 3));
  EXPECT_NEAR(point.intensity[0], 1, 1e-6);  // 4 pi 179 lm.
  const auto& spot = std::get<SpotLight>(scene.lights[1]);
  EXPECT_EQ(spot.direction, Vec3(0, -1, 0));
  EXPECT_NEAR(spot.outer_angle, kPi / 6, 1e-12);
  EXPECT_NEAR(spot.intensity[0], 2, 1e-12);
  const auto& sun = std::get<DirectionalLight>(scene.lights[2]);
  EXPECT_EQ(sun.direction, Vec3(0, -1, 0));
  EXPECT_EQ(sun.irradiance[0], 4);
  EXPECT_NEAR(std::get<PointLight>(scene.lights[3]).intensity[0], 1, 1e-12);
}

TEST(NativeLights, RefusesWrongValues) {
  const auto refused = [](const std::string& light, std::initializer_list<const char*> parts) {
    expect_refused(room(R"("materials": {}, "lights": [{)" + light + "}]"), parts);
  };
  refused(R"("type": "pont", "position": [0,0,0], "intensity": 1)",
          {"#/lights/0/type", "Did you mean \"point\"?"});
  refused(R"("type": "point", "position": [0,0,0])", {"no strength"});
  refused(R"("type": "point", "position": [0,0,0], "intensity": 1, "power": 1)", {"given already"});
  refused(R"("type": "point", "position": [0,0,0], "intensity": 1, "direction": [0,0,1])", {"unknown key"});
  refused(R"("type": "spot", "position": [0,0,0], "direction": [0,0,0], "intensity": 1)", {"no length"});
  refused(R"("type": "spot", "position": [0,0,0], "intensity": 1)",
          {"#/lights/0", "no direction", "\"direction\"", "\"look_at\""});
  refused(
      R"("type": "spot", "position": [0,0,0], "direction": [0,0,1], "intensity": 1, "outer_angle_deg": 95)",
      {"outer_angle_deg"});
  refused(
      R"("type": "spot", "position": [0,0,0], "direction": [0,0,1], "intensity": 1, "inner_angle_deg": 50)",
      {"not smaller"});
}

TEST(NativeLights, ALightOrEmissionOfNoPowerIsRefused) {
  const auto refused = [](const std::string& light, std::initializer_list<const char*> parts) {
    expect_refused(room(R"("materials": {}, "lights": [{)" + light + "}]"), parts);
  };
  refused(R"("type": "point", "position": [0,0,0], "intensity": 0)",
          {"#/lights/0/intensity", "emits nothing"});
  refused(R"("type": "point", "position": [0,0,0], "flux_lm": 0)", {"#/lights/0/flux_lm", "emits nothing"});
  refused(R"("type": "spot", "position": [0,0,0], "direction": [0,0,1], "intensity_cd": 0)",
          {"#/lights/0/intensity_cd", "emits nothing"});
  refused(R"("type": "directional", "direction": [0,0,1], "illuminance_lx": 0)",
          {"#/lights/0/illuminance_lx", "emits nothing"});
  refused(R"("type": "point", "position": [0,0,0], "intensity": -1)", {"#/lights/0/intensity"});
  refused(R"("type": "point", "position": [0,0,0], "intensity_cd": -5)",
          {"#/lights/0/intensity_cd", "-5 is out of range", "It must be above 0."});
  for (const char* key :
       {"radiance", "exitance", "total_power", "luminance_cd_m2", "exitance_lm_m2", "total_flux_lm"})
    expect_refused(room(std::string(R"("materials": {"lamp": {")") + key + R"(": 0}})"),
                   {"#/materials/lamp/", key, "emits nothing"});
  expect_refused(room(R"("bands": "rgb", "materials": {"lamp": {"radiance": [0, 0, 0]}})"),
                 {"emits nothing"});
}

constexpr const char* kLamp =
    "IESNA91\nTILT=NONE\n1 -1 1 3 2 1 2 0.5 0.25 0\n1 1 0\n0 45 90\n0 90\n100 50 0\n100 80 0\n";

/// A room with one light of type "ies" beside its file.
Scene read_measured(const std::string& fields) {
  const TempFolder folder;
  folder.write("lamp.ies", kLamp);
  return read_native_scene(
      folder.write("room.json", room(R"("materials": {}, "lights": [{"type": "ies", "file": "lamp.ies", )" +
                                     fields + "}]")),
      {});
}

PhotometricLight measured(const std::string& fields) {
  return std::get<PhotometricLight>(read_measured(fields).lights.at(0));
}

TEST(NativeLights, MeasuredLuminairesHangDownUnlessAimed) {
  const PhotometricLight l = measured(R"("position": [1, 2, 3])");
  EXPECT_EQ(l.name, "ies 0");
  EXPECT_EQ(l.position, Vec3(1, 2, 3));
  EXPECT_TRUE(l.orientation.col(2).isApprox(Vec3(0, 1, 0)));
  EXPECT_TRUE(l.orientation.col(0).isApprox(Vec3(1, 0, 0)));
  EXPECT_TRUE(l.orientation.col(1).isApprox(Vec3(0, 0, -1))) << "counter-clockwise seen from above";
  EXPECT_NEAR(l.intensity_per_candela[0], 1.0 / 179, 1e-9);
  EXPECT_EQ(l.opening.width, 0.5);
  EXPECT_EQ(measured(R"("position": [1, 2, 3], "opening": "point")").opening.shape,
            LuminousOpening::Shape::kPoint);
}

TEST(NativeLights, DownIsWhatCamerasAndSkySay) {
  const TempFolder folder;
  folder.write("lamp.ies", kLamp);
  const auto up_of_lamp = [&](const std::string& more) {
    const Scene scene = read_native_scene(folder.write("room.json", room(R"("materials": {}, "lights": [
                     {"type": "ies", "file": "lamp.ies", "position": [0, 0, 0]}], )" +
                                                                         more)),
                                          {});
    return Vec3(std::get<PhotometricLight>(scene.lights.at(0)).orientation.col(2));
  };
  const std::string camera = R"("cameras": [{"name": "c", "eye": [1, 1, 1], "look_at": [0, 1, 1], "up": )";
  EXPECT_TRUE(up_of_lamp(camera + "[0, 0, 1]}]").isApprox(Vec3::UnitZ()));
  EXPECT_TRUE(up_of_lamp(camera + "[0, 1, 0]}]").isApprox(Vec3::UnitY()));
  EXPECT_TRUE(up_of_lamp(R"("sky": {"type": "overcast", "illuminance_lx": 1, "up": "z", "north": [0, 1, 0]})")
                  .isApprox(Vec3::UnitZ()));
}

TEST(NativeLights, MeasuredLuminairesAreTurnedAndDimmed) {
  const PhotometricLight aimed = measured(R"("position": [0, 2, 0], "look_at": [3, 2, 0], "c0": [1, 5, 0])");
  EXPECT_TRUE((-aimed.orientation.col(2)).isApprox(Vec3(1, 0, 0)));
  EXPECT_TRUE(aimed.orientation.col(0).isApprox(Vec3(0, 1, 0)));
  EXPECT_NEAR(aimed.orientation.determinant(), 1, 1e-12);
  const PhotometricLight turned = measured(R"("position": [0, 0, 0], "rotate_deg": 90)");
  EXPECT_TRUE(turned.orientation.col(0).isApprox(Vec3(0, 0, -1), 1e-12));
  const PhotometricLight along = measured(R"("position": [0, 0, 0], "direction": [2, 0, 0])");
  EXPECT_TRUE(along.orientation.col(0).isApprox(Vec3(0, 0, 1)));
  EXPECT_NEAR(measured(R"("position": [0, 0, 0], "scale": 0.5)").intensity_per_candela[0], 0.5 / 179, 1e-9);
  const PhotometricLight lumens = measured(R"("position": [0, 0, 0], "flux_lm": 1000)");
  EXPECT_NEAR(lumens.intensity_per_candela[0] * 179 * lumens.table->total_flux(), 1000, 1e-3);
}

TEST(NativeLights, MountedOpeningsTouchWhatTheyAreMountedOn) {
  // 0.5 m along C = 90, 0.25 m along C = 0, 0.1 m high.
  const auto centre = [](const std::string& fields) {
    const TempFolder folder;
    std::string lamp = kLamp;
    lamp.replace(lamp.find("0.25 0\n"), 7, "0.25 0.1\n");
    folder.write("lamp.ies", lamp);
    const Scene scene = read_native_scene(
        folder.write("room.json", room(R"("materials": {}, "lights": [{"type": "ies", "file": "lamp.ies", )" +
                                       fields + "}]")),
        {});
    return std::get<PhotometricLight>(scene.lights.at(0)).position;
  };
  EXPECT_EQ(centre(R"("position": [1, 2, 3])"), Vec3(1, 2, 3));
  EXPECT_EQ(centre(R"("position": [1, 2, 3], "mount": "free")"), Vec3(1, 2, 3));
  EXPECT_TRUE(centre(R"("position": [1, 2, 3], "mount": "ceiling")").isApprox(Vec3(1, 1.95, 3), 1e-15));
  EXPECT_TRUE(centre(R"("position": [1, 2, 3], "mount": "ceiling", "direction": [0, 0, -1])")
                  .isApprox(Vec3(1, 2, 2.95), 1e-15));
  EXPECT_TRUE(
      centre(R"("position": [1, 2, 3], "mount": "ceiling", "opening": "point")").isApprox(Vec3(1, 2, 3)));
  EXPECT_TRUE(centre(R"("position": [0, 2, 3], "mount": "wall", "away": [2, 0, 0])")
                  .isApprox(Vec3(0.125, 2, 3), 1e-15));
  EXPECT_TRUE(centre(R"("position": [0, 2, 0], "mount": "wall", "away": [0, 0, 1])")
                  .isApprox(Vec3(0, 2, 0.25), 1e-15));
  // Aimed at 45 degrees under a level ceiling, the upper edge touches it.
  EXPECT_TRUE(
      centre(
          R"("position": [0, 2, 0], "mount": "ceiling", "away": [0, -1, 0], "direction": [1, -1, 0], "c0": [1, 1, 0])")
          .isApprox(Vec3(0, 2 - (0.05 + 0.125) * std::sqrt(0.5), 0), 1e-12));
}

TEST(NativeLights, RefusesMeasuredLuminairesThatCannotBe) {
  const auto refused = [](const std::string& fields, std::initializer_list<const char*> parts) {
    expect_input_error([&] { read_measured(fields); }, parts);
  };
  refused(R"("position": [0, 0, 0], "scale": 0)", {"#/lights/0/scale", "emits nothing"});
  refused(R"("position": [0, 0, 0], "flux_lm": 0)", {"#/lights/0/flux_lm", "emits nothing"});
  refused(R"("position": [0, 0, 0], "mount": "roof")", {"#/lights/0/mount", "ceiling"});
  refused(R"("position": [0, 0, 0], "mount": "wall")", {"#/lights/0/mount", "away"});
  refused(R"("position": [0, 0, 0], "mount": "wall", "away": [0, 0, 0])", {"#/lights/0/away", "no length"});
  refused(R"("position": [0, 0, 0], "away": [0, 0, 1])", {"#/lights/0/away", "not mounted"});
  refused(R"("position": [0, 0, 0], "scale": 1, "flux_lm": 1)", {"#/lights/0/flux_lm", "given already"});
  refused(R"("position": [0, 0, 0], "direction": [0, 0, 0])", {"#/lights/0/direction", "no length"});
  refused(R"("position": [0, 0, 0], "look_at": [0, 0, 0])", {"#/lights/0/look_at"});
  refused(R"("position": [0, 0, 0], "c0": [0, 1, 0])", {"#/lights/0/c0", "along the aim"});
  refused(R"("position": [0, 0, 0], "opening": "round")", {"#/lights/0/opening"});
  refused(R"("position": [0, 0, 0], "intensity_cd": 1)", {"unknown key"});
  expect_refused(
      room(R"("materials": {}, "lights": [{"type": "ies", "file": "none.ies", "position": [0, 0, 0]}])"),
      {"#/lights/0/file", "none.ies"});
}

TEST(NativeCameras, FieldsAndDefaults) {
  const Scene scene = read_text(room(R"("materials": {}, "cameras": [
      {"name": "a", "eye": [1, 2, 3], "look_at": [4, 2, 3], "up": [0, 0, 2], "vertical_fov_deg": 60, "size": [640, 480]},
      {"eye": [1, 2, 3], "look_at": [4, 2, 3]}])"));
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.cameras[0].up, Vec3(0, 0, 1));
  EXPECT_EQ(scene.cameras[0].width, 640);
  EXPECT_EQ(scene.cameras[1].name, "camera 1");
  EXPECT_EQ(scene.cameras[1].up, Vec3(0, 1, 0));
  EXPECT_EQ(scene.cameras[1].vertical_fov_deg, 45);
  const auto refused = [](const std::string& camera, std::initializer_list<const char*> parts) {
    expect_refused(room(R"("materials": {}, "cameras": [{)" + camera + "}]"), parts);
  };
  refused(R"("eye": [1, 2, 3], "look_at": [1, 2, 3])", {"#/cameras/0/look_at", "own eye"});
  refused(R"("eye": [1, 2, 3], "look_at": [1, 5, 3])", {"up direction"});
  refused(R"("eye": [1, 2, 3], "look_at": [1, 5, 4], "size": [0, 5])", {"#/cameras/0/size/0"});
  refused(R"("eye": [1, 2, 3], "look_at": [1, 5, 4], "size": [5, 16385])", {"#/cameras/0/size/1", "16384"});
  refused(
      R"("name": "x", "eye": [0,0,0], "look_at": [0,0,1]}, {"name": "x", "eye": [0,0,0], "look_at": [0,0,1])",
      {"#/cameras/1", "second camera"});
}

constexpr const char* kQuadObj = R"(mtllib quad.mtl
v 0 0 0
v 100 0 0
v 100 100 0
v 0 100 0
usemtl inside
f 1 2 3 4
)";
constexpr const char* kQuadMtl = "newmtl inside\nKd 0.4 0.4 0.4\nnewmtl outside\nKd 0.1 0.1 0.1\n";

TEST(NativeFiles, ObjWithUnitTransformAndMaterials) {
  const TempFolder folder;
  folder.write("quad.obj", kQuadObj);
  folder.write("quad.mtl", kQuadMtl);
  const auto read = [&](const std::string& more) {
    return read_native_scene(
        folder.write("room.json", room(R"("bands": "rgb", "materials": {"white": {"reflectance": 0.8}},
        "objects": [{"name": "q", "file": {"path": "quad.obj", "unit": "cm"}, "transform": {"translate": [3, 0, 0]})" +
                                       more + "}]")),
        {});
  };
  const Scene own = read("");
  ASSERT_EQ(own.surfaces.size(), 1u);
  EXPECT_NEAR(surface_area(own.surfaces[0]), 1, 1e-9);
  EXPECT_NEAR(own.surfaces[0].positions[0].x(), 3, 1e-12);
  EXPECT_NEAR(own.material_of(own.surfaces[0]).reflectance[0], 0.4, 1e-9);
  EXPECT_EQ(read(R"(, "material": "white")").material_of(read(R"(, "material": "white")").surfaces[0]).name,
            "white");
  const Scene mapped = read(R"(, "materials": {"inside": "white"})");
  EXPECT_EQ(mapped.material_of(mapped.surfaces[0]).name, "white");
  expect_input_error([&] { read(R"(, "materials": {"insid": "white"})"); }, {"Did you mean \"inside\"?"});
}

TEST(NativeFiles, UnitOfTheRoomAndOfTheFileAreIndependent) {
  const TempFolder folder;
  folder.write("quad.obj", kQuadObj);
  folder.write("quad.mtl", kQuadMtl);
  const Scene scene =
      read_native_scene(folder.write("room.json", room(R"("unit": "mm", "bands": "rgb", "materials": {},
      "objects": [{"file": {"path": "quad.obj", "unit": "cm"}, "transform": {"translate": [500, 0, 0]},
                   "array": {"count": 2, "step": [0, 0, 1000]}}])")),
                        {});
  ASSERT_EQ(scene.surfaces.size(), 2u);
  EXPECT_NEAR(surface_area(scene.surfaces[0]), 1, 1e-9);
  EXPECT_NEAR((scene.surfaces[1].positions[0] - Vec3(0.5, 0, 1)).norm(), 0, 1e-12);
  EXPECT_EQ(scene.materials.size(), 1u);  // Imported once for both.
}

TEST(NativeFiles, RefusesMissingAndUnknownFiles) {
  const auto refused = [](const std::string& path, std::initializer_list<const char*> parts) {
    expect_refused(test::room_of(R"({"material": "white", "file": {"path": ")" + path + R"("}})"), parts);
  };
  refused("missing.obj", {"#/objects/0/file/path", "there is no file"});
  refused(".", {"there is no file"});
  refused("room.json", {"cannot read \".json\" files"});
}

TEST(NativeReader, TheExampleOfTheDocumentationIsARoom) {
  const std::string page =
      test::read_bytes(std::filesystem::path(REEMIT_SOURCE_DIR) / "docs" / "room_format.md");
  const std::size_t start = page.find("```json\n") + 8;
  Scene scene = read_text(page.substr(start, page.find("```", start) - start));
  finish_scene(scene);
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.name, "A small room");
  EXPECT_EQ(scene.surfaces.size(), 1u + 5u + 3u * 4u);
}

}  // namespace
}  // namespace reemit

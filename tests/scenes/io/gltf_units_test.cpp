#include "scenes/io/gltf/gltf_units.h"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/io/gltf_building.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::GltfBuilder;
using test::read_gltf;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

/// What Blender writes for a point lamp and a spot of `watts`, a sun of `sun` W/m2 and a square whose
/// emission has the strength `strength`, by the formulas of its exporter since version 3.4.
GltfBuilder exported(const std::string& generator, double watts, double sun, double strength,
                     double efficacy = 683, double sphere = 4 * pi) {
  GltfBuilder gltf;
  gltf.square();
  gltf.json["asset"]["generator"] = generator;
  gltf.json["materials"][0]["emissiveFactor"] = {1, 1, 1};
  gltf.json["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
  gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", watts / sphere * efficacy}},
      {{"type", "spot"},
       {"intensity", watts / sphere * efficacy},
       {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.5}}}},
      {{"type", "directional"}, {"intensity", sun * efficacy}}};
  for (int i = 0; i < 3; ++i)
    gltf.node({{"translation", {0, 5, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  return gltf;
}

void expect_watts(const Scene& scene, double watts, double sun, double radiance) {
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_NEAR(4 * pi * std::get<PointLight>(scene.lights[0]).intensity[0], watts, 1e-9 * watts);
  EXPECT_NEAR(4 * pi * std::get<SpotLight>(scene.lights[1]).intensity[1], watts, 1e-9 * watts);
  EXPECT_NEAR(std::get<DirectionalLight>(scene.lights[2]).irradiance[2], sun, 1e-9 * sun);
  EXPECT_NEAR(scene.materials[0].emitted_radiance[0], radiance, 1e-9 * radiance);
}

TEST(GltfUnits, WattsOfBlenderComeBackForEveryKindOfLight) {
  for (const char* generator : {"Khronos glTF Blender I/O v3.4.50", "Khronos glTF Blender I/O v4.2.57"}) {
    const Scene scene = read_gltf(exported(generator, 100, 5, 7));
    expect_watts(scene, 100, 5, 7);
    EXPECT_THAT(scene.notes,
                Contains(AllOf(HasSubstr("lamps"), HasSubstr("683 lm/W"), HasSubstr(generator))));
    EXPECT_THAT(scene.notes,
                Contains(AllOf(HasSubstr("emissive meshes"), HasSubstr("W/(sr m2)"), HasSubstr(generator))));
  }
}

TEST(GltfUnits, OldVersionsOfBlenderWroteWatts) {
  for (const char* generator : {"Khronos glTF Blender I/O v3.3.32", "Khronos glTF Blender I/O v1.1.46",
                                "Khronos Blender glTF 2.0 I/O"}) {
    const Scene scene = read_gltf(exported(generator, 100, 5, 7, 1, 1));
    expect_watts(scene, 100, 5, 7);
    EXPECT_THAT(scene.notes, Contains(HasSubstr("as W of a full sphere")));
  }
}

TEST(GltfUnits, OtherProgramsAreTakenAtTheSpecification) {
  for (const char* generator : {"", "THREE.GLTFExporter", "Blendermania"}) {
    const Scene scene = read_gltf(exported(generator, 100, 5, 7));
    expect_watts(scene, 100 * 683 / 179.0, 5 * 683 / 179.0, 7 / 179.0);
    EXPECT_THAT(scene.notes, Contains(AllOf(HasSubstr("lamps"), HasSubstr("179 lm/W"))));
    EXPECT_THAT(scene.notes, Contains(AllOf(HasSubstr("emissive meshes"), HasSubstr("cd/m2"))));
  }
}

TEST(GltfUnits, RewrittenFilesSayThatTheirUnitsAreOpen) {
  const auto warned = Contains(AllOf(HasSubstr("--emissive-units"), HasSubstr("--gltf-light-efficacy")));
  for (const char* generator : {"glTF-Transform v4.5.1", "gltfpack 0.21"}) {
    const Scene scene = read_gltf(exported(generator, 100, 5, 7));
    expect_watts(scene, 100 * 683 / 179.0, 5 * 683 / 179.0, 7 / 179.0);
    EXPECT_THAT(scene.warnings, warned) << generator;
  }
  ReadOptions options;
  options.gltf_light_efficacy = 683;
  options.gltf_emissive_units = EmissiveUnits::kWatt;
  const Scene settled = read_gltf(exported("glTF-Transform v4.5.1", 100, 5, 7), options);
  expect_watts(settled, 100, 5, 7);
  EXPECT_THAT(settled.warnings, testing::Not(Contains(HasSubstr("rewrote"))));
  EXPECT_THAT(read_gltf(exported("THREE.GLTFExporter", 100, 5, 7)).warnings, testing::Not(warned));
}

TEST(GltfUnits, RoomsOfBlenderWithoutLampsSayWhichAreExported) {
  GltfBuilder gltf;
  gltf.square();
  gltf.json["asset"]["generator"] = "Khronos glTF Blender I/O v3.4.50";
  EXPECT_THAT(read_gltf(gltf).warnings, Contains(HasSubstr("no area lamps")));
  EXPECT_THAT(read_gltf(exported("Khronos glTF Blender I/O v3.4.50", 100, 5, 7)).warnings,
              testing::Not(Contains(HasSubstr("no area lamps"))));
}

TEST(GltfUnits, OptionsGoFirst) {
  ReadOptions options;
  options.gltf_light_efficacy = 100;
  options.gltf_emissive_units = EmissiveUnits::kCandela;
  const Scene scene = read_gltf(exported("Khronos glTF Blender I/O v4.2.57", 100, 5, 7), options);
  expect_watts(scene, 683, 5 * 6.83, 7 / 179.0);
  EXPECT_THAT(scene.notes, Contains(HasSubstr("100 lm/W that were asked for")));
  EXPECT_THAT(scene.notes, Contains(AllOf(HasSubstr("emissive meshes"), HasSubstr("as was asked for"))));
}

}  // namespace
}  // namespace reemit

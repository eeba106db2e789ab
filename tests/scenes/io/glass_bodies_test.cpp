// Materials that reflect and transmit as mirrors and glass: what readers and checks make of them.

#include "scenes/io/common/glass_bodies.h"

#include <variant>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/io/scene_reader.h"
#include "tests/scenes/io/native_reading.h"

namespace reemit {
namespace {

using test::expect_refused;
using test::read_text;
using test::room;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

Scene read_whole(const std::string& text) {
  const test::TempFolder folder;
  return read_scene(folder.write("room.json", text));
}

std::string with_material(const std::string& material, const std::string& objects) {
  return room(R"("materials": {"m": )" + material +
              R"(, "lamp": {"radiance": 1}}, "objects": [{"material": "lamp",
              "quad": {"corner": [0, 9, 0], "u": [1, 0, 0], "v": [0, 0, 1]}}, )" +
              objects + "]");
}

constexpr const char* kBox =
    R"({"name": "body", "material": "m", "box": {"min": [0, 0, 0], "max": [1, 1, 1]}})";
constexpr const char* kGlass = R"({"glass": {"ior": 1.5, "solid": true, "transmittance_per_m": 0.5}})";

const NonDiffusePart& part_of_surface(const Scene& scene, std::size_t surface) {
  return scene.material_of(scene.surfaces[surface]).non_diffuse;
}

TEST(NativeMaterials, MirrorsAndGlass) {
  const Scene scene = read_text(room(
      R"("bands": "rgb", "materials": {"a": {"reflectance": 0.1, "mirror": [0.9, 0.8, 0.7]}, "b": {"metal": 0.6},
         "c": {"transmittance": 0.8, "mirror": 0.1}, "d": {"glass": {"ior": 1.52, "transmittance": 0.9}},
         "e": {"glass": {"ior": 1.33, "solid": true, "transmittance_per_m": 0.5}},
         "g": {"metal": "copper"}, "h": {"metal": {"eta": [1, 2, 3], "k": 4}},
         "f": {"reflectance": 0.3, "diffuse_transmittance": [0.5, 0.4, 0.3], "sides": "front"}}, "objects": [])"));
  const auto part = [&](std::size_t k) { return scene.materials[k].non_diffuse; };
  EXPECT_EQ(part(0).specular_reflectance[1], 0.8);
  EXPECT_EQ(part(0).angle_law, AngleLaw::kConstant);
  EXPECT_EQ(part(1).angle_law, AngleLaw::kSchlick);
  EXPECT_EQ(part(2).specular_transmittance[2], 0.8);
  EXPECT_EQ(part(3).angle_law, AngleLaw::kDielectric);
  EXPECT_EQ(part(3).index_of_refraction, 1.52);
  EXPECT_FALSE(part(3).is_solid);
  EXPECT_TRUE(part(4).is_solid);
  EXPECT_NEAR(part(4).absorption_per_m[0], std::log(2.0), 1e-12);
  EXPECT_EQ(part(5).diffuse_transmittance[1], 0.4);
  EXPECT_EQ(part(6).angle_law, AngleLaw::kConductor);
  EXPECT_GT(part(6).metal_k[0], part(6).metal_k[2]) << "copper is red";
  EXPECT_NEAR(part(6).metal_eta[2], 1.1584, 1e-4) << "between samples at 442.8 and 476.9 nm";
  EXPECT_EQ(part(7).metal_eta[2], 3);
  EXPECT_EQ(part(7).metal_k[1], 4);
  EXPECT_EQ(scene.materials[4].reflectance_of(false)[0], 0.0);
}

TEST(NativeMaterials, RefuseWhatCannotBe) {
  const auto refused = [](const char* material, std::initializer_list<const char*> parts) {
    expect_refused(with_material(material, kBox), parts);
  };
  refused(R"({"reflectance": 0.6, "mirror": 0.5})", {"#/materials/m", "1.1", "at most 1"});
  refused(R"({"reflectance": 0.1, "back_reflectance": 0.6, "mirror": 0.5})", {"#/materials/m", "1.1"});
  refused(R"({"back_reflectance": 1.1})", {"#/materials/m/back_reflectance", "from 0 to 1"});
  refused(R"({"back_reflectance": 0.5, "sides": "front"})", {"#/materials/m/back_reflectance", "absorbs"});
  refused(R"({"mirror": 1.2})", {"#/materials/m/mirror", "1.2", "from 0 to 1"});
  refused(R"({"mirror": 0.5, "metal": 0.5})", {"#/materials/m/metal", "already a mirror"});
  refused(R"({"glass": {"ior": 0.9}})", {"#/materials/m/glass/ior", "0.9"});
  refused(R"({"glass": {"ior": 1.5}, "mirror": 0.1})", {"#/materials/m/glass"});
  refused(R"({"glass": {"ior": 1.5, "transmittance_per_m": 0.5}})", {"transmittance_per_m", "no thickness"});
  refused(R"({"glass": {"ior": 1.5, "solid": true, "transmittance_per_m": 0}})", {"lets nothing through"});
  refused(R"({"glass": {}})", {"#/materials/m/glass", "ior"});
}

TEST(GlassBodies, ClosedOnesStayBodies) {
  const Scene scene = read_whole(with_material(kGlass, kBox));
  for (std::size_t s = 1; s < scene.surfaces.size(); ++s)
    EXPECT_TRUE(part_of_surface(scene, s).is_solid) << s;
  EXPECT_THAT(scene.warnings, IsEmpty());
  const Scene ball =
      read_whole(with_material(kGlass, R"({"material": "m", "sphere": {"center": [0, 0, 0], "radius": 1}})"));
  EXPECT_TRUE(part_of_surface(ball, 1).is_solid);
}

TEST(GlassBodies, OpenOnesBecomePanesWithAWarning) {
  const Scene scene = read_whole(with_material(
      kGlass,
      R"({"name": "sheet", "material": "m", "quad": {"corner": [3, 0, 0], "u": [1, 0, 0], "v": [0, 0, 1]}},
                 {"name": "lidless", "material": "m", "box": {"min": [0, 0, 0], "max": [1, 1, 1], "open": ["y+"]}},
                 {"name": "whole", "material": "m", "box": {"min": [5, 0, 0], "max": [6, 1, 1]}})"));
  std::size_t solid = 0;
  for (const Surface& s : scene.surfaces)
    if (scene.material_of(s).non_diffuse.is_solid) {
      ++solid;
      EXPECT_THAT(s.name, HasSubstr("whole"));
    } else if (s.name == "sheet") {
      EXPECT_EQ(scene.material_of(s).name, "m (pane)");
      EXPECT_EQ(scene.material_of(s).non_diffuse.absorption_per_m.size(), 0);
    }
  EXPECT_EQ(solid, 1U);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("enclose no body, the first 'sheet'")));
  EXPECT_THAT(scene.warnings, Not(Contains(HasSubstr("segments"))));
  const Scene round = read_whole(with_material(
      kGlass,
      R"({"name": "tumbler", "material": "m", "cylinder": {"base": [0, 0, 0], "top": [0, 1, 0], "radius": 1}})"));
  EXPECT_THAT(round.warnings, Contains(HasSubstr("give cylinders and cones \"segments\"")));
}

TEST(GlassBodies, FrontsAreTurnedOutwards) {
  const Scene scene = read_whole(with_material(
      kGlass, R"({"material": "m", "box": {"min": [0, 0, 0], "max": [1, 1, 1], "inward": true}})"));
  for (std::size_t s = 1; s < scene.surfaces.size(); ++s) {
    const Surface& surface = scene.surfaces[s];
    ASSERT_TRUE(part_of_surface(scene, s).is_solid);
    const auto& loop = surface.faces[0].outer;
    const Vec3 normal = (surface.positions[loop[1]] - surface.positions[loop[0]])
                            .cross(surface.positions[loop[2]] - surface.positions[loop[1]]);
    EXPECT_GT(normal.dot(surface.positions[loop[0]] - Vec3::Constant(0.5)), 0) << surface.name;
  }
}

/// Whether the first face of a surface, or its sphere, looks away from the origin.
bool looks_outwards(const Surface& surface) {
  if (!surface.shapes.empty()) return !std::get<Sphere>(surface.shapes[0]).inward;
  const auto& loop = surface.faces[0].outer;
  const Vec3 a = surface.positions[loop[0]], b = surface.positions[loop[1]], c = surface.positions[loop[2]];
  return (b - a).cross(c - b).dot(a) > 0;
}

TEST(GlassBodies, OfTheSameGlassWithinEachOtherAreHollow) {
  const auto box = [](const char* name, double half, const char* more) {
    return fmt::format(
        R"({{"name": "{}", "material": "m", "box": {{"min": [{}, {}, {}], "max": [{}, {}, {}]{}}}}})", name,
        -half, -half, -half, half, half, half, more);
  };
  // However they are wound; a ball of glass in the hollow of a hollow box.
  for (const char* winding : {"", R"(, "inward": true)"}) {
    const Scene scene = read_whole(with_material(
        kGlass,
        box("outer", 1, winding) + ", " + box("inner", 0.9, winding) +
            R"(, {"name": "ball", "material": "m", "sphere": {"center": [0, 0, 0], "radius": 0.5}})" +
            R"(, {"name": "bubble", "material": "m", "sphere": {"center": [0, 0, 0], "radius": 0.1}})"));
    for (const Surface& s : scene.surfaces) {
      if (s.name == "lamp" || s.material.index() != scene.surfaces.back().material.index()) continue;
      const bool outwards = s.name.starts_with("outer") || s.name.starts_with("ball");
      EXPECT_EQ(looks_outwards(s), outwards) << s.name << winding;
    }
    EXPECT_THAT(scene.warnings, IsEmpty());
  }
}

TEST(GlassBodies, OfOtherGlassWithinOrAcrossAreToldOf) {
  const auto with_water = [](double x) {
    return read_whole(room(fmt::format(
        R"("materials": {{"lamp": {{"radiance": 1}}, "glass": {{"glass": {{"ior": 1.5, "solid": true}}}},
           "water": {{"glass": {{"ior": 1.33, "solid": true}}}}}}, "objects": [
           {{"material": "lamp", "quad": {{"corner": [0, 9, 0], "u": [1, 0, 0], "v": [0, 0, 1]}}}},
           {{"name": "block", "material": "glass", "box": {{"min": [-1, -1, -1], "max": [1, 1, 1]}}}},
           {{"name": "drop", "material": "water", "sphere": {{"center": [{}, 0, 0], "radius": 0.5}}}}])",
        x)));
  };
  for (const double x : {0.0, 1.0}) {
    const Scene scene = with_water(x);
    EXPECT_THAT(scene.warnings, Contains(testing::AllOf(HasSubstr("within each other or overlap"),
                                                        HasSubstr("'drop' of 'water'"), HasSubstr("block"))));
    EXPECT_EQ(scene.not_modelled.at("glass_in_glass"), 1U);
    EXPECT_TRUE(looks_outwards(scene.surfaces.back()));
  }
  EXPECT_THAT(with_water(1.6).warnings, IsEmpty());
}

// Files of others may say more than there is; nothing is gained, and it is told.
TEST(GlassBodies, SharesAreLimitedToAllLight) {
  Scene scene = read_text(with_material(R"({"reflectance": 0.5})", kBox));
  NonDiffusePart& part = scene.materials[1].non_diffuse;
  part.specular_reflectance = Spectrum::Constant(1, 0.4);
  part.specular_transmittance = Spectrum::Constant(1, 0.3);
  finish_scene(scene);
  EXPECT_NEAR(scene.materials[1].non_diffuse.specular_transmittance[0], 0.1, 1e-12);
  EXPECT_NEAR(scene.materials[1].non_diffuse.specular_reflectance[0], 0.4, 1e-12);
  EXPECT_TRUE(scene.materials[1].two_sided) << "light that crosses meets the back on its way out";
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("more than it gets")));
}

}  // namespace
}  // namespace reemit

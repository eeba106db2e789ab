#include "scenes/io/obj/obj_reader.h"

#include <array>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/io/face_area.h"
#include "tests/support/refusal.h"
#include "tests/support/temp_folder.h"

namespace reemit {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const std::string kSquare =
    "mtllib room.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl wall\n";  // lines 1 to 6

class ObjReader : public ::testing::Test {
 protected:
  ObjReader() { folder_.write("room.mtl", "newmtl wall\nKd 0.5 0.4 0.3\nnewmtl lamp\nKd 0 0 0\nKe 3 2 1\n"); }

  Scene read(const std::string& text) const { return read_obj_scene(folder_.write("room.obj", text), {}); }
  Scene read_with(const std::string& mtl) const {
    folder_.write("room.mtl", mtl);
    return read(kSquare + "f 1 2 3 4\n");
  }
  std::string refusal(const std::string& text) const {
    return test::refusal_of([&] { read(text); });
  }
  std::string mtl_refusal(const std::string& mtl) const {
    folder_.write("room.mtl", mtl);
    return refusal(kSquare + "f 1 2 3 4\n");
  }
  // A binary portable pixmap with the given 8-bit colours in one row.
  void write_texture(const std::string& name, const std::vector<std::array<int, 3>>& pixels) const {
    std::string bytes = "P6\n" + std::to_string(pixels.size()) + " 1\n255\n";
    for (const auto& pixel : pixels)
      for (const int channel : pixel) bytes += static_cast<char>(channel);
    folder_.write(name, bytes);
  }
  test::TempFolder folder_;
};

TEST_F(ObjReader, ReadsMaterialsAndPolygons) {
  const Scene scene = read(kSquare + "o shell\ng back\nf 1 2 3 4\nusemtl lamp\nf 1 2 3\ng\nf 1/1 3/2 4/3\n");
  std::vector<std::string> names;
  for (const Surface& s : scene.surfaces) names.push_back(s.name);
  EXPECT_THAT(names, ElementsAre("shell/back (wall)", "shell/back (lamp)", "shell"));
  const Face& quad = scene.surfaces[0].faces[0];
  EXPECT_EQ(quad.outer.size(), 4U) << "polygons stay polygons";
  EXPECT_EQ(quad.source_line, 9U);
  EXPECT_TRUE(test::area_vector(scene.surfaces[0], quad).isApprox(Vec3(0, 0, 1)));
  const Material& lamp = scene.material_of(scene.surfaces[1]);
  EXPECT_TRUE((lamp.emitted_radiance == Eigen::Array3d(3, 2, 1)).all());
  EXPECT_TRUE(lamp.two_sided);
  EXPECT_FALSE(lamp.emits_both_sides);
  EXPECT_TRUE(
      scene.material_of(scene.surfaces[0]).reflectance.isApprox(Eigen::Array3d(0.5, 0.4, 0.3), 1e-15));
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_THAT(scene.cameras, IsEmpty());
}

TEST_F(ObjReader, NegativeIndicesCountFromTheLastVertex) {
  const Scene scene = read(kSquare + "f -4 -3 -2\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf -3 -2 -1\nf -7 -6 -4\n");
  EXPECT_NEAR(test::total_area(scene), 1.5, 1e-15);
  EXPECT_EQ(bounds(scene).max.x(), 6);
}

TEST_F(ObjReader, KeepsShadingNormalsWhereEveryCornerHasOne) {
  const Scene scene =
      read(kSquare + "vn 0 0 1\nvn 0 0.6 0.8\nf 1//1 2//2 3//2\nf 1//1 3 4//1\nf 1/9/-2 2/9/-1 3/9/-1\n");
  const Surface& s = scene.surfaces.at(0);
  ASSERT_EQ(s.faces[0].normals.size(), 3U);
  EXPECT_TRUE(s.normals[s.faces[0].normals[1]].isApprox(Vec3(0, 0.6, 0.8), 1e-15));
  EXPECT_THAT(s.faces[1].normals, IsEmpty());
  EXPECT_EQ(s.faces[2].normals, s.faces[0].normals);
}

TEST_F(ObjReader, KeepsPolygonsOfManyCorners) {
  std::string text = "mtllib room.mtl\nusemtl wall\n", face = "f";
  constexpr int kCorners = 700;
  for (int k = 0; k < kCorners; ++k) {
    const double angle = 2 * std::numbers::pi * k / kCorners;
    text += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
    face += " " + std::to_string(k + 1);
  }
  const Scene scene = read(text + face + "\n");
  ASSERT_EQ(test::face_count(scene), 1U);
  EXPECT_EQ(scene.surfaces[0].faces[0].outer.size(), static_cast<std::size_t>(kCorners));
  EXPECT_NEAR(test::total_area(scene), std::numbers::pi, 1e-3);
}

TEST_F(ObjReader, CutsSeamsAndReportsDegenerateFaces) {
  const Scene scene = read(
      "mtllib room.mtl\nusemtl wall\nv 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\n"
      "v 3 1 0\nf 1 2 3 4 5 6 7 8 5 4\nf 1 2 2\nf 1 1 1\n");
  EXPECT_NEAR(test::total_area(scene), 12, 1e-12);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("2 face(s)")));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("line 12")));
}

TEST_F(ObjReader, NamesMayHaveBlanksAndLinesMayEndOddly) {
  folder_.write("my room.mtl", "newmtl Material #1  \r\n\tKd 0.5 0.5 0.5 # grey\r\n");
  const Scene scene = read(
      "mtllib my room.mtl\r\nv 0 0 0 1\r\nv 1 0 0 0.5 0.5 0.5\r\nv 0 1 0 # corner\r\n"
      "usemtl Material #1 \r\nf 1 2 \\\r\n3\r\n");
  EXPECT_EQ(scene.materials.at(0).name, "Material #1");
  EXPECT_EQ(test::face_count(scene), 1U);
}

TEST_F(ObjReader, NamesFileAndLineOfEveryMistake) {
  for (const char* bad :
       {"f",          "f 1 2 9",   "f 1 2 0",       "f 1 2 -5",          "f 1 2 x",   "f 1 2 /",
        "f 1 2 /3",   "f 1 9",     "f 1 2 3/1/1/1", "f 1 2 0//1",        "f 1 2 1.5", "f 1 2 99999999999",
        "v 1 2",      "v 1 2 nan", "v 1 2 1e999",   "v 1 2 3 4 5 6 7 8", "v",         "vn 0 0",
        "vn 0 0 1 1", "mtllib"})
    EXPECT_THAT(refusal(kSquare + bad + "\n"), HasSubstr("room.obj:7: ")) << bad;
}

TEST_F(ObjReader, DecimalCommasAreNamed) {
  EXPECT_THAT(refusal("v 0,5 1,0 2,0\n"), AllOf(HasSubstr("room.obj:1"), HasSubstr("decimal point")));
}

TEST_F(ObjReader, IgnoredStatementsAreNamedOnce) {
  const Scene scene = read(kSquare + "s 1\nvt 0 0\nl 1 2\nl 2 3\ncurv 0 1 1 2\nf 1 2 3\n");
  EXPECT_EQ(scene.warnings.size(), 2U);
  EXPECT_THAT(scene.warnings[0], HasSubstr("'l'"));
}

TEST_F(ObjReader, MtlMistakesAreNamedWithTheirLine) {
  for (const char* bad :
       {"Kd 0.5 0.5", "Kd", "Kd 255 0 0", "Kd -0.1 0 0", "Kd x 0 0", "Ks 11 0 0", "Ke -1 0 0", "Ke nan 0 0",
        "Ns", "Ns x", "Ni -1", "Ni inf", "d 100", "Kd spectral file.rfl", "Kd 0 0 0 0"})
    EXPECT_THAT(mtl_refusal(std::string("newmtl wall\n") + bad + "\n"), HasSubstr("room.mtl:2: ")) << bad;
  folder_.write("room.mtl", "newmtl wall\nKd 0.5 0.5 0.5\nnewmtl wall\nKd 1 1 1\n");
  EXPECT_THAT(read(kSquare + "f 1 2 3\n").warnings, Contains(HasSubstr("defined again")));
}

TEST_F(ObjReader, NumbersBeyondTheirRangeAreBroughtIntoItAndNamedOnce) {
  const Scene scene = read_with("newmtl wall\nKd 1.5 0.5 0.5\nNs -1.960784\nd 1.2\n");
  EXPECT_TRUE(scene.materials[0].reflectance.isApprox(Eigen::Array3d(1, 0.5, 0.5), 1e-15));
  EXPECT_THAT(scene.warnings, Contains(AllOf(HasSubstr("room.mtl:2: 'Kd 1.5' is taken as 1"),
                                             HasSubstr("2 more numbers of the file"))));
  EXPECT_THAT(mtl_refusal("newmtl wall\nKd 200 0 0\n"), HasSubstr("255 is 1 there"));
}

TEST_F(ObjReader, WhatStandsBeforeTheFirstMaterialIsIgnored) {
  const Scene scene = read_with("Ka 0 0 0\nKd 0.1 0.1 0.1\nnewmtl wall\nKd 0.5 0.5 0.5\n");
  EXPECT_TRUE(scene.materials[0].reflectance.isApproxToConstant(0.5, 1e-15));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("room.mtl:1: 'Ka' is ignored")));
}

TEST_F(ObjReader, SlashesOfWhatACornerHasNotArePassedOver) {
  const Scene scene = read(kSquare + "f 1/ 2// 3/\n");
  EXPECT_EQ(test::face_count(scene), 1U);
}

TEST_F(ObjReader, FacesOfTwoCornersAreLeftOut) {
  const Scene scene = read(kSquare + "f 1 2 3\nf 1 2\nf 3\n");
  EXPECT_EQ(test::face_count(scene), 1U);
  EXPECT_THAT(scene.warnings, Contains(AllOf(HasSubstr("2 face(s)"), HasSubstr("line 8"))));
}

TEST_F(ObjReader, NormalsAndTextureCoordinatesThatAreNotThereAreDoneWithout) {
  const Scene scene = read(kSquare + "f 1//1 2//1 3//1\nf 1/-4 3/-4 4/-4\n");
  EXPECT_EQ(test::face_count(scene), 2U);
  EXPECT_TRUE(scene.surfaces[0].faces[0].normals.empty());
  EXPECT_THAT(scene.warnings, Contains(AllOf(HasSubstr("1 face(s) refer to a vn"), HasSubstr("line 7"))));
}

TEST_F(ObjReader, AMaterialWithoutANameIsThatOfFacesWithoutOne) {
  folder_.write("room.mtl", "newmtl\nKd 0.8 0.7 0.6\n");
  const Scene scene = read("mtllib room.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  EXPECT_NEAR(scene.material_of(scene.surfaces.at(0)).reflectance[1], 0.7, 1e-7);
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(ObjReader, HighlightsOverTheWholeLightAreVarnish) {
  const Scene scene = read_with("newmtl wall\nKd 0.5 0.4 0.3\nKs 1 1 1\nNs 98\n");
  const Material& wall = scene.materials.at(0);
  EXPECT_TRUE(wall.reflectance.isApprox(Eigen::Array3d(0.5, 0.4, 0.3), 1e-6));
  EXPECT_TRUE(wall.non_diffuse.specular_reflectance.isApproxToConstant(0.04, 1e-12));
  EXPECT_THAT(scene.warnings, Contains(AllOf(HasSubstr("more than 1 in 1 material(s): 'wall'"))));
  EXPECT_TRUE(
      read_with("newmtl wall\nKd 1 1 1\nKs 1 1 1\n").materials[0].non_diffuse.specular_reflectance.size() ==
      0);
  EXPECT_NEAR(read_with("newmtl wall\nKd 0 0 0\nKs 0.9 0.9 0.9\nNs 98\n")
                  .materials[0]
                  .non_diffuse.specular_reflectance[0],
              0.9, 1e-6);
}

TEST_F(ObjReader, Utf16IsNamed) {
  using namespace std::string_literals;
  EXPECT_THAT(refusal("\xFF\xFEv\0 \0"s), HasSubstr("its text is UTF-16"));
}

TEST_F(ObjReader, WhatProgramsWriteOfAOneIsAOne) {
  const Scene scene = read_with("newmtl wall\nKd 1.0000001 0.5 0.5\nd -halo 1.0\n");
  EXPECT_EQ(scene.materials[0].reflectance[0], 1);
  EXPECT_FALSE(scene.materials[0].non_diffuse.transmits_specularly());
  EXPECT_EQ(read_with("newmtl wall\nKd 1.0000001\n").materials[0].reflectance[2], 1);
}

TEST_F(ObjReader, NonDiffusePartsAreKept) {
  const Material glass =
      read_with("newmtl wall\nKd 0.1\nKs 0.2 0.2 0.2\nNs 98\nNi 1.5\nd 0.25\nTf 1 0.5 1\nillum 7\n")
          .materials.at(0);
  EXPECT_TRUE(glass.reflectance.isApproxToConstant(0.025, 1e-15)) << "one number stands for three";
  EXPECT_EQ(glass.non_diffuse.angle_law, AngleLaw::kDielectric) << "its Ni says what it reflects";
  EXPECT_TRUE(glass.non_diffuse.is_solid);
  EXPECT_EQ(glass.non_diffuse.roughness, 0);
  EXPECT_TRUE(glass.non_diffuse.specular_transmittance.isApprox(Eigen::Array3d(0.75, 0.375, 0.75)));
  const Material gloss = read_with("newmtl wall\nKd 0.1\nKs 0.2 0.2 0.2\nNs 98\n").materials.at(0);
  EXPECT_NEAR(gloss.non_diffuse.roughness, std::sqrt(0.02), 1e-15);
  const Material metal = read_with("newmtl wall\nKs 0.2 0.2 0.2\nNs 98\nillum 5\n").materials.at(0);
  EXPECT_EQ(metal.non_diffuse.angle_law, AngleLaw::kSchlick);
  EXPECT_EQ(metal.non_diffuse.roughness, 0);
  EXPECT_EQ(glass.non_diffuse.index_of_refraction, 1.5);
  const Material opaque =
      read_with("newmtl wall\nKd 0.1 0.1 0.1\nd 1\nTf 1 1 1\nillum 2\nKs 0 0 0\n").materials.at(0);
  EXPECT_EQ(opaque.non_diffuse.specular_transmittance.size(), 0);
  EXPECT_EQ(opaque.non_diffuse.specular_reflectance.size(), 0);
  const Material refracting = read_with("newmtl wall\nKd 0 0 0\nTf 0.3 0.3 0.3\nillum 6\n").materials.at(0);
  EXPECT_TRUE(refracting.non_diffuse.specular_transmittance.isApproxToConstant(0.3, 1e-15));
  const Scene thin = read_with("newmtl wall\nKd 0 0 0\nTf 0.3 0.3 0.3\nNi 0.7\nillum 6\n");
  EXPECT_EQ(thin.materials.at(0).non_diffuse.index_of_refraction, 1);
  EXPECT_THAT(thin.warnings, Contains(AllOf(HasSubstr("material 'wall'"), HasSubstr("Ni 0.7 is below 1"))));
  EXPECT_THAT(read_with("newmtl wall\nKd 0.5 0.5 0.5\nNi 0.7\n").warnings, Not(Contains(HasSubstr("Ni"))))
      << "of what is opaque it says nothing";
}

TEST_F(ObjReader, WhatNoMaterialFileDefinesIsGrey) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const Scene absent = read("mtllib gone.mtl\n" + square + "usemtl wall\nf 1 2 3\nusemtl floor\nf 1 3 4\n");
  ASSERT_EQ(absent.materials.size(), 2U);
  EXPECT_EQ(absent.materials[1].name, "floor") << "rooms can map it by its name";
  for (const Material& m : absent.materials) EXPECT_TRUE((m.reflectance == Spectrum::Constant(3, 0.5)).all());
  EXPECT_THAT(absent.warnings, Contains(HasSubstr("room.obj:1: there is no material file")));
  EXPECT_THAT(absent.warnings, Contains(HasSubstr("room.obj:6: 2 material(s) are not defined")));
  const Scene none = read(square + "f 1 2 3\n");
  EXPECT_THAT(none.warnings, ElementsAre(HasSubstr("faces without 'usemtl'")));
  const Scene other = read(kSquare + "usemtl nobody\nf 1 2 3\n");
  EXPECT_THAT(other.warnings, ElementsAre(HasSubstr("'nobody'")));
  folder_.write("room.mtl", "");
  EXPECT_THAT(read(kSquare + "f 1 2 3\n").warnings, Contains(HasSubstr("empty")));
}

TEST_F(ObjReader, MaterialFilesMayComeAfterTheFacesThatUseThem) {
  const Scene scene = read(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl wall\nf 1 2 3\nusemtl nothing\nf 1 3 2\nmtllib room.mtl\nusemtl "
      "lamp\nf 2 1 3\n");
  ASSERT_EQ(scene.surfaces.size(), 3U);
  EXPECT_EQ(scene.material_of(scene.surfaces[0]).reflectance[0], 0.5F);
  EXPECT_EQ(scene.material_of(scene.surfaces[1]).reflectance[0], 0.5) << "grey";
  EXPECT_EQ(scene.material_of(scene.surfaces[2]).emitted_radiance[0], 3);
  EXPECT_THAT(scene.warnings,
              Contains(AllOf(HasSubstr("room.obj:6"), HasSubstr("1 material(s)"), HasSubstr("'nothing'"))));
  EXPECT_EQ(scene.refused.at("materials"), 1U);
}

TEST_F(ObjReader, BlendersMaterialsHaveNoSpecularShareOfTheLight) {
  const std::string materials =
      "newmtl wall\nNs 250.0\nKa 1 1 1\nKd 0.8 0.7 0.6\nKs 0.5 0.5 0.5\nNi 1.45\nd 1\nillum 2\n";
  const Material paint =
      read_with("# Blender 3.4.1 MTL File: 'room.blend'\n# www.blender.org\n\n" + materials).materials[0];
  EXPECT_FALSE(paint.non_diffuse.reflects_specularly());
  EXPECT_NEAR(paint.reflectance[0], 0.8, 1e-7);
  EXPECT_TRUE(
      read_with("# Another 3.4.1 MTL File\n" + materials).materials[0].non_diffuse.reflects_specularly());

  // Roughness 0.5 and three quarters of metal, as both exporters write it.
  for (const std::string head : {"# Blender 4.0 MTL File: 'None'\nnewmtl wall\nNs 250\n",
                                 "# Blender MTL File: 'a.blend'\nnewmtl wall\nNs 250\n"}) {
    const Scene scene = read_with(head + "Ka 0.75 0.75 0.75\nKd 0.8 0.4 0.2\nKs 0.5 0.5 0.5\nillum 3\n");
    const Material& metal = scene.materials[0];
    for (int c = 0; c < 3; ++c) {
      const double colour = std::array{0.8, 0.4, 0.2}[static_cast<std::size_t>(c)];
      EXPECT_NEAR(metal.non_diffuse.specular_reflectance[c], 0.75 * colour, 1e-6);
      EXPECT_NEAR(metal.reflectance[c], 0.25 * colour, 1e-6);
    }
    EXPECT_NEAR(metal.non_diffuse.roughness, 0.25, 1e-6) << head;
    EXPECT_EQ(metal.non_diffuse.lobe, GlossLobe::kGgx);
    EXPECT_EQ(metal.non_diffuse.angle_law, AngleLaw::kSchlick);
    EXPECT_THAT(scene.notes, Contains(HasSubstr("Blender wrote it")));
  }
}

TEST_F(ObjReader, MaterialFilesAreFoundBesideTheRoomWhateverTheirCase) {
  for (const char* name : {"Room.MTL", "C:\\models\\room.mtl", "textures/room.mtl"}) {
    const Scene scene =
        read(std::string("mtllib ") + name + "\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl wall\nf 1 2 3\n");
    EXPECT_NEAR(scene.materials.at(0).reflectance[2], 0.3, 1e-12) << name;
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("is taken"))) << name;
  }
}

// Kd beside glass and mirrors is often a placeholder: no light goes two ways.
TEST_F(ObjReader, GlassAndMirrorsDoNotBecomeWhitePaint) {
  const struct {
    const char* mtl;
    double diffuse, specular, transmitted;
    const char* warning;
  } cases[] = {
      {"Kd 1 1 1\nd 0.1\n", 0.1, 0, 0.9, ""},
      {"Kd 0.8 0.8 0.8\nTr 1\n", 0, 0, 1, ""},
      {"Kd 1 1 1\nTf 0.9 0.9 0.9\nd 0.5\n", 0.5, 0, 0.45, ""},
      {"Kd 1 1 1\nTf 0.7 0.7 0.7\nillum 7\n", 0.3, 0, 0.7, ""},
      {"Kd 1 1 1\nNi 1.5\nillum 6\n", 0, 0, 1, ""},
      {"Kd 1 1 1\nNi 1.5\nillum 4\n", 0, 0, 1, ""},
      {"Kd 0.6 0.6 0.6\nNi 1\nTf 1 1 1\nillum 4\n", 0.6, 0, 0, "glass by illum 4"},
      {"Kd 1 1 1\nKs 0.9 0.9 0.9\nillum 3\n", 0.1, 0.9, 0, ""},
      {"Kd 1 1 1\nillum 5\n", 1, 0, 0, "a mirror (illum 5) without Ks"},
      {"Kd 0.8 0.8 0.8\nKs 0.5 0.5 0.5\nillum 2\nTf 1 1 1\nNi 1.5\nd 1\n", 0.8, 0.04, 0, "more than 1"},
      {"Kd 0.5 0.5 0.5\nKs 0.5 0.5 0.5\nillum 2\nTf 1 1 1\nNi 1.5\nd 1\n", 0.5, 0.5, 0, ""},
  };
  for (const auto& c : cases) {
    const Scene scene = read_with(std::string("newmtl wall\n") + c.mtl);
    const Material& m = scene.materials.at(0);
    const auto share = [](const Spectrum& s) { return s.size() == 0 ? 0.0 : s[1]; };
    EXPECT_NEAR(m.reflectance[1], c.diffuse, 1e-12) << c.mtl;
    EXPECT_NEAR(share(m.non_diffuse.specular_reflectance), c.specular, 1e-12) << c.mtl;
    EXPECT_NEAR(share(m.non_diffuse.specular_transmittance), c.transmitted, 1e-12) << c.mtl;
    if (*c.warning == 0)
      EXPECT_THAT(scene.warnings, IsEmpty()) << c.mtl;
    else
      EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr(c.warning))) << c.mtl;
  }
}

TEST_F(ObjReader, TexturesAreAveragedInLinearLight) {
  write_texture("t.ppm", {{255, 0, 188}, {0, 0, 188}});
  const Scene scene = read_with("newmtl wall\nKd 0.1 0.2 0.3\nmap_Kd t.ppm\n");
  const Spectrum& rho = scene.materials.at(0).reflectance;
  EXPECT_NEAR(rho[0], 0.5, 1e-6) << "half of the pixels are 1, whatever their coding";
  EXPECT_EQ(rho[1], 0);
  EXPECT_NEAR(rho[2], 0.5029, 1e-4) << "sRGB 188";
  ASSERT_TRUE(scene.materials[0].textures.reflectance);
  EXPECT_EQ(scene.materials[0].textures.reflectance.image->width, 2);
}

TEST_F(ObjReader, TextureCoordinatesTooFarOutCountAsZero) {
  write_texture("t.ppm", {{255, 255, 255}});
  folder_.write("room.mtl", "newmtl wall\nmap_Kd t.ppm\n");
  Scene scene = read(kSquare + "vt 2e6 0.5\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n");
  finish_scene(scene);
  EXPECT_EQ(scene.surfaces[0].texture_points[0].uv[0], (std::array<double, 2>{0, 0.5}));
  EXPECT_THAT(scene.warnings, Contains(AllOf(HasSubstr("beyond 100000"), HasSubstr("room.obj:10"))));
}

TEST_F(ObjReader, TexturesAreFoundAsMaterialFilesAre) {
  std::filesystem::create_directory(folder_ / "Maps");
  write_texture("t.ppm", {{255, 255, 255}});
  write_texture("Maps/in.ppm", {{255, 255, 255}});
  const auto read_map = [&](const std::string& name) {
    return read_with("newmtl wall\nKd 0.1 0.2 0.3\nmap_Kd " + name + "\n");
  };
  for (const char* name : {"C:\\Users\\Bob\\Desktop\\t.ppm", "/home/bob/t.ppm", "textures/t.ppm", "T.PPM",
                           "\"t.ppm\"", "maps\\IN.ppm", "maps/in.PPM"}) {
    const Scene scene = read_map(name);
    EXPECT_TRUE(scene.materials.at(0).textures.reflectance) << name;
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("is taken"))) << name;
  }
  for (const char* name : {"t.ppm", "./t.ppm", "Maps\\in.ppm"}) {
    const Scene scene = read_map(name);
    EXPECT_TRUE(scene.materials.at(0).textures.reflectance) << name;
    EXPECT_THAT(scene.warnings, IsEmpty()) << name;
  }
  const Scene white = read_with("newmtl wall\nKd 1 1 1\nmap_Kd none.ppm\n");
  EXPECT_THAT(white.warnings, ElementsAre(HasSubstr("which absorbs nothing")));
}

TEST_F(ObjReader, MissingOrBrokenTexturesLeaveKd) {
  folder_.write("broken.png", "this is no image");
  for (const char* name : {"nothing.png", "broken.png", "sub\\nothing.png"}) {
    const Scene scene =
        read_with(std::string("newmtl wall\nKd 0.1 0.2 0.3\nmap_Kd ") + name + "\nmap_bump b.png\n");
    EXPECT_TRUE(scene.materials.at(0).reflectance.isApprox(Eigen::Array3d(0.1, 0.2, 0.3), 1e-15)) << name;
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("in place of the texture"))) << name;
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("bump b.png"))) << name;
  }
}

TEST_F(ObjReader, TakesTheCameraBesideIt) {
  folder_.write(
      "camera.txt",
      "# view\neye 1 2 3\ndirection 0 0 -2\nup 0 1 0\nhorizontal fov 90 degrees\nimage 200 x 100\n");
  const Scene scene = read(kSquare + "f 1 2 3\n");
  ASSERT_EQ(scene.cameras.size(), 1U);
  const Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.eye, Vec3(1, 2, 3));
  EXPECT_EQ(camera.look_at, Vec3(1, 2, 1));
  EXPECT_NEAR(camera.vertical_fov_deg, 2 * std::atan(0.5) * 180 / std::numbers::pi, 1e-12);
  EXPECT_EQ(camera.width, 200);
  EXPECT_EQ(camera.height, 100);
  for (const char* bad :
       {"eye 1 2\n", "eye 1 2 3\n", "eye 1 2 3\ndirection 0 0 1\nhorizontal fov 200\n", "shopping list\n",
        "eye 1 2 3\ndirection 0 0 1\nimage 0 x 5\n", "eye 1 2 3\ndirection 0 0 1\nimage 16385 x 5\n"}) {
    folder_.write("camera.txt", bad);
    const Scene without = read(kSquare + "f 1 2 3\n");
    EXPECT_THAT(without.cameras, IsEmpty()) << bad;
    EXPECT_THAT(without.warnings, Contains(HasSubstr("camera"))) << bad;
  }
}

}  // namespace
}  // namespace reemit

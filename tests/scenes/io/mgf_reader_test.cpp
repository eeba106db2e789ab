#include "scenes/io/mgf/mgf_reader.h"

#include <cmath>
#include <numbers>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/io/face_area.h"
#include "tests/support/refusal.h"
#include "tests/support/temp_folder.h"

namespace reemit {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// A unit square in the plane z = 0, its front upwards.
const std::string kSquareVertices = "v a =\np 0 0 0\nv b =\np 1 0 0\nv c =\np 1 1 0\nv d =\np 0 1 0\n";

class MgfReader : public ::testing::Test {
 protected:
  Scene read(const std::string& text) const { return read_mgf_scene(folder_.write("room.mgf", text), {}); }
  std::string refusal(const std::string& text) const {
    return test::refusal_of([&] { read(text); });
  }
  test::TempFolder folder_;
};
/// Of files that are small and mean very much.
using RunawayMgf = MgfReader;

TEST_F(MgfReader, ReadsColourMaterialAndFace) {
  const Scene scene =
      read(kSquareVertices + "m paint =\nc\nrd 0.5\nsides 1\ned 1790\no floor\nf a b c d\no\n");
  ASSERT_EQ(scene.surfaces.size(), 1U);
  EXPECT_EQ(scene.surfaces[0].name, "floor");
  const Material& m = scene.material_of(scene.surfaces[0]);
  EXPECT_EQ(m.name, "paint");
  EXPECT_TRUE((m.reflectance == 0.5).all());
  EXPECT_TRUE(m.emitted_radiance.isApprox(Spectrum::Constant(3, 10 / std::numbers::pi), 1e-14));
  EXPECT_FALSE(m.two_sided);
  EXPECT_EQ(scene.surfaces[0].faces[0].source_line, 15U);
  EXPECT_TRUE(test::area_vector(scene.surfaces[0], scene.surfaces[0].faces[0]).isApprox(Vec3(0, 0, 1)));
  EXPECT_THAT(scene.cameras, IsEmpty());
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(MgfReader, ContextsKeepTheirStateAndTemplatesCopyIt) {
  const Scene scene = read(kSquareVertices +
                           "m one =\nrd 0.2\nm two = one\nrd 0.3\n"
                           "m one\nf a b c\n"             // 0.2: the alias did not change its template
                           "m two\nf a b c\n"             // 0.3
                           "rd 0.4\nf a b c\n"            // a version of two
                           "m\nf a b c\n"                 // unnamed: black
                           "rd 0.6\nm one\nm\nf a b c\n"  // unnamed starts afresh
                           "m two\nf a b d\n");
  std::vector<double> reflectances;
  std::vector<std::string> names;
  for (const Material& m : scene.materials) reflectances.push_back(m.reflectance[0]), names.push_back(m.name);
  EXPECT_THAT(reflectances, ElementsAre(0.2, 0.3, 0.4, 0));
  EXPECT_THAT(names, ElementsAre("one", "two", "two#2", "unnamed"));
}

TEST_F(MgfReader, ColoursActWhenTheyAreUsed) {
  const Scene scene = read(kSquareVertices +
                           "c red =\ncxy 0.6 0.35\nc same = red\ncxy 0.3 0.5\n"
                           "c both =\ncmix 1 red 1 same\n"
                           "m paint =\nc red\nrd 0.2\nc\nrs 0.1 0.05\nc same\nf a b c\n");
  const Material& m = scene.materials.at(0);
  EXPECT_GT(m.reflectance[0], 2 * m.reflectance[1]);
  EXPECT_NEAR(m.non_diffuse.specular_reflectance[0], 0.1, 1e-15);
  EXPECT_NEAR(m.non_diffuse.roughness, 0.05, 1e-15);
}

TEST_F(MgfReader, VerticesAreTransformedOnlyWithTheGeometry) {
  // The example of the description: the ring ends up at (5,-10,0) and looks down.
  const Scene scene = read("xf -t 5 0 0\nv v1 =\np 0 10 0\nn 0 0 1\nxf -rx 180\nring v1 0 2\nxf\nxf\n");
  EXPECT_TRUE(bounds(scene).centre().isApprox(Vec3(5, -10, 0)));
  const auto disk = std::get<Disk>(scene.surfaces.at(0).shapes.at(0));
  EXPECT_TRUE(disk.normal.isApprox(Vec3(0, 0, -1)));
  EXPECT_NEAR(disk.radius, 2, 1e-12);
}

TEST_F(MgfReader, ArraysNestAndRepeatTheirContents) {
  const Scene scene = read(kSquareVertices +
                           "xf -s 2\nxf -a 3 -t 10 0 0 -a 2 -t 0 10 0 -i 1 -t 1 1 0\no tile\nf a b c d\n"
                           "xf -a 2 -t 0 0 1\nf a b c\nxf\no\nxf\nxf\nf a b c d\n");
  EXPECT_EQ(test::face_count(scene), 6U * 3 + 1);
  EXPECT_NEAR(test::total_area(scene), 6 * (4 + 2 * 2) + 1, 1e-12);
  EXPECT_TRUE(bounds(scene).max.isApprox(Vec3(2 * (20 + 1 + 1), 2 * (10 + 1 + 1), 2)));
  EXPECT_TRUE(bounds(scene).min.isZero());
}

TEST_F(MgfReader, MirroredGeometryKeepsItsFront) {
  const std::string body = "v o =\np 3 0 0\nn 0 0 1\ntorus o 0.5 1\nprism d c b a 1\n";
  const auto volume = [](const Scene& scene) {
    double sum = 0;
    for (const Surface& s : scene.surfaces)
      for (const Face& f : s.faces) sum += s.positions[f.outer[0]].dot(test::area_vector(s, f)) / 3;
    return sum;
  };
  const double plain = volume(read(kSquareVertices + body));
  EXPECT_GT(plain, 1.5);
  for (const char* mirror : {"-mx", "-my", "-mz", "-mx -my -mz", "-s -1", "-mx -rz 30 -t 1 2 0"})
    EXPECT_NEAR(volume(read(kSquareVertices + "xf " + mirror + "\n" + body + "xf\n")), plain, 1e-9) << mirror;

  // The ring alone: the normal of a mirrored surface is the mirrored normal.
  const Scene ring = read(kSquareVertices + "v o =\np 3 0 0\nn 0 0 1\nxf -mz\nring o 0.5 1\nxf\n");
  EXPECT_TRUE(std::get<Disk>(ring.surfaces.at(0).shapes.at(0)).normal.isApprox(Vec3(0, 0, -1)));
}

TEST_F(MgfReader, RoundShapesAreTransformedAndStayRound) {
  const Scene scene = read(
      "v o =\np 0 0 1\nv p =\np 0 0 3\nxf -s 5 -rx 90 -mx -t 1 2 3\nsph o -1\ncyl o 0.5 p\ncone o 1 p "
      "0\nxf\n");
  const Surface& s = scene.surfaces.at(0);
  ASSERT_EQ(s.shapes.size(), 3U);
  const auto sphere = std::get<Sphere>(s.shapes[0]);
  EXPECT_TRUE(sphere.centre.isApprox(Vec3(1, -3, 3), 1e-12));
  EXPECT_NEAR(sphere.radius, 5, 1e-12);
  EXPECT_TRUE(sphere.inward);
  const auto cylinder = std::get<Cylinder>(s.shapes[1]);
  EXPECT_TRUE(cylinder.top.isApprox(Vec3(1, -13, 3), 1e-12));
  EXPECT_NEAR(cylinder.radius, 2.5, 1e-12);
  EXPECT_EQ(std::get<Cone>(s.shapes[2]).top_radius, 0);
}

TEST_F(MgfReader, ShadingNormalsFollowRotationAndScale) {
  // A torus about the z axis through (1,2,3) after rotation about x: its normals look away from its core.
  const Scene scene = read("v o =\np 0 0 0\nn 0 0 1\nxf -s 5 -rz 40 -mx -t 1 2 3\ntorus o 1 2\nxf\n");
  const Surface& s = scene.surfaces.at(0);
  for (const Face& face : s.faces)
    for (std::size_t i = 0; i < face.outer.size(); ++i) {
      const Vec3 p = s.positions[face.outer[i]] - Vec3(1, 2, 3);
      const Vec3 core = 7.5 * Vec3(p.x(), p.y(), 0).normalized();
      EXPECT_TRUE(s.normals[face.normals[i]].isApprox((p - core).normalized(), 1e-9));
    }
}

TEST_F(MgfReader, HolesComeFromFhAndFromSeams) {
  const std::string outline =
      "v A =\np 0 0 0\nv B =\np 9 0 0\nv C =\np 9 9 0\nv D =\np 0 9 0\n"
      "v e =\np 1 1 0\nv f =\np 2 1 0\nv g =\np 2 2 0\nv h =\np 1 2 0\n"
      "v i =\np 4 4 0\nv j =\np 5 4 0\nv k =\np 4 5 0\n";
  const Scene two = read(outline + "fh A B C D - h g f e - i j k\n");
  ASSERT_EQ(two.surfaces[0].faces.size(), 1U);
  EXPECT_EQ(two.surfaces[0].faces[0].holes.size(), 2U);
  EXPECT_NEAR(test::total_area(two), 81 - 1 - 0.5, 1e-12);
  const Scene seam = read(outline + "f A B C D e h g f e D\n");
  ASSERT_EQ(seam.surfaces[0].faces.size(), 1U);
  EXPECT_EQ(seam.surfaces[0].faces[0].holes.size(), 1U);
  EXPECT_NEAR(test::total_area(seam), 80, 1e-12);
  EXPECT_THAT(refusal(outline + "fh A B C D - e f\n"), HasSubstr("room.mgf:23"));
  EXPECT_THAT(refusal(outline + "fh A B C D - - e f g\n"), HasSubstr("at least 3"));
}

TEST_F(MgfReader, ObjectsNameSurfacesPerMaterial) {
  const Scene scene =
      read(kSquareVertices +
           "m x =\nm y =\no desk\no leg\nm x\nf a b c\nm y\nf a b c\no\nm x\nf a b d\no\nf b c d\n");
  std::vector<std::string> names;
  for (const Surface& s : scene.surfaces) names.push_back(s.name);
  EXPECT_THAT(names, ElementsAre("desk/leg (x)", "desk/leg (y)", "desk", "x"));
}

TEST_F(MgfReader, IncludesAreRelativeTransformedAndShareContexts) {
  std::filesystem::create_directories(folder_ / "parts/deep");
  folder_.write("parts/deep/tile.mgf", "m tile_mat\nf a b c d\n");
  folder_.write("parts/part.mgf", kSquareVertices + "m tile_mat =\nrd 0.25\ni deep/tile.mgf -t 0 0 1\n");
  const Scene scene = read("i parts/part.mgf\ni parts/part.mgf -s 2 -a 3 -t 5 0 0\nm tile_mat\nf a b c\n");
  EXPECT_NEAR(test::total_area(scene), 1 + 3 * 4 + 0.5, 1e-12);
  EXPECT_EQ(scene.materials.size(), 1U);
  EXPECT_THAT(scene.surfaces.at(0).source, HasSubstr("tile.mgf"));
  EXPECT_TRUE(bounds(scene).max.isApprox(Vec3(12, 2, 2)));
}

TEST_F(MgfReader, RefusesMissingAndCircularIncludes) {
  EXPECT_THAT(refusal("\n\ni nothing.mgf\n"), HasSubstr("room.mgf:3"));
  EXPECT_THAT(refusal("i /etc/passwd\n"), HasSubstr("relative"));
  EXPECT_THAT(refusal("i\n"), HasSubstr("names no file"));
  EXPECT_THAT(refusal("i room.mgf\n"), HasSubstr("room.mgf -> room.mgf"));
  folder_.write("a.mgf", "i b.mgf\n");
  folder_.write("b.mgf", "i ./a.mgf -t 1 0 0\n");
  EXPECT_THAT(refusal("i a.mgf\n"), HasSubstr("room.mgf -> a.mgf -> b.mgf -> a.mgf"));
}

TEST_F(MgfReader, SaysWhatItLeavesOut) {
  const Scene scene = read(kSquareVertices + "nurbs 1 2\nnurbs 3 4\nf a b a\nf a b c\n");
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("'nurbs' is not an MGF entity")));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("room.mgf:11")));
  EXPECT_EQ(scene.warnings.size(), 2U) << "each unknown entity once";
}

TEST_F(MgfReader, PlacesMeasuredLuminaires) {
  folder_.write("lamp.ies", "IESNA91\nTILT=NONE\n1 -1 1 2 1 1 2 0.5 0.25 0\n1 1 0\n0 90\n0\n100 0\n");
  const Scene scene = read(kSquareVertices +
                           "xf -rx 90 -s 2 -t 0 0 3\no lamps\nies lamp.ies -m 2 -a 3 -t 1 0 0\no\n"
                           "xf\nies lamp.ies -mz\n");
  ASSERT_EQ(scene.lights.size(), 4U);
  const auto& third = std::get<PhotometricLight>(scene.lights[2]);
  EXPECT_EQ(third.name, "lamps 3");
  EXPECT_TRUE(third.position.isApprox(Vec3(4, 0, 3)));
  // Nadir -z and C = 0 along x, turned about x: the nadir is y.
  EXPECT_TRUE((-third.orientation.col(2)).isApprox(Vec3(0, 1, 0), 1e-12));
  EXPECT_TRUE(third.orientation.col(0).isApprox(Vec3(1, 0, 0), 1e-12));
  EXPECT_NEAR(third.opening.width, 1, 1e-12) << "sizes are scaled";
  EXPECT_NEAR(third.intensity_per_candela[0], 2.0 / 179, 1e-9) << "intensities are not";
  const auto& mirrored = std::get<PhotometricLight>(scene.lights[3]);
  EXPECT_NEAR(mirrored.orientation.determinant(), -1, 1e-12);
  EXPECT_EQ(mirrored.name, "lamp");
  EXPECT_EQ(mirrored.table.get(), third.table.get());
  EXPECT_THAT(refusal("ies nothing.ies\n"), HasSubstr("cannot be read"));
  EXPECT_THAT(refusal("ies room.mgf -m\n"), HasSubstr("-m"));
  EXPECT_THAT(refusal("ies lamp.ies -m 0\n"), HasSubstr("room.mgf:1"));
  EXPECT_THAT(refusal("ies lamp.ies -a 1000000 -t 1 0 0\n"), HasSubstr("luminaires"));
  folder_.write("bad.ies", "IESNA91\nTILT=NONE\n1 -1 0\n");
  EXPECT_THAT(refusal("ies bad.ies\n"), AllOf(HasSubstr("room.mgf:1"), HasSubstr("bad.ies:3")));
}

TEST_F(MgfReader, ClosesWhatIsLeftOpenAndSaysSo) {
  folder_.write("open.mgf", "xf -t 5 0 0\no inside\nf a b c d\n");
  const Scene scene = read(kSquareVertices + "i open.mgf\nf a b c d\n");
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("'xf' without an end")));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("object(s) without an end")));
  EXPECT_TRUE(bounds(scene).min.isZero()) << "the transform ended with its file";
  EXPECT_EQ(scene.surfaces.at(1).name, "unnamed");
  folder_.write("pop.mgf", "xf\n");
  EXPECT_THAT(refusal("xf -t 1 0 0\ni pop.mgf\nxf\n"), HasSubstr("pop.mgf:1"));
  EXPECT_THAT(refusal("o\n"), HasSubstr("not begun"));
}

TEST_F(MgfReader, NamesFileAndLineOfEveryMistake) {
  for (const char* bad : {"f a b x",
                          "f a b",
                          "p 1 2",
                          "p 1 2 x",
                          "n 1 2 nan",
                          "v",
                          "m nobody",
                          "m x y z",
                          "m x=",
                          "rd",
                          "rd 1.2",
                          "rd -0.1",
                          "rd 0.5 0.5",
                          "ed -1",
                          "rs 0.5",
                          "ts 0.5",
                          "td 2",
                          "ir 1.5",
                          "sides 3",
                          "cxy 0.3",
                          "cct 3",
                          "cspec 400 700 1",
                          "cspec 700 400 1 1",
                          "cmix 1",
                          "cmix 1 nobody",
                          "cmix 1 a 2",
                          "sph a",
                          "sph a 0",
                          "sph zz 1",
                          "cyl a 1 a",
                          "cone a 1 b -1",
                          "ring a 0 1",
                          "torus a 1 2",
                          "prism a b c d 0",
                          "prism a b 1",
                          "xf",
                          "xf -t 1",
                          "xf -q",
                          "c nobody",
                          "fh a b c -"}) {
    const std::string message = refusal(kSquareVertices + bad + "\nf a b c d\nxf -t 1 0 0\n");
    if (std::string(bad) == "v" || std::string(bad) == "fh a b c -")
      EXPECT_EQ(message, "accepted") << bad;
    else
      EXPECT_THAT(message, HasSubstr("room.mgf:9: ")) << bad;
  }
}

TEST_F(MgfReader, ColoursAreJudgedWhenAFaceUsesThem) {
  // A library of colours as it is distributed, with ones that no light has, among them parts of daylight.
  folder_.write("lights.mgf",
                "c flame =\ncxy 0.4 0\nc dark =\ncspec 400 700 0 0\nc part =\ncspec 400 700 3 0 -1 -9\n"
                "c infrared =\ncspec 900 1000 1 1\nc red =\ncxy 0.735 0.266\n"
                "m of_flame =\nc flame\nrd 0.5\nm black =\nc dark\nrd 0\ned 0\n");
  const std::string library = "i lights.mgf\n" + kSquareVertices;
  EXPECT_EQ(test::face_count(read(library + "m black\nf a b c\nm fine =\nc red\nrd 0.2\nf a b c\n")), 2U);
  for (const auto& [use, given] :
       {std::pair("m of_flame\nf a b c\n", "lights.mgf:2"),
        std::pair("c dark\ned 9\nf a b c\n", "lights.mgf:4"),
        std::pair("m m =\nc infrared\nrs 0.1 0\nsph a 1\n", "lights.mgf:8"),
        std::pair("m m =\nc\ncmix 1 flame 1 red\ntd 1\nf a b c\n", "room.mgf:12")}) {
    const std::string message = refusal(library + use);
    EXPECT_THAT(message, HasSubstr("room.mgf:1")) << use;
    EXPECT_THAT(message, HasSubstr(given)) << use;
  }
}

TEST_F(MgfReader, StopsIncludesThatMultiply) {
  folder_.write("f0.mgf", "c x =\n");
  for (int i = 1; i <= 7; ++i) {
    std::ostringstream text;
    for (int k = 0; k < 10; ++k) text << "i f" << i - 1 << ".mgf\n";
    folder_.write(std::string("f").append(std::to_string(i)).append(".mgf"), text.str());
  }
  const std::string message = refusal("i f7.mgf\n");
  EXPECT_THAT(message, HasSubstr("files are included"));
  EXPECT_THAT(message, HasSubstr("room.mgf -> f7.mgf -> f6.mgf"));
}

TEST_F(RunawayMgf, ArraysAreStopped) {
  EXPECT_THAT(refusal("xf -a 9000000 -t 0 0 0\nxf -a 9000000 -t 0 0 0\nxf\nxf\n"), HasSubstr("entities"));
  EXPECT_THAT(refusal("xf -a 9000000 -t 0 0 0\no again\nxf\n"), HasSubstr("nested"));
}

TEST_F(MgfReader, AcceptsContinuedLinesCommentsAndCarriageReturns) {
  const Scene scene =
      read("#comment without blank\r\n# two \\\r\n lines f x y z\r\nv a =\r\n\tp 0 0 \\\r\n0\r\n" +
           kSquareVertices + "f a b \\\n c d\n");
  EXPECT_EQ(test::face_count(scene), 1U);
}

}  // namespace
}  // namespace reemit

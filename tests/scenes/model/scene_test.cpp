#include "scenes/model/scene.h"

#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/refusal.h"

namespace reemit {
namespace {

using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// A 2 m square lamp of RGB radiance with a colourless wall behind it.
Scene small_room() {
  Scene scene;
  scene.source = "room.test";
  scene.bands = BandSet::rgb();
  Material wall;
  wall.name = "wall";
  wall.reflectance = Eigen::Array3d(0.5, 0.5, 0.5);
  wall.emitted_radiance = Spectrum::Zero(3);
  Material lamp = wall;
  lamp.name = "lamp";
  lamp.emitted_radiance = Eigen::Array3d(3, 2, 1);
  scene.materials = {wall, lamp};
  for (std::size_t i = 0; i < 2; ++i) {
    Surface s;
    s.name = i == 0 ? "back" : "light";
    s.source = "room.test";
    s.material = MaterialId(i);
    const double z = static_cast<double>(i);
    s.positions = {{0, 0, z}, {2, 0, z}, {2, 2, z}, {0, 2, z}};
    s.faces.push_back({{0, 1, 2, 3}, {}, {}, 7});
    scene.surfaces.push_back(s);
  }
  return scene;
}

std::string refusal(const std::function<void(Scene&)>& spoil) {
  Scene scene = small_room();
  spoil(scene);
  return test::refusal_of([&] { finish_scene(scene); });
}

TEST(FinishScene, AcceptsASoundRoomWithoutWarnings) {
  Scene scene = small_room();
  finish_scene(scene);
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_EQ(scene.bands.kind(), BandKind::kRgb);
  EXPECT_EQ(bounds(scene).size(), Vec3(2, 2, 1));
}

TEST(FinishScene, RefusesALuminaireWithoutAnArea) {
  const std::string line = refusal([](Scene& s) {
    for (Vec3& p : s.surfaces[1].positions) p.y() = 0;
  });
  EXPECT_THAT(line, HasSubstr("'light'"));
  EXPECT_THAT(line, HasSubstr("without an area"));
  EXPECT_EQ(refusal([](Scene& s) {
              for (Vec3& p : s.surfaces[0].positions) p.y() = 0;
            }),
            "accepted")
      << "what does not emit may be degenerate: the mesher reports it";
}

TEST(FinishScene, RefusesRoundShapesThatAreNone) {
  const auto of = [](const CurvedShape& shape) {
    return refusal([&](Scene& s) { s.surfaces[1].shapes = {shape}; });
  };
  const Vec3 up(0, 0, 1);
  EXPECT_EQ(of(Sphere{{0, 0, 0}, 0.5}), "accepted");
  EXPECT_EQ(of(Disk{{0, 0, 0}, up, 0.5, 0.2}), "accepted");
  EXPECT_EQ(of(Cone{{0, 0, 0}, up, 0.5, 0}), "accepted");
  for (const CurvedShape& shape : std::initializer_list<CurvedShape>{
           Sphere{{0, 0, 0}, 0}, Sphere{{0, 0, 0}, -0.5}, Disk{{0, 0, 0}, up, 0.5, -0.3},
           Disk{{0, 0, 0}, up, 0.5, 0.5}, Disk{{0, 0, 0}, up, 0.5, 0.9}, Disk{{0, 0, 0}, Vec3::Zero(), 0.5},
           Disk{{0, 0, 0}, 2 * up, 0.5}, Cylinder{{0, 0, 0}, up, -1}, Cylinder{up, up, 1},
           Cone{{0, 0, 0}, up, 0.5, -0.2}, Cone{{0, 0, 0}, up, 0, 0}})
    EXPECT_THAT(of(shape), AnyOf(HasSubstr("no area"), HasSubstr("not a number")));
}

TEST(FinishScene, NamesTheMaterialWithBadValues) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {1.0001, -0.1, nan, inf}) {
    const std::string message = refusal([bad](Scene& s) { s.materials[0].reflectance[1] = bad; });
    EXPECT_THAT(message, HasSubstr("wall")) << bad;
    EXPECT_THAT(message, HasSubstr("[0, 1]")) << bad;
  }
  for (const double bad : {-1.0, nan, inf})
    EXPECT_THAT(refusal([bad](Scene& s) { s.materials[1].emitted_radiance[2] = bad; }), HasSubstr("lamp"));
  EXPECT_THAT(refusal([](Scene& s) { s.materials[0].reflectance = Spectrum::Zero(2); }),
              HasSubstr("one value per band"));
  EXPECT_THAT(
      refusal([](Scene& s) { s.materials[1].two_sided = false, s.materials[1].emits_both_sides = true; }),
      HasSubstr("one-sided"));
  EXPECT_EQ(refusal([](Scene& s) { s.materials[0].reflectance.setOnes(); }), "accepted");
}

TEST(FinishScene, NamesTheFaceWithBadGeometry) {
  EXPECT_THAT(refusal([](Scene& s) { s.surfaces[1].faces[0].outer[2] = 4; }), HasSubstr("room.test:7"));
  EXPECT_THAT(refusal([](Scene& s) { s.surfaces[1].faces[0].outer.resize(2); }), HasSubstr("'light'"));
  EXPECT_THAT(refusal([](Scene& s) { s.surfaces[0].positions[0].y() = std::nan(""); }),
              HasSubstr("coordinate"));
  EXPECT_THAT(refusal([](Scene& s) { s.surfaces[0].faces[0].holes = {{0, 1}}; }), HasSubstr("3 vertices"));
  EXPECT_THAT(refusal([](Scene& s) {
                s.surfaces[0].faces[0].normals = {0, 0, 0, 0};
              }),
              HasSubstr("normal index"));
  EXPECT_THAT(refusal([](Scene& s) { s.surfaces[0].material = MaterialId(9); }), HasSubstr("no material"));
  EXPECT_THAT(refusal([](Scene& s) { s.surfaces.clear(); }), HasSubstr("no faces"));
  EXPECT_THAT(refusal([](Scene& s) { s.surfaces.clear(), s.warnings = {"3 points were left out"}; }),
              HasSubstr("3 points were left out"));
}

TEST(FinishScene, RepairsShadingNormals) {
  Scene scene = small_room();
  scene.surfaces[0].normals = {{0, 0, 2}};
  scene.surfaces[0].faces[0].normals = {0, 0, 0, 0};
  scene.surfaces[1].normals = {{0, 0, 0}};
  scene.surfaces[1].faces[0].normals = {0, 0, 0, 0};
  finish_scene(scene);
  EXPECT_EQ(scene.surfaces[0].normals[0], Vec3(0, 0, 1));
  EXPECT_THAT(scene.surfaces[1].faces[0].normals, IsEmpty());
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("shading normal")));
}

TEST(FinishScene, DropsEmptySurfacesAndSizesEmptySpectra) {
  Scene scene = small_room();
  scene.surfaces.push_back({"nothing", "", MaterialId(0), {}, {}, {}, false, {}, {}});
  scene.materials[0].emitted_radiance.resize(0);
  finish_scene(scene);
  EXPECT_EQ(scene.surfaces.size(), 2U);
  EXPECT_EQ(scene.materials[0].emitted_radiance.size(), 3);
}

TEST(FinishScene, TransportsOneBandWhenNothingHasColour) {
  Scene scene = small_room();
  scene.materials[1].emitted_radiance = Eigen::Array3d(4, 4, 4);
  scene.materials[0].non_diffuse.specular_reflectance = Eigen::Array3d(0.1, 0.1, 0.1);
  scene.lights.emplace_back(PointLight{"bulb", {0, 0, 1}, Eigen::Array3d(2, 2, 2)});
  finish_scene(scene);
  EXPECT_EQ(scene.bands.kind(), BandKind::kGrey);
  ASSERT_EQ(scene.materials[1].emitted_radiance.size(), 1);
  EXPECT_DOUBLE_EQ(scene.materials[1].emitted_radiance[0], 4);
  EXPECT_DOUBLE_EQ(scene.materials[0].reflectance[0], 0.5);
  EXPECT_DOUBLE_EQ(std::get<PointLight>(scene.lights[0]).intensity[0], 2);
  EXPECT_EQ(scene.materials[0].non_diffuse.specular_reflectance.size(), 1);

  Scene coloured = small_room();
  coloured.materials[1].emitted_radiance = Eigen::Array3d(4, 4, 4);
  coloured.lights.emplace_back(PointLight{"bulb", {0, 0, 1}, Eigen::Array3d(2, 2, 1)});
  finish_scene(coloured);
  EXPECT_EQ(coloured.bands.kind(), BandKind::kRgb);
}

TEST(FinishScene, GlossAndOpalSheetsNeedNoWarning) {
  Scene scene = small_room();
  scene.materials[0].non_diffuse.specular_reflectance = Eigen::Array3d(0.25, 0.25, 0.25);
  scene.materials[0].non_diffuse.roughness = 0.1;
  scene.materials[0].non_diffuse.diffuse_transmittance = Eigen::Array3d(0.2, 0.2, 0.2);
  scene.materials[0].two_sided = false;
  finish_scene(scene);
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_TRUE(scene.materials[0].two_sided) << "light that crosses a face leaves from its back";
}

TEST(FinishScene, WarnsOfLightOverMirrorsThatStillsLack) {
  Scene scene = small_room();
  scene.materials[0].non_diffuse.specular_reflectance = Eigen::Array3d(0.25, 0.25, 0.25);
  Scene without = scene;
  finish_scene(without);
  EXPECT_TRUE(without.warnings.empty()) << "rays meet luminaires with an area";
  scene.lights.emplace_back(PointLight{"bulb", {0, 0, 1}, Eigen::Array3d(2, 2, 2)});
  Scene rough = scene;
  rough.materials[0].non_diffuse.roughness = 0.1;
  finish_scene(rough);
  EXPECT_TRUE(rough.warnings.empty()) << "shadow rays find what gloss spreads";
  finish_scene(scene);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("without area and mirrors or bodies of glass ('wall')")));
}

TEST(FinishScene, WarnsOfDarknessAndUnits) {
  Scene dark = small_room();
  dark.materials[1].emitted_radiance.setZero();
  finish_scene(dark);
  EXPECT_THAT(dark.warnings, Contains(HasSubstr("no luminaire")));

  for (const double scale : {1000.0, 0.01}) {
    Scene scene = small_room();
    for (Surface& s : scene.surfaces)
      for (Vec3& p : s.positions) p *= scale;
    finish_scene(scene);
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("metres"))) << scale;
  }
}

TEST(FinishScene, ChecksLights) {
  const auto with = [](const PunctualLight& light) {
    return refusal([&light](Scene& s) { s.lights.push_back(light); });
  };
  const Spectrum power = Eigen::Array3d(1, 1, 1);
  EXPECT_EQ(with(PointLight{"a", {0, 0, 0}, power}), "accepted");
  EXPECT_THAT(with(PointLight{"a", {0, 0, 0}, -power}), HasSubstr("light 'a'"));
  EXPECT_EQ(with(SpotLight{"b", {0, 0, 0}, {0, 0, -3}, power, 0.1, 0.5}), "accepted");
  EXPECT_THAT(with(SpotLight{"b", {0, 0, 0}, {0, 0, 0}, power, 0.1, 0.5}), HasSubstr("direction"));
  EXPECT_THAT(with(SpotLight{"b", {0, 0, 0}, {0, 0, 1}, power, 0.5, 0.5}), HasSubstr("cone"));
  EXPECT_THAT(with(DirectionalLight{"c", {0, 0, std::nan("")}, power}), HasSubstr("light 'c'"));
}

TEST(FinishScene, RefusesLightsThatEmitNothing) {
  const auto with = [](const PunctualLight& light) {
    return refusal([&light](Scene& s) { s.lights.push_back(light); });
  };
  const Spectrum none = Eigen::Array3d(0, 0, 0);
  const Spectrum bad = Eigen::Array3d(1, std::nan(""), 1);
  for (const Spectrum& power : {none, bad, Spectrum(-Eigen::Array3d(0, 0, 1))})
    for (const PunctualLight& light : {PunctualLight(PointLight{"a", {0, 0, 0}, power}),
                                       PunctualLight(SpotLight{"a", {0, 0, 0}, {0, 0, -1}, power, 0.1, 0.5}),
                                       PunctualLight(DirectionalLight{"a", {0, 0, -1}, power})})
      EXPECT_THAT(with(light), HasSubstr("light 'a'"));
  EXPECT_THAT(with(PointLight{"a", {0, 0, 0}, none}), HasSubstr("emits nothing"));
  EXPECT_THAT(with(PointLight{"a", {0, 0, 0}, Spectrum()}), HasSubstr("emits nothing"));
}

TEST(FinishScene, ChecksMeasuredLuminaires) {
  PhotometricLight good;
  good.name = "m";
  good.position = Vec3::Zero();
  good.table =
      std::make_shared<const IntensityTable>(PhotometricType::kC, std::vector<double>{0, 90},
                                             std::vector<double>{0, 360}, std::vector<double>(4, 1.0));
  good.intensity_per_candela = Eigen::Array3d(1, 1, 1);
  const auto with = [&good](const std::function<void(PhotometricLight&)>& spoil) {
    PhotometricLight light = good;
    spoil(light);
    return refusal([&light](Scene& s) { s.lights.emplace_back(light); });
  };
  EXPECT_EQ(with([](PhotometricLight&) {}), "accepted");
  EXPECT_EQ(with([](PhotometricLight& l) { l.orientation(0, 0) = -1; }), "accepted") << "mirrored";
  EXPECT_THAT(with([](PhotometricLight& l) { l.orientation *= 2; }), HasSubstr("axes"));
  EXPECT_THAT(with([](PhotometricLight& l) { l.orientation(0, 0) = std::nan(""); }), HasSubstr("axes"));
  EXPECT_THAT(with([](PhotometricLight& l) { l.position.x() = std::nan(""); }), HasSubstr("position"));
  EXPECT_THAT(with([](PhotometricLight& l) { l.table = nullptr; }), HasSubstr("no intensities"));
  EXPECT_THAT(with([](PhotometricLight& l) { l.opening.width = -1; }), HasSubstr("opening"));
  EXPECT_THAT(with([](PhotometricLight& l) { l.intensity_per_candela.setZero(); }),
              HasSubstr("emits nothing"));

  const auto hash = [](const PhotometricLight& light) {
    Scene scene = small_room();
    scene.lights.emplace_back(light);
    return content_hash(scene);
  };
  std::set<std::string> hashes{hash(good)};
  PhotometricLight other = good;
  other.name = "another";
  EXPECT_EQ(hash(other), hash(good));
  const auto differs = [&](const std::function<void(PhotometricLight&)>& change) {
    PhotometricLight changed = good;
    change(changed);
    return hashes.insert(hash(changed)).second;
  };
  EXPECT_TRUE(differs([](PhotometricLight& l) { l.position.x() = 1; }));
  EXPECT_TRUE(differs([](PhotometricLight& l) { l.orientation(0, 0) = -1; }));
  EXPECT_TRUE(differs([](PhotometricLight& l) { l.intensity_per_candela[1] = 2; }));
  EXPECT_TRUE(differs([](PhotometricLight& l) { l.opening.shape = LuminousOpening::Shape::kBox; }));
  EXPECT_TRUE(differs([](PhotometricLight& l) { l.opening.height = 1; }));
  EXPECT_TRUE(differs([](PhotometricLight& l) {
    l.table =
        std::make_shared<const IntensityTable>(PhotometricType::kC, std::vector<double>{0, 90},
                                               std::vector<double>{0, 360}, std::vector<double>(4, 2.0));
  }));
}

TEST(FinishScene, ChecksCamerasAndMakesTheirNamesUnique) {
  const auto with = [](const std::function<void(Camera&)>& spoil) {
    return refusal([&spoil](Scene& s) {
      Camera camera;
      camera.name = "view";
      spoil(camera);
      s.cameras.push_back(camera);
    });
  };
  EXPECT_THAT(with([](Camera& c) { c.look_at = c.eye; }), HasSubstr("camera 'view'"));
  EXPECT_THAT(with([](Camera& c) { c.up = {0, 0, 5}; }), HasSubstr("up"));
  EXPECT_THAT(with([](Camera& c) { c.vertical_fov_deg = 180; }), HasSubstr("field of view"));
  EXPECT_THAT(with([](Camera& c) { c.width = 0; }), HasSubstr("pixels"));
  EXPECT_THAT(with([](Camera& c) { c.eye.x() = std::nan(""); }), HasSubstr("eye"));

  Scene scene = small_room();
  scene.cameras.resize(4);
  scene.cameras[0].name = scene.cameras[1].name = "view";
  scene.cameras[2].name = "view_2";
  finish_scene(scene);
  EXPECT_EQ(scene.cameras[1].name, "view_2");
  EXPECT_EQ(scene.cameras[2].name, "view_2_2");
  EXPECT_EQ(scene.cameras[3].name, "camera");
}

TEST(ContentHash, DependsOnWhatLightSeesAndNothingElse) {
  const std::string original = content_hash(small_room());
  EXPECT_EQ(original.size(), 16U);
  EXPECT_EQ(content_hash(small_room()), original);
  const auto changed = [](const std::function<void(Scene&)>& change) {
    Scene scene = small_room();
    change(scene);
    return content_hash(scene);
  };
  EXPECT_EQ(changed([](Scene& s) { s.name = s.source = "other"; }), original);
  EXPECT_EQ(changed([](Scene& s) { s.surfaces[0].name = s.materials[0].name = "other"; }), original);
  EXPECT_EQ(changed([](Scene& s) { s.cameras.emplace_back(); }), original);
  EXPECT_EQ(changed([](Scene& s) { s.surfaces[0].positions.emplace_back(9, 9, 9); }), original)
      << "unused vertex";
  EXPECT_EQ(changed([](Scene& s) { s.surfaces[0].positions[0].x() = -0.0; }), original);

  const std::vector<std::string> different = {
      changed([](Scene& s) { s.surfaces[0].positions[0].x() = 1e-9; }),
      changed([](Scene& s) { s.materials[0].reflectance[0] = 0.51; }),
      changed([](Scene& s) { s.materials[1].emitted_radiance[2] = 1.1; }),
      changed([](Scene& s) { s.materials[0].two_sided = false; }),
      changed([](Scene& s) { s.materials[1].emits_both_sides = true; }),
      changed([](Scene& s) { s.materials[0].non_diffuse.specular_reflectance = Spectrum::Ones(3); }),
      changed([](Scene& s) { s.materials[0].non_diffuse.diffuse_transmittance = Spectrum::Ones(3); }),
      changed([](Scene& s) { s.materials[0].non_diffuse.specular_transmittance = Spectrum::Ones(3); }),
      changed([](Scene& s) { s.materials[0].non_diffuse.roughness = 0.1; }),
      changed([](Scene& s) { s.materials[0].non_diffuse.transmission_roughness = 0.1; }),
      changed([](Scene& s) { s.materials[0].non_diffuse.lobe = GlossLobe::kPhong; }),
      changed([](Scene& s) { s.materials[0].non_diffuse.index_of_refraction = 1.5; }),
      changed([](Scene& s) { s.materials[0].non_diffuse.angle_law = AngleLaw::kSchlick; }),
      changed([](Scene& s) { s.materials[0].non_diffuse.is_solid = true; }),
      changed([](Scene& s) { s.materials[0].non_diffuse.absorption_per_m = Spectrum::Ones(3); }),
      changed([](Scene& s) { s.surfaces[0].material = MaterialId(1); }),
      changed([](Scene& s) { std::swap(s.surfaces[0].faces[0].outer[0], s.surfaces[0].faces[0].outer[1]); }),
      changed([](Scene& s) {
        s.bands = BandSet::spectral({450, 550, 650});
      }),
      changed([](Scene& s) {
        s.lights.emplace_back(PointLight{"a", {0, 0, 0}, Spectrum::Ones(3)});
      }),
      changed([](Scene& s) {
        s.lights.emplace_back(DirectionalLight{"a", {0, 0, 1}, Spectrum::Ones(3)});
      }),
  };
  EXPECT_THAT(different, Not(Contains(original)));
  EXPECT_EQ(std::set<std::string>(different.begin(), different.end()).size(), different.size());
}

}  // namespace
}  // namespace reemit

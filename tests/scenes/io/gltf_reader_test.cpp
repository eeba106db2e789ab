#include "scenes/io/gltf/gltf_reader.h"

#include <filesystem>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/io/common/surface_geometry.h"
#include "tests/scenes/io/gltf_building.h"

namespace reemit {
namespace {

using nlohmann::json;
using test::expect_gltf_refused;
using test::expect_input_error;
using test::GltfBuilder;
using test::read_gltf;
using test::TempFolder;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

Vec3 normal_of(const Surface& surface, std::size_t face = 0) {
  const auto& loop = surface.faces[face].outer;
  const Vec3& a = surface.positions[loop[0]];
  return (surface.positions[loop[1]] - a).cross(surface.positions[loop[2]] - a).normalized();
}

TEST(GltfReader, ReadsASquare) {
  const Scene scene = read_gltf(GltfBuilder().square());
  ASSERT_EQ(scene.surfaces.size(), 1u);
  EXPECT_EQ(scene.surfaces[0].name, "square");
  EXPECT_EQ(scene.surfaces[0].faces.size(), 2u);
  EXPECT_EQ(normal_of(scene.surfaces[0]), Vec3(0, 0, 1));
  EXPECT_EQ(scene.bands, BandSet::rgb());
  const Material& material = scene.material_of(scene.surfaces[0]);
  EXPECT_TRUE((material.reflectance == 0.5).all());
  EXPECT_FALSE(material.two_sided);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfReader, GlbAndExternalBufferReadAlike) {
  const TempFolder folder;
  GltfBuilder gltf;
  gltf.square();
  const Scene glb = read_gltf_scene(folder.write("room.glb", gltf.glb()), {});
  folder.write("geo metry.bin", gltf.buffer());
  gltf.json["buffers"] = {{{"byteLength", gltf.buffer().size()}, {"uri", "geo%20metry.bin"}}};
  const Scene external = read_gltf_scene(folder.write("room.gltf", gltf.json.dump()), {});
  EXPECT_EQ(glb.surfaces.at(0).positions, external.surfaces.at(0).positions);
  EXPECT_EQ(glb.surfaces.at(0).faces[1].outer, external.surfaces.at(0).faces[1].outer);
  gltf.json["buffers"][0]["uri"] = "gone.bin";
  expect_input_error([&] { read_gltf_scene(folder.write("room.gltf", gltf.json.dump()), {}); },
                     {"#/buffers/0/uri", "gone.bin", "Put it beside the room"});
}

TEST(GltfReader, BuffersMayHaveMoreBytesThanTheySay) {
  const TempFolder folder;
  GltfBuilder gltf;
  gltf.square();
  const Scene exact = read_gltf_scene(folder.write("room.glb", gltf.glb()), {});
  folder.write("geo metry.bin", gltf.buffer() + std::string(8, '\0'));
  gltf.json["buffers"] = {{{"byteLength", gltf.buffer().size()}, {"uri", "geo%20metry.bin"}}};
  EXPECT_EQ(read_gltf_scene(folder.write("room.gltf", gltf.json.dump()), {}).surfaces.at(0).positions,
            exact.surfaces.at(0).positions);
  GltfBuilder embedded;
  embedded.square();
  json padded = json::parse(embedded.text());
  auto& uri = padded["buffers"][0]["uri"].get_ref<std::string&>();
  ASSERT_FALSE(uri.ends_with('='));
  uri += "AAAA";
  EXPECT_EQ(read_gltf_scene(folder.write("room.gltf", padded.dump()), {}).surfaces.at(0).positions,
            exact.surfaces.at(0).positions);
  json document = json::parse(embedded.text());
  document["buffers"][0]["byteLength"] = embedded.buffer().size() - 1;
  for (json& view : document["bufferViews"])  // the last byte is nobody's
    if (view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>() ==
        embedded.buffer().size())
      view["byteLength"] = view["byteLength"].get<std::size_t>() - 1;
  expect_input_error([&] { read_gltf_scene(folder.write("room.gltf", document.dump()), {}); },
                     {"#/meshes/0"});
}

TEST(GltfReader, IndexTypesAndNoIndices) {
  for (int type = 0; type < 4; ++type) {
    GltfBuilder gltf;
    gltf.square();
    json& primitive = gltf.json["meshes"][0]["primitives"][0];
    if (type == 0) primitive["indices"] = gltf.bytes({0, 1, 2, 0, 2, 3});
    if (type == 2) primitive["indices"] = gltf.ints({0, 1, 2, 0, 2, 3});
    if (type == 3) primitive.erase("indices");
    const Scene scene = read_gltf(gltf);
    EXPECT_EQ(scene.surfaces.at(0).faces.size(), type == 3 ? 1u : 2u);
    EXPECT_EQ(normal_of(scene.surfaces[0]), Vec3(0, 0, 1));
  }
}

TEST(GltfReader, StripsAndFansKeepTheirFronts) {
  GltfBuilder gltf;
  gltf.square();
  json& primitive = gltf.json["meshes"][0]["primitives"][0];
  primitive["mode"] = 5;
  primitive["indices"] = gltf.shorts({0, 1, 3, 2, 2});  // The last triangle collapses.
  const Scene strip = read_gltf(gltf);
  ASSERT_EQ(strip.surfaces.at(0).faces.size(), 2u);
  EXPECT_NEAR(surface_area(strip.surfaces[0]), 1, 1e-12);
  EXPECT_EQ(normal_of(strip.surfaces[0], 0), Vec3(0, 0, 1));
  EXPECT_EQ(normal_of(strip.surfaces[0], 1), Vec3(0, 0, 1));
  EXPECT_THAT(strip.notes, Contains(HasSubstr("1 triangle(s)")));
  primitive["mode"] = 6;
  primitive["indices"] = gltf.shorts({0, 1, 2, 3});
  const Scene fan = read_gltf(gltf);
  EXPECT_NEAR(surface_area(fan.surfaces.at(0)), 1, 1e-12);
  EXPECT_EQ(normal_of(fan.surfaces[0], 1), Vec3(0, 0, 1));
}

TEST(GltfReader, PointsAndLinesAreWarnedOf) {
  GltfBuilder gltf;
  gltf.square();
  json line = gltf.json["meshes"][0]["primitives"][0];
  line["mode"] = 1;
  gltf.json["meshes"][0]["primitives"].push_back(line);
  const Scene scene = read_gltf(gltf);
  EXPECT_EQ(scene.surfaces.size(), 1u);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("1 mesh primitive(s) made of points or lines")));
}

TEST(GltfReader, NodesFormHierarchies) {
  GltfBuilder gltf;
  gltf.square();
  const double half = std::sqrt(0.5);
  gltf.json["nodes"][0]["translation"] = {1, 0, 0};
  // Turns (1,0,0) to (0,1,0), then scales by 2, then moves by (0,0,5).
  const int parent = gltf.node({{"children", {0}},
                                {"rotation", {0, 0, half, half}},
                                {"scale", {2, 2, 2}},
                                {"translation", {0, 0, 5}}});
  gltf.json["scenes"] = {{{"nodes", {parent}}}};
  const Scene scene = read_gltf(gltf);
  EXPECT_NEAR((scene.surfaces.at(0).positions[0] - Vec3(0, 2, 5)).norm(), 0, 1e-9);
  gltf.json["nodes"][1] = {{"children", {0}}, {"matrix", {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 0, 0, 5, 1}}};
  EXPECT_NEAR((read_gltf(gltf).surfaces.at(0).positions[0] - Vec3(0, 2, 5)).norm(), 0, 1e-9);
}

TEST(GltfReader, MirroredNodesKeepTheirFronts) {
  GltfBuilder gltf;
  gltf.square();
  gltf.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      gltf.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  gltf.json["nodes"][0]["scale"] = {-1, 1, 1};
  const Scene scene = read_gltf(gltf);
  EXPECT_EQ(scene.surfaces.at(0).positions[1].x(), -1);
  EXPECT_EQ(normal_of(scene.surfaces[0]), Vec3(0, 0, 1));
  EXPECT_EQ(scene.surfaces[0].normals[0], Vec3(0, 0, 1));
}

TEST(GltfReader, MeshesAreInstanced) {
  GltfBuilder gltf;
  gltf.square();
  gltf.node({{"name", "again"}, {"mesh", 0}, {"translation", {0, 0, 3}}});
  gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
      gltf.floats({0, 0, 0, 0, 0, 1, 0, 0, 2});
  const Scene scene = read_gltf(gltf);
  ASSERT_EQ(scene.surfaces.size(), 4u);
  EXPECT_EQ(scene.surfaces[2].name, "square[2]");
  EXPECT_EQ(scene.surfaces[2].positions[0].z(), 2);
  EXPECT_EQ(scene.surfaces[3].positions[0].z(), 3);
}

TEST(GltfReader, NamesThatComeAgainAreNumbered) {
  GltfBuilder gltf;
  gltf.square();
  gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"name", "bulb"}}};
  for (int i = 1; i <= 2; ++i) {
    gltf.node({{"name", "square"}, {"mesh", 0}, {"translation", {0, 0, i}}});
    gltf.node({{"name", "lamp"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  }
  const Scene scene = read_gltf(gltf);
  ASSERT_EQ(scene.surfaces.size(), 3u);
  EXPECT_EQ(scene.surfaces[0].name, "square");
  EXPECT_EQ(scene.surfaces[1].name, "square #2");
  EXPECT_EQ(scene.surfaces[2].name, "square #3");
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(std::get<PointLight>(scene.lights[0]).name, "bulb");
  EXPECT_EQ(std::get<PointLight>(scene.lights[1]).name, "bulb #2");
}

TEST(GltfReader, ReadsTheDefaultScene) {
  GltfBuilder gltf;
  gltf.square();
  gltf.node({{"name", "other"}, {"mesh", 0}});
  gltf.json["scenes"] = {{{"nodes", {0}}}, {{"name", "second"}, {"nodes", {1}}}};
  EXPECT_EQ(read_gltf(gltf).surfaces.at(0).name, "square");
  gltf.json["scene"] = 1;
  const Scene scene = read_gltf(gltf);
  ASSERT_EQ(scene.surfaces.size(), 1u);
  EXPECT_EQ(scene.surfaces[0].name, "other");
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("scene 1 \"second\" of 2")));
}

TEST(GltfReader, ScenesMayNameChildrenOfNodesThatTheyLeaveOut) {
  GltfBuilder gltf;
  gltf.square();
  gltf.node({{"children", {0}}, {"translation", {0, 0, 5}}});
  gltf.json["scenes"] = {{{"nodes", {0}}}};
  const Scene child = read_gltf(gltf);
  ASSERT_EQ(child.surfaces.size(), 1u);
  EXPECT_EQ(child.surfaces[0].positions[0].z(), 5);
  EXPECT_THAT(child.warnings, Contains(AllOf(HasSubstr("names 1 node(s)"), HasSubstr("node \"square\""))));
  gltf.json["scenes"] = {{{"nodes", {0, 1, 0}}}};
  EXPECT_EQ(read_gltf(gltf).surfaces.size(), 1u) << "what is below a node that is named is there once";
  gltf.json["scenes"] = {{{"nodes", {1, 1}}}};
  EXPECT_EQ(read_gltf(gltf).surfaces.size(), 1u);
}

TEST(GltfReader, NormalizedAndSparseAccessors) {
  GltfBuilder gltf;
  gltf.square();
  const int normalized = gltf.accessor(
      std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 32767, 32767, 0, 0, 32767, 0}, 5122, "VEC3", 3);
  gltf.json["accessors"][normalized]["normalized"] = true;
  json& attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["POSITION"] = normalized;
  gltf.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  EXPECT_NEAR(surface_area(read_gltf(gltf).surfaces.at(0)), 1, 1e-12);

  const int indices = gltf.view(std::vector<std::uint8_t>{2});
  const int values = gltf.view(std::vector<float>{3, 3, 0});
  attributes["POSITION"] = 0;
  gltf.json["accessors"][0]["sparse"] = {{"count", 1},
                                         {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", values}}}};
  EXPECT_EQ(read_gltf(gltf).surfaces.at(0).positions[2], Vec3(3, 3, 0));
  gltf.json["accessors"][0]["sparse"]["indices"]["bufferView"] = gltf.view(std::vector<std::uint8_t>{4});
  expect_gltf_refused(gltf, {"sparse index 4 is out of range"});
}

TEST(GltfReader, CamerasAndLights) {
  GltfBuilder gltf;
  gltf.square();
  gltf.json["cameras"] = {
      {{"type", "perspective"},
       {"name", "view"},
       {"perspective", {{"yfov", 1.0}, {"aspectRatio", 1.5}, {"znear", 0.1}}}},
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0.1}, {"zfar", 9}}}}};
  gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 358}, {"color", {1, 0.5, 0}}},
      {{"type", "spot"},
       {"name", "spot"},
       {"intensity", 179},
       {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.5}}}},
      {{"type", "directional"}, {"intensity", 1790}}};
  gltf.node({{"camera", 0}, {"translation", {0, 1, 4}}, {"scale", {3, 3, 3}}});
  gltf.node({{"camera", 1}});
  for (int i = 0; i < 3; ++i)
    gltf.node({{"translation", {0, 5, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  const Scene scene = read_gltf(gltf);
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.cameras[0].eye, Vec3(0, 1, 4));
  EXPECT_NEAR((scene.cameras[0].look_at - Vec3(0, 1, 3)).norm(), 0, 1e-12);
  EXPECT_NEAR(scene.cameras[0].vertical_fov_deg, 180 / std::numbers::pi, 1e-9);
  EXPECT_EQ(scene.cameras[0].width, 768);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("orthographic")));
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(std::get<PointLight>(scene.lights[0]).intensity[1], 1);
  EXPECT_EQ(std::get<PointLight>(scene.lights[0]).position, Vec3(0, 5, 0));
  EXPECT_EQ(std::get<SpotLight>(scene.lights[1]).direction, Vec3(0, 0, -1));
  EXPECT_EQ(std::get<SpotLight>(scene.lights[1]).outer_angle, 0.5);
  EXPECT_NEAR(std::get<DirectionalLight>(scene.lights[2]).irradiance[0], 10, 1e-12);
  EXPECT_THAT(scene.notes, Contains(HasSubstr("179 lm/W")));
}

TEST(GltfReader, MorphTargetsMoveByTheWeightsOfMeshOrNode) {
  GltfBuilder gltf;
  gltf.square();
  const int up = gltf.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int aside = gltf.floats({4, 0, 0, 4, 0, 0, 4, 0, 0, 4, 0, 0});
  nlohmann::json& mesh = gltf.json["meshes"][0];
  mesh["primitives"][0]["targets"] = {{{"POSITION", up}}, {{"POSITION", aside}}};
  EXPECT_EQ(read_gltf(gltf).surfaces[0].positions[0], Vec3(0, 0, 0)) << "without weights";
  mesh["weights"] = {0.5, 0};
  gltf.node({{"mesh", 0}, {"weights", {0, 0.25}}});
  const Scene scene = read_gltf(gltf);
  EXPECT_EQ(scene.surfaces[0].positions[0], Vec3(0, 0, 0.5));
  EXPECT_EQ(scene.surfaces[1].positions[0], Vec3(1, 0, 0));
  mesh["primitives"][0]["targets"][0]["POSITION"] = gltf.floats({0, 0, 1});
  expect_gltf_refused(gltf, {"/meshes/0/primitives/0/targets/0/POSITION", "1 moves for 4 vertices"});
}

TEST(GltfReader, SpotsOfOneAngleHaveASharpEdge) {
  GltfBuilder gltf;
  gltf.square();
  gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"intensity", 179}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}}}}};
  gltf.node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  const Scene scene = read_gltf(gltf);
  ASSERT_EQ(scene.lights.size(), 1U);
  const auto& spot = std::get<SpotLight>(scene.lights[0]);
  EXPECT_EQ(spot.outer_angle, 0.5);
  EXPECT_GT(spot.inner_angle, 0.499);
  EXPECT_LT(spot.inner_angle, 0.5);
  gltf.json["extensions"]["KHR_lights_punctual"]["lights"][0]["spot"]["innerConeAngle"] = 0.6;
  expect_gltf_refused(gltf, {"cone angles"});
}

TEST(GltfReader, HiddenCamerasAndLightsCostNoRoom) {
  GltfBuilder gltf;
  gltf.square();
  gltf.json["cameras"] = {
      {{"type", "perspective"}, {"name", "view"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}};
  gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"name", "off"}, {"intensity", 0}},
      {{"type", "directional"}, {"name", "shrunk"}, {"intensity", 1790}},
      {{"type", "point"}, {"name", "on"}, {"intensity", 179}}};
  gltf.node({{"camera", 0}, {"scale", {0, 0, 0}}});
  for (int i = 0; i < 3; ++i)
    gltf.node({{"scale", {0, 0, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  const Scene scene = read_gltf(gltf);
  EXPECT_TRUE(scene.cameras.empty());
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(std::get<PointLight>(scene.lights[0]).name, "on");
  EXPECT_THAT(scene.warnings, Contains(AllOf(HasSubstr("\"view\""), HasSubstr("left out"))));
  EXPECT_THAT(scene.warnings, Contains(AllOf(HasSubstr("\"shrunk\""), HasSubstr("left out"))));
  EXPECT_THAT(scene.notes, Contains(AllOf(HasSubstr("\"off\""), HasSubstr("switched off"))));
}

TEST(GltfReader, RefusesBrokenNodeGraphs) {
  const auto graph = [](const json& nodes) {
    GltfBuilder gltf;
    gltf.square();
    for (const json& node : nodes) gltf.node(node);
    return gltf;
  };
  expect_gltf_refused(graph({{{"children", {2}}}, {{"children", {1}}}}),
                      {"room.gltf#/nodes/1: ", "its own ancestor"});
  expect_gltf_refused(graph({{{"children", {1}}}}), {"room.gltf#/nodes/1: ", "its own ancestor"});
  expect_gltf_refused(graph({{{"children", {0}}}, {{"children", {0}}}}),
                      {"#/nodes/0: node \"square\"", "a child of node 1 and again of node 2"});
  expect_gltf_refused(graph({{{"children", {7}}}}), {"#/nodes/1: ", "no child node 7"});
  expect_gltf_refused(graph({{{"mesh", 7}}}), {"no mesh 7"});
  expect_gltf_refused(graph({{{"camera", 7}}}), {"no camera 7"});
  expect_gltf_refused(graph({{{"rotation", {0, 0, 0, 0}}}}), {"quaternion"});
  expect_gltf_refused(graph({{{"scale", {1, 1}}}}), {"scale"});
  GltfBuilder chain;
  chain.square();
  for (int i = 0; i < 20000; ++i) chain.node({{"children", {i}}});
  EXPECT_EQ(read_gltf(chain).surfaces.size(), 1u);  // Deep, but a tree.
}

TEST(GltfReader, RefusesIndicesAndViewsOutOfRange) {
  const auto broken = [](auto change) {
    GltfBuilder gltf;
    gltf.square();
    change(gltf.json, gltf);
    return gltf;
  };
  const auto primitive = [](json& file) -> json& { return file["meshes"][0]["primitives"][0]; };
  expect_gltf_refused(broken([&](json& f, GltfBuilder& g) {
                        primitive(f)["indices"] = g.shorts({0, 1, 4});
                      }),
                      {"room.gltf#/meshes/0/primitives/0/indices: ", "index 4 is out of range"});
  expect_gltf_refused(broken([&](json& f, GltfBuilder&) { primitive(f)["attributes"]["POSITION"] = 99; }),
                      {"no accessor 99"});
  expect_gltf_refused(broken([&](json& f, GltfBuilder&) { primitive(f)["material"] = 5; }),
                      {"#/meshes/0/primitives/0/material: there is no material 5"});
  expect_gltf_refused(broken([&](json& f, GltfBuilder&) { primitive(f)["attributes"].erase("POSITION"); }),
                      {"no positions"});
  expect_gltf_refused(broken([](json& f, GltfBuilder&) { f["accessors"][0]["count"] = 5; }),
                      {"#/meshes/0/primitives/0/attributes/POSITION: accessor 0: 5 elements do not fit"});
  expect_gltf_refused(broken([](json& f, GltfBuilder&) { f["accessors"][0]["count"] = 4000000000000u; }),
                      {"do not fit"});
  expect_gltf_refused(broken([](json& f, GltfBuilder&) { f["accessors"][0]["byteOffset"] = 4; }),
                      {"do not fit"});
  expect_gltf_refused(broken([](json& f, GltfBuilder&) { f["accessors"][0]["bufferView"] = 9; }),
                      {"no buffer view 9"});
  expect_gltf_refused(broken([](json& f, GltfBuilder&) { f["accessors"][0]["type"] = "VEC2"; }),
                      {"2 components"});
  expect_gltf_refused(broken([](json& f, GltfBuilder&) {
                        f["accessors"][0].erase("bufferView");
                        f["accessors"][0]["count"] = 2000000000;
                      }),
                      {"2000000000 elements without data"});
  expect_gltf_refused(broken([](json& f, GltfBuilder&) { f["bufferViews"][0]["byteLength"] = 4000000000u; }),
                      {"ends outside"});
  expect_gltf_refused(broken([](json& f, GltfBuilder&) { f["bufferViews"][0]["buffer"] = 3; }), {"buffer 3"});
  expect_gltf_refused(broken([](json& f, GltfBuilder&) { f["bufferViews"][0]["byteStride"] = 8; }),
                      {"stride"});
  expect_gltf_refused(broken([](json& f, GltfBuilder&) {
                        f["scenes"] = {{{"nodes", {4}}}};
                      }),
                      {"#/scenes/0/nodes: scene 0 names node 4"});
}

TEST(GltfReader, ValuesOfAnotherTypeAreRefusedWhereTheyStand) {
  const auto refused = [](const char* pointer, const json& value, const char* place) {
    GltfBuilder gltf;
    gltf.square();
    gltf.json[json::json_pointer(pointer)] = value;
    expect_gltf_refused(gltf, {place});
  };
  refused("/accessors/1/componentType", 77, "room.gltf#/accessors/1/componentType: 77");
  refused("/accessors/0/count", "four", "room.gltf#/accessors/0/count: ");
  refused("/accessors/0/type", "VEC9", "room.gltf#/accessors/0/type: ");
  refused("/accessors/0", 3, "room.gltf#/accessors/0: ");
  refused("/bufferViews/0/byteLength", json(), "room.gltf#/bufferViews/0/byteLength: ");
  refused("/nodes/0/translation", {0, "a", 0}, "room.gltf#/nodes/0/translation/1: ");
  refused("/nodes/0/matrix", "unit", "room.gltf#/nodes/0/matrix: ");
  refused("/materials/0/doubleSided", 1, "room.gltf#/materials/0/doubleSided: ");
  refused("/nodes/0/children", json::array({"a"}), "room.gltf#/nodes/0/children/0: ");
  refused("/meshes/0/primitives/0/attributes", 1, "room.gltf#/meshes/0/primitives/0/attributes: ");
  refused("/materials/0/emissiveFactor", {1, "a", 1}, "room.gltf#/materials/0/emissiveFactor/1: ");
}

TEST(GltfReader, RefusesExtensionsThatChangeTheGeometry) {
  GltfBuilder gltf;
  gltf.square();
  gltf.json["extensionsRequired"] = {"EXT_strange"};
  expect_gltf_refused(gltf, {"EXT_strange"});
  gltf.json.erase("extensionsRequired");
  gltf.json["asset"]["version"] = "1.0";
  expect_gltf_refused(gltf, {"version \"1.0\""});
}

TEST(GltfReader, FilesThatAreNoGltfAreNamedForWhatTheyAre) {
  const TempFolder folder;
  const auto refused = [&](const char* name, const std::string& text,
                           std::initializer_list<const char*> parts) {
    const auto file = folder.write(name, text);
    expect_input_error([&] { read_gltf_scene(file, {}); }, parts);
  };
  refused("room.glb", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n",
          {"Git LFS", "git lfs pull"});
  refused("room.glb", "<!DOCTYPE html>", {"no GLB file"});
  refused("room.gltf", R"({"asset": {"version": "1.0"}, "buffers": {"a": {}}})", {"glTF 1.0"});
}

TEST(GltfReader, RefusesDamagedGlb) {
  const TempFolder folder;
  GltfBuilder gltf;
  gltf.square();
  const std::string whole = gltf.glb();
  const auto refused = [&](std::size_t offset, std::uint32_t value,
                           std::initializer_list<const char*> parts) {
    std::string bytes = whole;
    for (std::size_t i = 0; i < 4; ++i) bytes[offset + i] = static_cast<char>(value >> (8 * i));
    const auto file = folder.write("room.glb", bytes);
    expect_input_error([&] { read_gltf_scene(file, {}); }, parts);
  };
  refused(4, 1, {"GLB version 1"});
  refused(8, 100000, {"promises 100000 bytes"});
  refused(12, 0xfffffff0u, {"JSON chunk of 4294967280 bytes does not fit"});
  refused(16, 0, {"not JSON"});
  const std::size_t binary_chunk = whole.find(std::string("BIN\0", 4)) - 4;
  refused(binary_chunk, static_cast<std::uint32_t>(gltf.buffer().size() + 8),
          {"binary chunk", "does not fit"});
}

TEST(GltfReader, ReadsTheSharedCornellBox) {
  const std::filesystem::path file = std::filesystem::path(REEMIT_SOURCE_DIR) /
                                     "../shared/scenes/gltf/cornell/cornellBox-2.80-Eevee-gltf.gltf";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared scenes here";
  const Scene scene = read_gltf_scene(file, {});
  EXPECT_EQ(scene.surfaces.size(), 23u);
  EXPECT_TRUE(scene.cameras.empty());
  EXPECT_TRUE(std::any_of(scene.materials.begin(), scene.materials.end(),
                          [](const Material& m) { return bool{m.textures.reflectance}; }));
}

}  // namespace
}  // namespace reemit

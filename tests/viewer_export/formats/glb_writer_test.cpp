#include <cmath>
#include <cstring>
#include <limits>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/model/error.h"
#include "tests/support/glb_file.h"
#include "tests/support/temp_folder.h"
#include "tests/viewer_export/formats/sample_vertices.h"
#include "viewer_export/formats/export_table.h"
#include "viewer_export/formats/vertex_export.h"

namespace reemit {
namespace {

using test::expect_valid_glb;
using test::read_glb;
using test::sample_vertices;
using test::TempFolder;

// Numbers of a float attribute of the only primitive of a mesh.
std::vector<float> attribute(const tinygltf::Model& model, std::size_t mesh, const std::string& name) {
  const auto& attributes = model.meshes.at(mesh).primitives.at(0).attributes;
  if (!attributes.contains(name)) {
    ADD_FAILURE() << "no attribute " << name;
    return {};
  }
  const auto& accessor = model.accessors.at(static_cast<std::size_t>(attributes.at(name)));
  const auto& view = model.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
  const std::size_t components = accessor.type == TINYGLTF_TYPE_VEC3 ? 3 : 1;
  EXPECT_EQ(view.byteStride, 4 * components);
  std::vector<float> values(accessor.count * components);
  std::memcpy(values.data(), model.buffers.at(0).data.data() + view.byteOffset + accessor.byteOffset,
              values.size() * sizeof(float));
  return values;
}

TEST(GlbWriter, IsReadBackByTinyGltf) {
  const TempFolder folder;
  const VertexData data = sample_vertices(BandSet::rgb());
  write_vertex_data(data, folder / "a.glb");
  const tinygltf::Model model = read_glb(folder / "a.glb");
  ASSERT_EQ(model.meshes.size(), 2U);  // a surface without triangles has none
  EXPECT_EQ(model.meshes[0].name, data.surface_names[0]);
  EXPECT_EQ(model.meshes[1].name, data.surface_names[2]);
  EXPECT_EQ(model.materials.at(0).name, "oak");
  EXPECT_EQ(model.extensionsUsed, std::vector<std::string>{"KHR_materials_unlit"});
  const VertexColours colours = colours_of(data);
  const std::vector<std::size_t> vertices[] = {{0, 2, 4}, {1, 3, 5}};
  for (std::size_t m = 0; m < 2; ++m) {
    const auto position = attribute(model, m, "POSITION");
    const auto normal = attribute(model, m, "NORMAL");
    const auto colour = attribute(model, m, "COLOR_0");
    const auto radiance = attribute(model, m, "_RADIANCE");
    const auto irradiance = attribute(model, m, "_IRRADIANCE");
    const auto error = attribute(model, m, "_STDERR");
    const auto direct = attribute(model, m, "_DIRECT");
    const auto caustic = attribute(model, m, "_CAUSTIC");
    ASSERT_EQ(position.size(), 9U);
    for (std::size_t i = 0; i < 9; ++i) {
      const std::size_t v = vertices[m][i / 3];
      const auto axis = static_cast<Eigen::Index>(i % 3);
      EXPECT_EQ(position[i], static_cast<float>(data.positions[v][axis]));
      EXPECT_FLOAT_EQ(normal[i], static_cast<float>(data.normals[v][axis]));
      EXPECT_FLOAT_EQ(colour[i], static_cast<float>(colours.displayable(v)[axis]));
      EXPECT_EQ(radiance[i], data.radiance[3 * v + i % 3]);
      EXPECT_EQ(irradiance[i], data.irradiance[3 * v + i % 3]);
      EXPECT_EQ(error[i], data.radiance_stderr[3 * v + i % 3]);
      EXPECT_EQ(direct[i], data.direct_radiance[3 * v + i % 3]);
      EXPECT_EQ(caustic[i], data.caustic_radiance[3 * v + i % 3]);
      EXPECT_TRUE(colour[i] >= 0 && colour[i] <= 1);
    }
  }
}

TEST(GlbWriter, StatesUnitsSeedAndExposure) {
  const TempFolder folder;
  VertexData data = sample_vertices(BandSet::rgb());
  data.tone_map = ToneMap(std::exp2(-1), ToneMapSettings::kFixedWhite);
  write_vertex_data(data, folder / "a.glb");
  const tinygltf::Model model = read_glb(folder / "a.glb");
  const tinygltf::Value& extras = model.asset.extras;
  EXPECT_EQ(extras.Get("seed").GetNumberAsInt(), 77);
  EXPECT_EQ(extras.Get("gather rays").GetNumberAsInt(), 256);
  EXPECT_TRUE(extras.Get("relative error by noise").IsNumber());
  EXPECT_TRUE(extras.Get("room hash").IsString());
  EXPECT_THAT(extras.Get("units").Get<std::string>(), testing::HasSubstr("W/(m2 sr)"));
  EXPECT_EQ(extras.Get("exposure").GetNumberAsDouble(), 0.5);
}

TEST(GlbWriter, SpectralBandsBecomeAttributes) {
  const TempFolder folder;
  const VertexData data = sample_vertices(BandSet::spectral({450, 550.5}));
  write_vertex_data(data, folder / "a.glb");
  const tinygltf::Model model = read_glb(folder / "a.glb");
  EXPECT_EQ(attribute(model, 0, "_RADIANCE_450")[1], data.radiance[2 * 2]);
  EXPECT_EQ(attribute(model, 0, "_STDERR_550.5")[2], data.radiance_stderr[2 * 4 + 1]);
  EXPECT_FLOAT_EQ(attribute(model, 0, "_RADIANCE")[3], static_cast<float>(data.rgb(data.radiance, 2)[0]));
}

TEST(GlbWriter, FarRoomsKeepTheirShape) {
  const TempFolder folder;
  const VertexData data = sample_vertices(BandSet::rgb(), Vec3(1e7, -3e7, 0));
  write_vertex_data(data, folder / "a.glb");
  const tinygltf::Model model = read_glb(folder / "a.glb");
  const auto position = attribute(model, 1, "POSITION");
  ASSERT_EQ(model.nodes.at(1).translation.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(model.nodes[1].translation[i] + static_cast<double>(position[3 + i]),
                data.positions[3][static_cast<Eigen::Index>(i)], 1e-7);
}

TEST(GlbWriter, RoomsWithZUpAreTurnedByANode) {
  const TempFolder folder;
  VertexData data = sample_vertices(BandSet::rgb());
  write_vertex_data(data, folder / "y.glb");
  EXPECT_EQ(read_glb(folder / "y.glb").scenes.at(0).nodes.size(), 2U) << "y is up in glTF: nothing to turn";
  data.up = Vec3(0, 0, 1);
  write_vertex_data(data, folder / "z.glb");
  const tinygltf::Model model = read_glb(folder / "z.glb");
  ASSERT_EQ(model.scenes.at(0).nodes.size(), 1U);
  const tinygltf::Node& root = model.nodes.at(static_cast<std::size_t>(model.scenes[0].nodes[0]));
  EXPECT_EQ(root.children.size(), 2U);
  ASSERT_EQ(root.rotation.size(), 4U);
  const Eigen::Quaterniond turn(root.rotation[3], root.rotation[0], root.rotation[1], root.rotation[2]);
  EXPECT_LT((turn * data.up - Vec3(0, 1, 0)).norm(), 1e-12);
  EXPECT_LT((turn * Vec3(1, 0, 0) - Vec3(1, 0, 0)).norm(), 1e-12);
}

TEST(GlbWriter, BacksDoNotLieInTheirFronts) {
  const TempFolder folder;
  VertexData data = sample_vertices(BandSet::rgb());
  for (const std::size_t v : {1U, 3U, 5U}) data.on_back[v] = true;
  write_vertex_data(data, folder / "a.glb");
  const tinygltf::Model model = read_glb(folder / "a.glb");
  const auto front = attribute(model, 0, "POSITION");
  const auto back = attribute(model, 1, "POSITION");
  const double gap = back_gap(data);
  EXPECT_GT(gap, 1e-5 * 2.7);  // of the diagonal: what a depth buffer tells apart across a room
  EXPECT_LT(gap, 1e-4 * 2.7);
  for (std::size_t v = 0; v < 3; ++v)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      EXPECT_EQ(front[3 * v + k], static_cast<float>(data.positions[2 * v][axis]));
      EXPECT_FLOAT_EQ(back[3 * v + k], static_cast<float>(data.positions[2 * v + 1][axis] +
                                                          gap * data.normals[2 * v + 1][axis]));
    }
  for (const tinygltf::Material& material : model.materials) EXPECT_FALSE(material.doubleSided);
}

TEST(GlbWriter, BacksStayNearWhereTheRoomStandsInAWideGarden) {
  VertexData data = sample_vertices(BandSet::rgb());
  for (const std::size_t v : {1U, 3U, 5U}) data.on_back[v] = true;  // of a wall of 1.5 x 1 m
  data.positions[4] = Vec3(1e5, 0, 0);                              // of the floor
  EXPECT_GT(back_gap(data), 1);
  const std::vector<Vec3> moved = positions_for_viewing(data, back_gap(data));
  for (const std::size_t v : {1U, 3U, 5U})
    EXPECT_NEAR((moved[v] - data.positions[v]).norm(), 1e-3 * std::hypot(1.5, 1), 1e-9);
}

TEST(GlbWriter, NothingToDrawIsAnError) {
  const TempFolder folder;
  VertexData data = sample_vertices(BandSet::rgb());
  data.triangles = {{0, 0, 2}};
  EXPECT_THROW(write_vertex_data(data, folder / "a.glb"), InputError);
  EXPECT_TRUE(folder.listing().empty());
}

TEST(GlbWriter, SatisfiesTheKhronosValidatorInRgb) {
  const TempFolder folder;
  write_vertex_data(sample_vertices(BandSet::rgb()), folder / "a.glb");
  expect_valid_glb(folder / "a.glb");
}

TEST(GlbWriter, SatisfiesTheKhronosValidatorWithZUp) {
  const TempFolder folder;
  VertexData data = sample_vertices(BandSet::rgb());
  data.up = Vec3(0, 0, 1);
  write_vertex_data(data, folder / "a.glb");
  expect_valid_glb(folder / "a.glb");
}

TEST(GlbWriter, SatisfiesTheKhronosValidatorInSpectralBandsFarAway) {
  const TempFolder folder;
  write_vertex_data(sample_vertices(BandSet::spectral({450, 550.5}), Vec3(1e7, 0, 0)), folder / "a.glb");
  expect_valid_glb(folder / "a.glb");
}

TEST(GlbWriter, SatisfiesTheKhronosValidatorWithNumbersThatAreNotFinite) {
  const TempFolder folder;
  VertexData data = sample_vertices(BandSet::grey());
  data.radiance[0] = std::numeric_limits<float>::quiet_NaN();
  data.radiance[2] = std::numeric_limits<float>::infinity();
  data.radiance_stderr[1] = std::numeric_limits<float>::infinity();
  data.normals[1] = Vec3::Zero();
  write_vertex_data(data, folder / "a.glb");
  expect_valid_glb(folder / "a.glb");
}

}  // namespace
}  // namespace reemit

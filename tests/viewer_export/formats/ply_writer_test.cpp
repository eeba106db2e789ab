// OpenMesh appends colours that it fills in later; GCC takes that for a mistake of ours.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <OpenMesh/Core/IO/MeshIO.hh>  // must come before the mesh type
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"
#include "tests/viewer_export/formats/sample_vertices.h"
#include "viewer_export/formats/export_table.h"
#include "viewer_export/formats/vertex_export.h"

namespace reemit {
namespace {

using test::sample_vertices;
using test::TempFolder;
using testing::HasSubstr;
using PlyMesh = OpenMesh::TriMesh_ArrayKernelT<>;

// Reads with OpenMesh, which keeps properties it does not know as custom ones.
PlyMesh read_ply(const std::filesystem::path& file) {
  PlyMesh mesh;
  mesh.request_vertex_normals();
  mesh.request_vertex_colors();
  OpenMesh::IO::Options options = OpenMesh::IO::Options::VertexNormal;
  options += OpenMesh::IO::Options::VertexColor;
  options += OpenMesh::IO::Options::Custom;
  EXPECT_TRUE(OpenMesh::IO::read_mesh(mesh, file.string(), options));
  EXPECT_TRUE(options.vertex_has_normal());
  EXPECT_TRUE(options.vertex_has_color());
  return mesh;
}

template <class T>
T custom(const PlyMesh& mesh, const std::string& name, int vertex) {
  OpenMesh::VPropHandleT<T> handle;
  if (!mesh.get_property_handle(handle, name)) {
    ADD_FAILURE() << "no property " << name;
    return {};
  }
  return mesh.property(handle, PlyMesh::VertexHandle(vertex));
}

TEST(PlyWriter, IsReadBackByOpenMesh) {
  const TempFolder folder;
  const VertexData data = sample_vertices(BandSet::rgb());
  const auto tone_map = write_vertex_data(data, folder / "a.ply");
  ASSERT_TRUE(tone_map.has_value());
  const PlyMesh mesh = read_ply(folder / "a.ply");
  ASSERT_EQ(mesh.n_vertices(), data.vertex_count());
  const VertexColours colours = colours_of(data);
  for (std::size_t v = 0; v < data.vertex_count(); ++v) {
    const PlyMesh::VertexHandle handle(static_cast<int>(v));
    for (std::size_t c = 0; c < 3; ++c) {
      const auto axis = static_cast<Eigen::Index>(c);
      EXPECT_FLOAT_EQ(mesh.point(handle)[c], static_cast<float>(data.positions[v][axis]));
      EXPECT_FLOAT_EQ(mesh.normal(handle)[c], static_cast<float>(data.normals[v][axis]));
      EXPECT_EQ(mesh.color(handle)[c], srgb_byte(colours.displayable(v)[axis]));
      const char* names[] = {"r", "g", "b"};
      const auto at = [&](const std::string& quantity) {
        return custom<float>(mesh, quantity + "_" + names[c], static_cast<int>(v));
      };
      EXPECT_EQ(at("radiance"), data.radiance[3 * v + c]);
      EXPECT_EQ(at("irradiance"), data.irradiance[3 * v + c]);
      EXPECT_EQ(at("stderr"), data.radiance_stderr[3 * v + c]);
      EXPECT_EQ(at("direct"), data.direct_radiance[3 * v + c]);
      EXPECT_EQ(at("caustic"), data.caustic_radiance[3 * v + c]);
    }
    const double luminance_cd_per_m2 = 179 * luminance(data.rgb(data.radiance, v));
    EXPECT_FLOAT_EQ(custom<float>(mesh, "quality", static_cast<int>(v)),
                    static_cast<float>(luminance_cd_per_m2));
    EXPECT_EQ(custom<int>(mesh, "surface", static_cast<int>(v)), static_cast<int>(data.surfaces[v].index()));
    EXPECT_EQ(custom<int>(mesh, "material", static_cast<int>(v)),
              static_cast<int>(data.materials[v].index()));
  }
  ASSERT_GE(mesh.n_faces(), 2U);
  auto corner = mesh.cfv_iter(PlyMesh::FaceHandle(1));
  EXPECT_EQ(corner->idx(), 1);
  EXPECT_EQ((++corner)->idx(), 3);
  EXPECT_EQ((++corner)->idx(), 5);
}

TEST(PlyWriter, SpectralRoomsCarryTheirBandsAndRgb) {
  const TempFolder folder;
  const VertexData data = sample_vertices(BandSet::spectral({450, 550, 650}));
  write_vertex_data(data, folder / "a.ply");
  const PlyMesh mesh = read_ply(folder / "a.ply");
  EXPECT_EQ(custom<float>(mesh, "radiance_550", 3), data.radiance[3 * 3 + 1]);
  EXPECT_EQ(custom<float>(mesh, "irradiance_650", 3), data.irradiance[3 * 3 + 2]);
  EXPECT_EQ(custom<float>(mesh, "stderr_450", 3), data.radiance_stderr[3 * 3]);
  EXPECT_EQ(custom<float>(mesh, "direct_450", 3), data.direct_radiance[3 * 3]);
  const Eigen::Array3d rgb = data.rgb(data.radiance, 3);
  EXPECT_FLOAT_EQ(custom<float>(mesh, "radiance_g", 3), static_cast<float>(rgb[1]));
  EXPECT_FLOAT_EQ(custom<float>(mesh, "irradiance_r", 3),
                  static_cast<float>(data.rgb(data.irradiance, 3)[0]));
}

TEST(PlyWriter, GreyRoomsHaveEqualColours) {
  const TempFolder folder;
  const VertexData data = sample_vertices(BandSet::grey());
  write_vertex_data(data, folder / "a.ply");
  const PlyMesh mesh = read_ply(folder / "a.ply");
  EXPECT_FLOAT_EQ(custom<float>(mesh, "radiance_b", 2), data.radiance[2]);
  EXPECT_FLOAT_EQ(custom<float>(mesh, "quality", 2), 179 * data.radiance[2]);
  const auto colour = mesh.color(PlyMesh::VertexHandle(2));
  EXPECT_EQ(colour[0], colour[2]);
}

TEST(PlyWriter, StatesUnitsSeedErrorAndExposure) {
  const TempFolder folder;
  VertexData data = sample_vertices(BandSet::rgb());
  data.tone_map = ToneMap(std::exp2(2), ToneMapSettings::kFixedWhite);
  write_vertex_data(data, folder / "a.ply");
  const std::string text = test::read_bytes(folder / "a.ply");
  const std::string header = text.substr(0, text.find("end_header"));
  EXPECT_THAT(header, HasSubstr("comment seed: 77\n"));
  EXPECT_THAT(header, HasSubstr("comment relative error by noise: 0.0125\n"));
  EXPECT_THAT(header, HasSubstr("W/(m2 sr)"));
  EXPECT_THAT(header, HasSubstr("179"));
  EXPECT_THAT(header, HasSubstr("+2.00 EV"));
  EXPECT_THAT(header, HasSubstr("comment room: kitchen north.json\n"));
}

TEST(PlyWriter, FarRoomsKeepTheirShape) {
  const TempFolder folder;
  const VertexData data = sample_vertices(BandSet::grey(), Vec3(1e6, 0, 0));
  write_vertex_data(data, folder / "a.ply");
  EXPECT_THAT(test::read_bytes(folder / "a.ply"), HasSubstr("property double x\n"));
  write_vertex_data(sample_vertices(BandSet::grey()), folder / "b.ply");
  EXPECT_THAT(test::read_bytes(folder / "b.ply"), HasSubstr("property float x\n"));
}

TEST(PlyWriter, StatesWhichWayIsUpAndMovesBacksOffTheirFronts) {
  const TempFolder folder;
  VertexData data = sample_vertices(BandSet::rgb());
  data.up = Vec3(0, 0, 1);
  data.on_back[1] = true;
  write_vertex_data(data, folder / "a.ply");
  EXPECT_THAT(test::read_bytes(folder / "a.ply"), HasSubstr("comment up: +z, axes as in the room file\n"));
  EXPECT_THAT(test::read_bytes(folder / "a.ply"), HasSubstr("comment backs: moved"));
  const PlyMesh mesh = read_ply(folder / "a.ply");
  const Vec3 moved = data.positions[1] + back_gap(data) * data.normals[1];
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    EXPECT_FLOAT_EQ(mesh.point(PlyMesh::VertexHandle(1))[k], static_cast<float>(moved[axis]));
    EXPECT_FLOAT_EQ(mesh.point(PlyMesh::VertexHandle(3))[k], static_cast<float>(data.positions[3][axis]));
  }
}

}  // namespace
}  // namespace reemit

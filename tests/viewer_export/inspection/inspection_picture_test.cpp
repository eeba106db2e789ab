// The picture of a mesh, read back from its file: objects, colours, areas and sides.
#include "viewer_export/inspection/inspection_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/io/common/srgb.h"
#include "scenes/model/error.h"
#include "solver/zoning/build_zones.h"
#include "tests/mesh/test_room.h"
#include "tests/support/glb_file.h"
#include "tests/support/random_splits.h"
#include "tests/support/temp_folder.h"
#include "tests/support/test_rooms.h"
#include "viewer_export/formats/vertex_export.h"
#include "viewer_export/inspection/face_lists.h"
#include "viewer_export/inspection/side_kinds.h"
#include "viewer_export/inspection/zone_sizes.h"

namespace reemit::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A closed room, lit from its ceiling, with one known thing of each kind in it.
TestRoom room_of_all_kinds() {
  TestRoom room;
  const MaterialId wall = room.material(false);
  const MaterialId sheet = room.material(true);
  room.box("room", wall, {0, 0, 0}, {6, 6, 3}, true);
  room.polygon("lamp", room.material(false, 10), reversed(floor_rectangle(2, 2, 3, 3, 2.9)));
  const SurfaceId crate = room.box("crate", room.material(false), {1, 1, 1}, {2, 2, 2});
  std::reverse(room.scene().surfaces[crate.index()].faces[1].outer.begin(),
               room.scene().surfaces[crate.index()].faces[1].outer.end());
  room.box("sealed box", sheet, {4, 4, 1}, {5, 5, 2});
  room.polygon("first", sheet, floor_rectangle(3, 1, 4, 2, 1));
  room.polygon("second", sheet, floor_rectangle(3.5, 1, 5, 2, 1));
  room.polygon("bent", sheet, {{1, 4, 1}, {2, 4, 1}, {2, 5, 1.3}, {1, 5, 1}});
  room.polygon("screen", sheet, {{1, 3, 0}, {2, 3, 0}, {2, 3, 0.5}, {1, 3, 0.5}});
  room.scene().lights.push_back(PointLight{"bulb", {5, 1, 2}, Spectrum::Constant(1, 1.0)});
  return room;
}

MeshResult meshed(const Scene& scene) {
  MeshSettings settings;
  settings.default_zone_count = 500;
  return build_zones(scene, settings);
}

struct Triangle {
  std::array<Vec3, 3> corner;  // in the coordinates of the file, nodes not applied
  std::array<int, 3> rgb;

  Vec3 area_vector() const { return 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]); }
};

struct ReadObject {
  int mode = -1;
  std::string set;  // name of the node above
  std::vector<Triangle> triangles;
  std::size_t indices = 0;

  double area() const {
    double sum = 0;
    for (const Triangle& t : triangles) sum += t.area_vector().norm();
    return sum;
  }
  std::set<std::array<int, 3>> colours() const {
    std::set<std::array<int, 3>> all;
    for (const Triangle& t : triangles) all.insert(t.rgb);
    return all;
  }
};

template <class T>
T value_at(const tinygltf::Model& model, int accessor, std::size_t i, std::size_t bytes) {
  const auto& a = model.accessors.at(static_cast<std::size_t>(accessor));
  const auto& view = model.bufferViews.at(static_cast<std::size_t>(a.bufferView));
  const auto stride = static_cast<std::size_t>(a.ByteStride(view));
  T value;
  std::memcpy(&value, model.buffers.at(0).data.data() + view.byteOffset + a.byteOffset + i * stride, bytes);
  return value;
}

ReadObject read_object(const tinygltf::Model& model, const tinygltf::Mesh& mesh) {
  EXPECT_EQ(mesh.primitives.size(), 1U);
  const tinygltf::Primitive& p = mesh.primitives.at(0);
  ReadObject object;
  object.mode = p.mode;
  object.indices = model.accessors.at(static_cast<std::size_t>(p.indices)).count;
  if (p.mode != TINYGLTF_MODE_TRIANGLES) return object;
  for (std::size_t i = 0; i + 2 < object.indices; i += 3) {
    Triangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = value_at<std::uint32_t>(model, p.indices, i + k, 4);
      const auto position = value_at<std::array<float, 3>>(model, p.attributes.at("POSITION"), v, 12);
      t.corner[k] = Vec3(position[0], position[1], position[2]);
      const auto colour = value_at<std::array<std::uint8_t, 4>>(model, p.attributes.at("COLOR_0"), v, 4);
      const std::array<int, 3> rgb{colour[0], colour[1], colour[2]};
      EXPECT_TRUE(k == 0 || rgb == t.rgb) << "a triangle has one colour";
      t.rgb = rgb;
    }
    object.triangles.push_back(t);
  }
  return object;
}

// By name.
std::map<std::string, ReadObject> read_objects(const tinygltf::Model& model) {
  std::map<std::string, ReadObject> objects;
  for (const tinygltf::Node& set : model.nodes)
    for (const int child : set.children) {
      const tinygltf::Node& node = model.nodes.at(static_cast<std::size_t>(child));
      if (node.mesh < 0) continue;
      const tinygltf::Mesh& mesh = model.meshes.at(static_cast<std::size_t>(node.mesh));
      EXPECT_EQ(mesh.name, node.name);
      EXPECT_FALSE(objects.contains(node.name));
      objects[node.name] = read_object(model, mesh);
      objects[node.name].set = set.name;
    }
  return objects;
}

struct Drawn {
  TempFolder folder;
  Scene scene;
  MeshResult mesh;
  tinygltf::Model model;
  std::map<std::string, ReadObject> objects;

  Drawn(Scene room, MeshResult result) : scene(std::move(room)), mesh(std::move(result)) {
    write_inspection(draw_inspection(scene, mesh), scene, file());
    model = read_glb(file());
    objects = read_objects(model);
  }
  std::filesystem::path file() const { return folder / "report.glb"; }
};

Drawn draw(const Scene& scene) {
  return Drawn(scene, meshed(scene));
}

std::array<int, 3> colour_in_file(SideKind kind) {
  std::array<int, 3> rgb{};
  for (std::size_t k = 0; k < 3; ++k)
    rgb[k] = static_cast<int>(std::lround(255 * linear_from_srgb(style_of(kind).srgb[k] / 255.0)));
  return rgb;
}

constexpr SideKind kAllKinds[] = {SideKind::kFlipped,   SideKind::kSealed,   SideKind::kCovered,
                                  SideKind::kCovers,    SideKind::kRepaired, SideKind::kCut,
                                  SideKind::kLuminaire, SideKind::kUntouched};

TEST(InspectionPicture, HasAnObjectOfItsColourForEveryKind) {
  const Drawn drawn = draw(room_of_all_kinds().scene());
  for (const SideKind kind : kAllKinds) {
    const SideKindStyle& style = style_of(kind);
    ASSERT_TRUE(drawn.objects.contains(style.name)) << style.name;
    const ReadObject& object = drawn.objects.at(style.name);
    EXPECT_EQ(object.set, "what meshing did");
    EXPECT_THAT(object.colours(), ElementsAre(colour_in_file(kind))) << style.name;
  }
}

TEST(InspectionPicture, KindsHaveTheAreaOfTheirFaces) {
  const Drawn drawn = draw(room_of_all_kinds().scene());
  const auto area = [&](SideKind kind) { return drawn.objects.at(style_of(kind).name).area(); };
  constexpr double kSinglePrecision = 1e-5;
  EXPECT_NEAR(area(SideKind::kFlipped), 1, kSinglePrecision);
  EXPECT_NEAR(area(SideKind::kSealed), 6, kSinglePrecision) << "the inside of the box";
  EXPECT_NEAR(area(SideKind::kCovered), 2 * 1.0, kSinglePrecision) << "both sides of what is left";
  EXPECT_NEAR(area(SideKind::kCovers), 2 * 1.0, kSinglePrecision);
  EXPECT_NEAR(area(SideKind::kCut), 36, kSinglePrecision) << "the floor, on which the screen stands";
  EXPECT_NEAR(area(SideKind::kLuminaire), 1, kSinglePrecision);
  for (const SideKindSum& sum : sum_sides(drawn.mesh.mesh, kinds_of_sides(drawn.scene, drawn.mesh)))
    EXPECT_NEAR(area(sum.kind), sum.area, kSinglePrecision * sum.area) << style_of(sum.kind).name;
}

TEST(InspectionPicture, EverySideWithZonesIsInBothSets) {
  const Drawn drawn = draw(room_of_all_kinds().scene());
  const ZoneMesh& mesh = drawn.mesh.mesh;
  double sides = 0;
  for (std::size_t s = 0; s < mesh.side_count(); ++s)
    if (mesh.has_zones(SideId(s))) sides += mesh.triangle_area(triangle_of(SideId(s)));
  std::map<std::string, double> area;
  for (const auto& [name, object] : drawn.objects) area[object.set] += object.area();
  EXPECT_NEAR(area["what meshing did"], sides, 1e-5 * sides);
  EXPECT_NEAR(area["zones by size"], sides, 1e-5 * sides);
}

TEST(InspectionPicture, FrontsAndBacksLookAway) {
  const Drawn drawn = draw(room_of_all_kinds().scene());
  const double gap = back_gap(bounds(drawn.scene).size().norm());
  std::set<int> facing;
  for (const Triangle& t : drawn.objects.at(style_of(SideKind::kCovers).name).triangles) {
    const bool up = t.area_vector().z() > 0;
    facing.insert(up ? 1 : -1);
    for (const Vec3& p : t.corner) EXPECT_NEAR(p.z(), up ? 1 : 1 - gap, 1e-6);
  }
  EXPECT_EQ(facing.size(), 2U);
  for (const Triangle& t : drawn.objects.at(style_of(SideKind::kSealed).name).triangles) {
    const Vec3 middle = (t.corner[0] + t.corner[1] + t.corner[2]) / 3;
    EXPECT_GT(t.area_vector().dot(Vec3(4.5, 4.5, 1.5) - middle), 0) << "seen from inside of the box";
  }
  for (const tinygltf::Material& material : drawn.model.materials) EXPECT_FALSE(material.doubleSided);
}

TEST(InspectionPicture, LuminairesAreLines) {
  const Drawn drawn = draw(room_of_all_kinds().scene());
  const ReadObject& lines = drawn.objects.at("luminaires");
  EXPECT_EQ(lines.mode, TINYGLTF_MODE_LINE);
  EXPECT_EQ(lines.indices, 2U * (5 + 3)) << "five edges of two triangles, a cross at the bulb";
}

TEST(InspectionPicture, ZonesLieBesideTheRoomByKind) {
  const Drawn drawn = draw(room_of_all_kinds().scene());
  const ZoneMesh& mesh = drawn.mesh.mesh;
  ASSERT_GT(zone_sizes(mesh, ZoneKind::kSealed).count, 0U);
  for (const ZoneKind kind : kZoneKinds) {
    double area = 0;
    for (std::size_t z = 0; z < mesh.zone_count(); ++z)
      if (kind_of(mesh, ZoneId(z)) == kind) area += mesh.zone_area(ZoneId(z));
    const auto object = drawn.objects.find(name_of(kind));
    EXPECT_EQ(object != drawn.objects.end(), area > 0) << name_of(kind);
    if (object == drawn.objects.end()) continue;
    EXPECT_NEAR(object->second.area(), area, 1e-5 * area) << name_of(kind);
    EXPECT_EQ(object->second.set, "zones by size");
  }
  for (const tinygltf::Node& node : drawn.model.nodes)
    if (node.name == "zones by size") {
      ASSERT_EQ(node.translation.size(), 3U);
      EXPECT_GT(node.translation[0], 6) << "the width of the room";
    }
}

// Small zones are red, large ones blue, and of two neighbours of one size each has a colour of its own.
TEST(InspectionPicture, ColoursOfZonesTellSizesAndNeighboursApart) {
  RoomBuilder room;
  const MaterialId m = room.material("grey", 0.5, 1);
  room.quad(m, {Vec3(0, 0, 0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 1);
  room.quad(m, {Vec3(0, 0, 1), {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, 4);
  MeshResult result = room.mesh();
  result.report.surfaces.resize(2);
  const Drawn drawn(room.scene(), std::move(result));
  std::set<std::array<int, 3>> large;
  for (const Triangle& t : drawn.objects.at("cells").triangles) {
    if (t.corner[0].z() > 0.5) {
      EXPECT_GT(t.rgb[0], t.rgb[2]);
    } else {
      EXPECT_GT(t.rgb[2], t.rgb[0]);
      large.insert(t.rgb);
    }
  }
  EXPECT_EQ(drawn.objects.at("cells").triangles.size(), 2U + 2U * 16);
  EXPECT_EQ(large.size(), 2U);
}

TEST(InspectionPicture, CellsAreDrawnAsTheyAreCut) {
  RoomBuilder room;
  room.quad(room.material("grey", 0.5, 1), {Vec3(0, 0, 0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 3);
  MeshResult result = room.mesh();
  result.report.surfaces.resize(1);
  const BaseMesh base = result.mesh.base();
  result.mesh = ZoneMesh(base, {}, random_splits(base, 6, 2));
  const std::size_t zones = result.mesh.zone_count();
  const Drawn drawn(room.scene(), std::move(result));
  EXPECT_GT(zones, 2U * 9);
  EXPECT_EQ(drawn.objects.at("cells").triangles.size(), zones);
}

TEST(InspectionPicture, RoundShapesLookRound) {
  RoomBuilder room;
  room.shape(room.material("grey", 0.5), Sphere{{0, 0, 0}, 1}, 4);
  MeshResult result = room.mesh();
  result.report.surfaces.resize(1);
  const Drawn drawn(room.scene(), std::move(result));
  const ReadObject& ball = drawn.objects.at("untouched");
  EXPECT_EQ(ball.triangles.size(), 8U * 16);
  for (const Triangle& t : ball.triangles)
    for (const Vec3& p : t.corner) EXPECT_NEAR(p.norm(), 1, 1e-6);
}

TEST(InspectionPicture, NumbersOfShapesAreNotTakenForThoseOfFaces) {
  TestRoom room;
  const SurfaceId s = room.polygon("bent", room.material(), {{3, 0, 0}, {4, 0, 0}, {4, 1, 0.2}, {3, 1, 0}});
  room.scene().surfaces[s.index()].shapes.push_back(Sphere{{0, 0, 0}, 1});
  const MeshResult result = build_mesh(room.scene());
  const std::vector<SideKind> kinds = kinds_of_sides(room.scene(), result);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const bool curved = result.mesh.triangle(triangle_of(SideId(i))).is_curved();
    EXPECT_EQ(kinds[i], curved ? SideKind::kUntouched : SideKind::kRepaired);
  }
}

TEST(InspectionPicture, FacesAreListedByName) {
  const Scene scene = room_of_all_kinds().scene();
  std::map<std::string, std::string> names;
  for (const FaceList& list : list_faces(meshed(scene))) names[list.key] = names_of(scene, list);
  EXPECT_EQ(names["flipped"], "'crate' (test-room:2, face 1)");
  EXPECT_EQ(names["covers"], "'first' (test-room:1, face 0)");
  EXPECT_EQ(names["covered"], "'second' (test-room:1, face 0)");
  EXPECT_EQ(names["nonplanar"], "'bent' (test-room:1, face 0)");
  EXPECT_EQ(names["cut"], "'room' (test-room:1, face 0)");
  EXPECT_THAT(names["sealed"], HasSubstr("'sealed box' (test-room:5, face 4) and 1 more"));
  EXPECT_EQ(names.size(), 6U);
}

TEST(InspectionPicture, SatisfiesTheKhronosValidator) {
  expect_valid_glb(draw(room_of_all_kinds().scene()).file());
}

TEST(InspectionPicture, SatisfiesTheKhronosValidatorFarAway) {
  TestRoom room = room_of_all_kinds();
  for (Surface& surface : room.scene().surfaces)
    for (Vec3& p : surface.positions) p += Vec3(1e6, 0, -1e6);
  const Drawn drawn = draw(room.scene());
  for (const tinygltf::Node& node : drawn.model.nodes)
    if (node.name == "what meshing did") {
      ASSERT_EQ(node.translation.size(), 3U);
      EXPECT_NEAR(node.translation[0], 1e6, 10);
    }
  EXPECT_NEAR(drawn.objects.at(style_of(SideKind::kFlipped).name).area(), 1, 1e-5);
  expect_valid_glb(drawn.file());
}

TEST(InspectionPicture, OtherExtensionsAreRefused) {
  for (const char* name : {"report.ply", "report", "report.gltf"})
    EXPECT_THROW(check_inspection_name(name), InputError) << name;
  EXPECT_NO_THROW(check_inspection_name("REPORT.GLB"));
}

}  // namespace
}  // namespace reemit::test

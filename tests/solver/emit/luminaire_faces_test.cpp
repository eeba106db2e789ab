#include "solver/emit/luminaire_faces.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "mesh/build_mesh.h"

namespace reemit {
namespace {

SurfaceId add_quad(Scene& scene, const std::string& name, MaterialId material,
                   const std::array<Vec3, 4>& corners) {
  Surface s;
  s.name = name;
  s.material = material;
  s.positions.assign(corners.begin(), corners.end());
  s.faces.push_back({{0, 1, 2, 3}, {}, {}, 0});
  scene.surfaces.push_back(s);
  return SurfaceId(scene.surfaces.size() - 1);
}

MaterialId add_material(Scene& scene, const std::string& name, double radiance) {
  Material m;
  m.name = name;
  m.reflectance = Spectrum::Constant(1, 0.5);
  m.emitted_radiance = Spectrum::Constant(1, radiance);
  scene.materials.push_back(m);
  return MaterialId(scene.materials.size() - 1);
}

/// A lamp and a plinth whose upper edge runs along it, 4 micrometres short of either end.
Scene lamp_with_plinth() {
  Scene scene;
  const MaterialId lamp = add_material(scene, "lamp", 3.59);
  const MaterialId wall = add_material(scene, "wall", 0);
  add_quad(scene, "lamp", lamp,
           {Vec3(-5.62738, 5.07771, 3.443749), Vec3(0.8356, 5.07771, 3.443749),
            Vec3(0.8356, -0.04149, 3.443751), Vec3(-5.62738, -0.04149, 3.443751)});
  add_quad(scene, "wall", wall, {Vec3(-12, -1, -3), Vec3(2, -1, -3), Vec3(2, 7, -3), Vec3(-12, 7, -3)});
  add_quad(scene, "plinth", wall,
           {Vec3(-5.627376, 0.025222, 2.998156), Vec3(-5.627376, 0.025222, 3.443751),
            Vec3(0.835596, 0.025222, 3.443751), Vec3(0.835596, 0.025222, 2.998156)});
  finish_scene(scene);
  return scene;
}

TEST(LuminaireFaces, the_front_is_that_of_the_polygon_whatever_slivers_the_mesh_has) {
  const Scene scene = lamp_with_plinth();
  const ZoneMesh mesh = build_mesh(scene).mesh;
  const Vec3 front = Vec3(0, -2e-6, -5.1192).normalized();
  bool has_tilted_sliver = false;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    if (mesh.triangle(TriangleId(t)).surface == SurfaceId(0))
      has_tilted_sliver |= mesh.triangle_normal(TriangleId(t)).dot(front) < 1 - 1e-6;
  ASSERT_TRUE(has_tilted_sliver) << "the room tests nothing any more";

  const std::vector<LuminaireFace> faces = luminaire_faces(Room(scene, mesh));
  ASSERT_EQ(faces.size(), 1U);
  EXPECT_GT(faces[0].normal.dot(front), 1 - 1e-12);
  EXPECT_EQ(faces[0].corners.size(), 4U);
}

TEST(LuminaireFaces, the_mesh_says_which_side_of_a_polygon_is_the_front) {
  Scene scene = lamp_with_plinth();
  std::swap(scene.surfaces[0].faces[0].outer[1], scene.surfaces[0].faces[0].outer[3]);
  const ZoneMesh mesh = build_mesh(scene).mesh;
  const std::vector<LuminaireFace> faces = luminaire_faces(Room(scene, mesh));
  ASSERT_EQ(faces.size(), 1U);
  EXPECT_GT(faces[0].normal.z(), 1 - 1e-9);
}

}  // namespace
}  // namespace reemit

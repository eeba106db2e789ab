#include "mesh/zones/curved_patch.h"

#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "mesh/zones/zone_topology.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

std::vector<CurvedShape> some_shapes() {
  const Vec3 tilted = Vec3(0.3, -0.5, 0.8).normalized();
  return {Sphere{{0.1, -0.2, 0.3}, 0.7, false},
          Sphere{{0.1, -0.2, 0.3}, 0.7, true},
          Disk{{0.2, 0.1, 0}, tilted, 0.8, 0},
          Disk{{0.2, 0.1, 0}, -tilted, 0.8, 0.3},
          Cylinder{{0, 0, 0}, {0.3, 0.1, 2.0}, 0.25, false},
          Cylinder{{0, 0, 0}, {0.3, 0.1, 0.2}, 0.25, true},
          Cone{{0, 0, 0}, {0.3, 0.1, 1.0}, 0.25, 0.6, false},
          Cone{{0, 0, 0}, {0.3, 0.1, 1.0}, 0.5, 0, true}};
}

constexpr double kInside[][2] = {{0.31, 0.27}, {0.05, 0.9}, {0.8, 0.1}, {0.02, 0.03}, {0.45, 0.5}};

TEST(CurvedPatches, EqualAreasInBarycentricsMakeEqualAreasOnTheShape) {
  for (const CurvedShape& shape : some_shapes()) {
    const CurvedPatches patches(shape);
    EXPECT_NEAR(patches.count() * patches.patch_area(), shape_area(shape), 1e-12);
    for (std::uint32_t p = 0; p < patches.count(); ++p)
      for (const auto& [u, v] : kInside) {
        constexpr double h = 1e-6;
        const Vec3 du = (patches.point(p, u + h, v) - patches.point(p, u - h, v)) / (2 * h);
        const Vec3 dv = (patches.point(p, u, v + h) - patches.point(p, u, v - h)) / (2 * h);
        const Vec3 cross = du.cross(dv);
        // A patch has half a unit of barycentric area. The cross product points to the front.
        EXPECT_NEAR(cross.norm() / 2, patches.patch_area(), 1e-7) << shape.index() << " " << p;
        EXPECT_NEAR(cross.normalized().dot(patches.normal(p, u, v)), 1, 1e-7) << shape.index() << " " << p;
      }
  }
}

TEST(CurvedPatches, SixteenPointsAtOnceAreTheSame) {
  for (const CurvedShape& shape : some_shapes()) {
    const CurvedPatches patches(shape);
    for (std::uint32_t p = 0; p < patches.count(); ++p) {
      double u[16];
      double v[16];
      for (int i = 0; i < 16; ++i) {  // with the corners
        u[i] = i < 3 ? static_cast<double>(i == 1) : 0.06 * i;
        v[i] = i < 3 ? static_cast<double>(i == 2) : (1 - u[i]) * std::fmod(0.37 * i, 1);
      }
      CurvedPatches::Points16 points;
      patches.at16(p, u, v, points);
      for (int i = 0; i < 16; ++i) {
        const CurvedPatches::Point one = patches.at(p, u[i], v[i]);
        for (int k = 0; k < 3; ++k) {
          EXPECT_NEAR(points.position[k][i], one.position[k], 1e-15) << shape.index() << " " << p;
          EXPECT_NEAR(points.normal[k][i], one.normal[k], 1e-15) << shape.index() << " " << p;
        }
      }
    }
  }
}

TEST(CurvedPatches, PlaceOfFindsEveryPointAgain) {
  for (const CurvedShape& shape : some_shapes()) {
    const CurvedPatches patches(shape);
    for (std::uint32_t p = 0; p < patches.count(); ++p)
      for (const auto& [u, v] : kInside) {
        const Vec3 point = patches.point(p, u, v);
        const CurvedPatches::Place place = patches.place_of(point);
        EXPECT_EQ(place.patch, p) << shape.index();
        EXPECT_NEAR(place.at.u, u, 1e-9) << shape.index() << " " << p;
        EXPECT_NEAR(place.at.v, v, 1e-9);
        const Barycentric in_patch = patches.in_patch(p, point);
        EXPECT_NEAR(in_patch.u, u, 1e-9);
        EXPECT_NEAR(in_patch.v, v, 1e-9);
      }
  }
}

TEST(CurvedPatches, SmallAndDistantShapesKeepTheirDigits) {
  const CurvedPatches patches(Sphere{{1000, -2000, 500}, 1e-3, false});
  const Vec3 point = patches.point(5, 0.2, 0.3);
  EXPECT_NEAR((point - Vec3(1000, -2000, 500)).norm(), 1e-3, 1e-12);
  const CurvedPatches::Place place = patches.place_of(point);
  EXPECT_EQ(place.patch, 5U);
  EXPECT_NEAR(place.at.u, 0.2, 1e-8);
}

TEST(ShapeModel, TransformsKeepFronts) {
  Eigen::Affine3d mirror = Eigen::Affine3d::Identity();
  mirror.translate(Vec3(1, 2, 3)).scale(Vec3(-2, 2, 2));
  ASSERT_TRUE(is_similarity(mirror));
  EXPECT_FALSE(is_similarity(Eigen::Affine3d(Eigen::Scaling(1.0, 1.0, 1.01))));
  for (const CurvedShape& shape : some_shapes()) {
    const CurvedPatches before(shape);
    const CurvedPatches after(transformed(shape, mirror));
    const Vec3 point = before.point(0, 0.3, 0.3);
    EXPECT_NEAR((mirror.linear() * before.normal_at(point)).normalized().dot(after.normal_at(mirror * point)),
                1, 1e-12);
    EXPECT_NEAR(shape_area(transformed(shape, mirror)), 4 * shape_area(shape), 1e-12);
    EXPECT_NEAR(CurvedPatches(flipped(shape)).normal_at(point).dot(before.normal_at(point)), -1, 1e-12);
  }
}

TEST(CurvedPatches, ZonesOfAClosedShapeShareTheirVertices) {
  test::RoomBuilder room;
  room.shape(room.material("m", 0.5), Sphere{{0, 0, 0}, 1, false}, 4);
  const MeshResult result = build_mesh(room.scene());
  const ZoneTopology topology = make_zone_topology(result.mesh, 30);
  EXPECT_EQ(result.mesh.flat_count(), 0U);
  // Euler: a closed surface of genus 0.
  EXPECT_EQ(static_cast<long>(topology.n_vertices()) - static_cast<long>(topology.n_edges()) +
                static_cast<long>(topology.n_faces()),
            2L * (result.mesh.triangle(TriangleId(0)).two_sided ? 2 : 1));
  for (const auto v : topology.vertices()) {
    EXPECT_NEAR(topology.point(v).norm(), 1, 1e-12);
    EXPECT_NEAR(std::fabs(topology.normal(v) | topology.point(v)), 1, 1e-9);
  }
}

}  // namespace
}  // namespace reemit

#include "solver/emit/light_places.h"

#include <gtest/gtest.h>

#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using test::RoomBuilder;

constexpr double kMetres = 2;  // per normalised unit of the rooms below

/// Where a light at `position` in the room [0,4]^3, with a two-sided partition at x = 1, is put.
Vec3 placed(const PunctualLight& light) {
  RoomBuilder room;
  const MaterialId m = room.material("wall", 0.5);
  const MaterialId both = room.material("partition", 0.5, 0, true);
  room.box({0, 0, 0}, {4, 4, 4}, {m, m, m, m, m, m}, 1);
  room.quad(both, {Vec3(1, 1, 1), Vec3(1, 3, 1), Vec3(1, 3, 3), Vec3(1, 1, 3)}, 1);
  room.scene().lights.push_back(light);
  const MeshResult built = room.mesh();
  const RayTracer rays(built.mesh);
  const PunctualLight moved = lights_before_faces(room.scene(), rays).at(0);
  return std::visit(
      [](const auto& l) -> Vec3 {
        if constexpr (requires { l.position; })
          return l.position;
        else
          return Vec3::Zero();
      },
      moved);
}

Vec3 placed_point(const Vec3& position) {
  return placed(PointLight{"p", position, Spectrum::Ones(1)});
}

TEST(LightPlaces, OnAWallItStandsBeforeItAndElsewhereItStays) {
  const double least = kLightClearance * kMetres;
  for (const double height : {-0.9 * least, 0.0, 0.5 * least}) {
    const Vec3 p = placed_point({height, 2, 2.5});
    EXPECT_GE(p.x(), least * 0.999999);
    EXPECT_LE(p.x(), least * 1.01);
    EXPECT_EQ(p.y(), 2);
    EXPECT_EQ(p.z(), 2.5);
  }
  EXPECT_EQ(placed_point({2, 2, 2}), Vec3(2, 2, 2));
  EXPECT_EQ(placed_point({1.1 * least, 2, 2}), Vec3(1.1 * least, 2, 2));
  EXPECT_EQ(placed_point({-1e-3, 2, 2}), Vec3(-1e-3, 2, 2)) << "outside the room is outside";
}

TEST(LightPlaces, InEdgesAndCornersItStandsBeforeAllWalls) {
  const double least = kLightClearance * kMetres * 0.999999;
  for (const Vec3& corner : {Vec3(0, 0, 2), Vec3(4, 4, 0), Vec3(0, 4, 4)}) {
    const Vec3 p = placed_point(corner);
    EXPECT_GE(p.minCoeff(), least) << corner.transpose();
    EXPECT_LE(p.maxCoeff(), 4 - least) << corner.transpose();
  }
}

TEST(LightPlaces, OnAPartitionASpotDecidesTheSideAndElseTheMiddleOfTheRoom) {
  const Vec3 on(1, 2, 2);
  EXPECT_GT(placed_point(on).x(), 1);
  EXPECT_LT(placed(SpotLight{"s", on, Vec3(-1, 0, 0), Spectrum::Ones(1), 0.2, 0.5}).x(), 1);
  EXPECT_GT(placed(SpotLight{"s", on, Vec3(1, 0, 0), Spectrum::Ones(1), 0.2, 0.5}).x(), 1);
  EXPECT_EQ(placed_point({1, 3.5, 2}), Vec3(1, 3.5, 2)) << "beside the partition";
}

}  // namespace
}  // namespace reemit

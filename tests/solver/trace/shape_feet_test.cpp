#include "solver/trace/shape_feet.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "solver/sampling/counter_rng.h"
#include "solver/sampling/warp.h"
#include "solver/trace/ray_tracer.h"
#include "tests/mesh/test_room.h"

namespace reemit {
namespace {

using test::TestRoom;

/// Number of a curved patch's triangle and where on it a point of the room lies.
struct OnShape {
  TriangleId triangle;
  float u, v;
};
OnShape on_shape(const RayTracer& rays, const Vec3& point, std::size_t shape = 0) {
  const TriangleId first = rays.mesh().first_patch(shape);
  const CurvedPatches& patches = rays.patches(first);
  const auto place = patches.place_of(rays.normalised(point).cast<double>());
  return {TriangleId(first.index() + place.patch), static_cast<float>(place.at.u),
          static_cast<float>(place.at.v)};
}

// A tower of radius 1 on the floor of a hall of 4 x 4 x 3 m.
TEST(ShapeFeet, FloorUnderAMantleIsOneSideAndFloorBesideItTheOther) {
  TestRoom room;
  const SurfaceId hull = room.box("hull", room.material(false), {-2, -2, 0}, {2, 2, 3}, true);
  const SurfaceId tower = room.surface("tower", room.material());
  room.scene().surfaces[tower.index()].shapes.push_back(Cylinder{{0, 0, 0}, {0, 0, 2}, 1, false});
  const MeshResult built = build_mesh(room.scene());
  const RayTracer rays(built.mesh);
  const auto is_inside = [&](TriangleId t) {
    return built.mesh.point(t, 1.0 / 3, 1.0 / 3).head<2>().norm() < 1;
  };
  const CounterRng rng(3, RngPurpose::kProbe);
  int beyond_chords = 0;
  for (std::uint32_t i = 0; i < 50'000; ++i) {
    const auto u = rng.uniform4(i, 0, 0);
    const double azimuth = 2 * std::numbers::pi * static_cast<double>(u[0]);
    // Down to the floor from inside and outside, next to the mantle.
    const double radius = 1 + 0.006 * (static_cast<double>(u[1]) - 0.5);
    if (std::abs(radius - 1) < 1e-6) continue;
    const Vec3 from(radius * std::cos(azimuth), radius * std::sin(azimuth), 0.3);
    const Vec3f d = Vec3f(0.002F * (u[2] - 0.5F), 0.002F * (u[3] - 0.5F), -1).normalized();
    Hit hit;
    ASSERT_TRUE(rays.closest(rays.normalised(from), d, hit));
    if (built.mesh.triangle(hit.triangle).surface != hull) continue;
    const Vec3 at = from + d.cast<double>() * (0.3 / -static_cast<double>(d.z()));
    EXPECT_EQ(is_inside(hit.triangle), at.head<2>().norm() < 1) << at.transpose();
    const Vec3 read = rays.in_room(rays.point(hit.triangle, hit.u, hit.v));
    EXPECT_LT((read - at).norm(), 0.006) << "moved by no more than the segment is wide";
    beyond_chords += is_inside(hit.triangle) && (read - at).norm() > 1e-5 ? 1 : 0;
  }
  EXPECT_GT(beyond_chords, 100) << "hits between chord and circle were among them";
}

TEST(ShapeFeet, RaysStartBesideTheMantleOnTheSideOfTheirTriangle) {
  TestRoom room;
  room.box("hull", room.material(false), {-2, -2, 0}, {2, 2, 3}, true);
  const SurfaceId tower = room.surface("tower", room.material());
  room.scene().surfaces[tower.index()].shapes.push_back(Cylinder{{0, 0, 0}, {0, 0, 2}, 1, false});
  const MeshResult built = build_mesh(room.scene());
  const RayTracer rays(built.mesh);
  const CounterRng rng(4, RngPurpose::kProbe);
  int moved = 0;
  for (std::uint32_t i = 0; i < 400'000; ++i) {
    const TriangleId t(i % built.mesh.flat_count());
    const bool inside = built.mesh.point(t, 1.0 / 3, 1.0 / 3).head<2>().norm() < 1;
    if (built.mesh.triangle_normal(t).z() < 0.9) continue;
    const auto u = rng.uniform4(i, 0, 0);
    const auto [a, b] = sample_triangle(u[0], u[1]);
    const Vec3 start = rays.in_room(rays.ray_origin(t, a, b, true));
    ASSERT_EQ(start.head<2>().norm() < 1, inside);
    moved += rays.in_room(rays.point(t, a, b)).head<2>().norm() < 1 && !inside ? 1 : 0;
  }
  EXPECT_GT(moved, 10) << "points between chord and circle were among them";
}

// Points nearer to where ball and floor touch than rays start off their surface.
TEST(ShapeFeet, RaysLeaveBallAndFloorWhereTheGapIsWideEnough) {
  for (const double radius : {0.05, 0.5, 1.4}) {
    TestRoom room;
    const SurfaceId hull = room.box("hull", room.material(false), {-2, -2, 0}, {2, 2, 3}, true);
    const SurfaceId ball = room.surface("ball", room.material(false));
    room.scene().surfaces[ball.index()].shapes.push_back(Sphere{{0.3, 0.2, radius}, radius, false});
    const MeshResult built = build_mesh(room.scene());
    const RayTracer rays(built.mesh);
    const CounterRng rng(5, RngPurpose::kProbe);
    const double close = 2 * std::sqrt(2 * radius * 2e-6);  // where the gap is 8 um or less
    for (std::uint32_t i = 0; i < 20'000; ++i) {
      const auto u = rng.uniform4(i, 0, 0);
      const double distance = close * static_cast<double>(u[0]);
      const double azimuth = 2 * std::numbers::pi * static_cast<double>(u[1]);
      const Vec3 foot(0.3 + distance * std::cos(azimuth), 0.2 + distance * std::sin(azimuth), 0);
      const Vec3f local = sample_cosine_hemisphere(u[2], u[3]);
      const OnShape above = on_shape(rays, foot + Vec3(0, 0, distance * distance / (2 * radius)));
      Hit hit;
      const Vec3f down = Frame(rays.normal(above.triangle, above.u, above.v)).to_world(local);
      ASSERT_TRUE(rays.closest(rays.ray_origin(above.triangle, above.u, above.v, true), down, hit));
      EXPECT_TRUE(hit.front);
      Hit floor;
      ASSERT_TRUE(rays.closest(
          rays.normalised(Vec3(1.5, 1.5, 1)),
          (rays.normalised(foot + Vec3(0, 0, 1e-9)) - rays.normalised(Vec3(1.5, 1.5, 1))).normalized(),
          floor));
      if (built.mesh.triangle(floor.triangle).surface != hull) continue;
      ASSERT_TRUE(rays.closest(rays.ray_origin(floor.triangle, floor.u, floor.v, true),
                               Frame(rays.normal(floor.triangle)).to_world(local), hit));
      EXPECT_TRUE(hit.front);
    }
  }
}

// The same where a ball stands on a disk, as on the cap of a cylinder, and on another ball.
TEST(ShapeFeet, RaysLeaveBallsAndWhatTheyStandOnWhereTheGapIsWideEnough) {
  const Vec3 touch(0.3, 0.2, 1);
  const double radius = 0.2;
  for (const CurvedShape& below : {CurvedShape(Disk{{0.25, 0.2, 1}, {0, 0, 1}, 0.3, 0}),
                                   CurvedShape(Sphere{{0.3, 0.2, 0.6}, 0.4, false})}) {
    TestRoom room;
    room.box("hull", room.material(false), {-2, -2, 0}, {2, 2, 3}, true);
    const SurfaceId round = room.surface("round", room.material(false));
    room.scene().surfaces[round.index()].shapes = {Sphere{touch + Vec3(0, 0, radius), radius, false}, below};
    const MeshResult built = build_mesh(room.scene());
    const RayTracer rays(built.mesh);
    const CounterRng rng(6, RngPurpose::kProbe);
    const double close = std::sqrt(2 * radius * 8e-6);
    for (std::uint32_t i = 0; i < 20'000; ++i) {
      const auto u = rng.uniform4(i, 0, 0);
      const double distance = close * static_cast<double>(u[0]);
      const double azimuth = 2 * std::numbers::pi * static_cast<double>(u[1]);
      const Vec3 beside = touch + Vec3(distance * std::cos(azimuth), distance * std::sin(azimuth), 0);
      const Vec3f local = sample_cosine_hemisphere(u[2], u[3]);
      for (const std::size_t shape : {0U, 1U}) {
        const OnShape from = on_shape(rays, beside, shape);
        const Vec3f away = Frame(rays.normal(from.triangle, from.u, from.v)).to_world(local);
        Hit hit;
        ASSERT_TRUE(rays.closest(rays.ray_origin(from.triangle, from.u, from.v, true), away, hit));
        EXPECT_TRUE(hit.front) << "shape " << shape << ", " << distance << " m from where they touch";
      }
    }
  }
}

// Where they touch, ball and cap are equally far from within the ball.
TEST(ShapeFeet, NothingThatTouchesABallIsSeenFromWithinIt) {
  const Vec3 touch(0.3, 0.2, 1);
  for (const CurvedShape& below : {CurvedShape(Disk{{0.25, 0.2, 1}, {0, 0, 1}, 0.3, 0}),
                                   CurvedShape(Sphere{{0.3, 0.2, 0.6}, 0.4, false}),
                                   CurvedShape(Cylinder{{0.3, -0.4, 0.9}, {0.3, 0.8, 0.9}, 0.1, false})}) {
    TestRoom room;
    room.box("hull", room.material(false), {-2, -2, 0}, {2, 2, 3}, true);
    const SurfaceId round = room.surface("round", room.material(false));
    room.scene().surfaces[round.index()].shapes = {Sphere{touch + Vec3(0, 0, 0.2), 0.2, false}, below};
    const MeshResult built = build_mesh(room.scene());
    const RayTracer rays(built.mesh);
    const CounterRng rng(7, RngPurpose::kProbe);
    int lost = 0;
    for (std::uint32_t i = 0; i < 20'000; ++i) {
      const auto u = rng.uniform4(i, 0, 0);
      const Vec3 from = touch + Vec3(0.2 * (static_cast<double>(u[0]) - 0.5),
                                     0.2 * (static_cast<double>(u[1]) - 0.5), 0.15);
      const Vec3 to =
          touch + 1e-4 * Vec3(static_cast<double>(u[2]) - 0.5, static_cast<double>(u[3]) - 0.5, 0);
      Hit hit;
      ASSERT_TRUE(rays.closest(rays.normalised(from),
                               (rays.normalised(to) - rays.normalised(from)).normalized(), hit));
      if (hit.triangle.index() < built.mesh.first_patch(0).index() ||
          hit.triangle.index() >= built.mesh.first_patch(1).index() || hit.front)
        ++lost;
    }
    EXPECT_EQ(lost, 0);
  }
}

}  // namespace
}  // namespace reemit

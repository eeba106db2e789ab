#include "solver/trace/ray_tracer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "solver/sampling/counter_rng.h"
#include "solver/sampling/warp.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using test::RoomBuilder;

/// Counts rays from everywhere on the inside of a closed box that hit nothing or a back.
int leaks(double scale, const Vec3& shift) {
  RoomBuilder room;
  const MaterialId m = room.material("wall", 0.5);
  room.box(shift, shift + scale * Vec3(1, 0.7, 0.4), {m, m, m, m, m, m}, 2);
  const MeshResult built = room.mesh();
  const RayTracer scene(built.mesh);
  const CounterRng rng(1, RngPurpose::kProbe);
  int lost = 0;
  for (std::uint32_t i = 0; i < 200'000; ++i) {
    const TriangleId t(i % built.mesh.triangle_count());
    const auto u = rng.uniform4(i, 0, 0);
    auto [a, b] = sample_triangle(u[0], u[1]);
    if (i % 7 == 0) a = 0;  // exactly on edges and corners as well
    if (i % 11 == 0) b = i % 2 == 0 ? 0.0F : 1 - a;
    const Vec3f d = Frame(scene.normal(t)).to_world(sample_cosine_hemisphere(u[2], u[3]));
    Hit hit;
    if (!scene.closest(scene.ray_origin(t, a, b, true), d, hit) || !hit.front) ++lost;
  }
  return lost;
}

TEST(RayTracer, ClosedBoxLosesNoRayAtAnyScaleAndPlace) {
  EXPECT_EQ(leaks(1, Vec3::Zero()), 0);
  EXPECT_EQ(leaks(1e-3, Vec3::Zero()), 0);
  EXPECT_EQ(leaks(1e6, Vec3::Zero()), 0);
  EXPECT_EQ(leaks(1, Vec3(1e4, -1e4, 1e4)), 0);
}

/// A low rail under a ceiling: on the long edges of its slivers a step towards their middle leads nowhere,
/// and a ray that starts in the plane of the ceiling meets its back.
TEST(RayTracer, RaysFromSliversThatEndAtACeilingStayBelowIt) {
  RoomBuilder room;
  const MaterialId m = room.material("wall", 0.5, 0, true);
  room.box(Vec3::Zero(), Vec3(16, 4.5, 8), {m, m, m, m, m, m}, 1);
  room.quad(m, {Vec3(1, 4.49, 5.015), Vec3(15, 4.49, 5.015), Vec3(15, 4.5, 5.015), Vec3(1, 4.5, 5.015)}, 1);
  const MeshResult built = room.mesh();
  const RayTracer scene(built.mesh);
  const CounterRng rng(7, RngPurpose::kProbe);
  int above = 0;
  int traced = 0;
  for (std::size_t i = 0; i < built.mesh.triangle_count(); ++i) {
    const TriangleId t(i);
    const Vec3 middle = built.mesh.point(t, 1.0 / 3, 1.0 / 3);
    if (std::abs(middle.z() - 5.015) > 1e-9 || middle.y() < 4.4) continue;
    for (std::uint32_t k = 0; k < 30'000; ++k) {
      const auto u = rng.uniform4(k, 0, static_cast<std::uint32_t>(i));
      const bool front = k % 2 == 0;
      // Each of the three edges in turn.
      const float a = k % 3 == 0 ? 0 : u[0];
      const float b = k % 3 == 1 ? 0 : k % 3 == 0 ? u[0] : 1 - u[0];
      const Vec3f n = front ? scene.normal(t) : Vec3f(-scene.normal(t));
      const Vec3f d = Frame(n).to_world(sample_cosine_hemisphere(u[2], u[3]));
      Hit hit;
      ++traced;
      if (!scene.closest(scene.ray_origin(t, a, b, front), d, hit) || !hit.front) ++above;
    }
  }
  EXPECT_GT(traced, 0);
  EXPECT_EQ(above, 0);
}

TEST(RayTracer, BlocksOfSixteenEqualSingleRays) {
  RoomBuilder room;
  const MaterialId m = room.material("wall", 0.5);
  room.box(Vec3::Zero(), Vec3(1, 1, 1), {m, m, m, m, m, MaterialId()}, 1);
  const MeshResult built = room.mesh();
  const RayTracer scene(built.mesh);
  const CounterRng rng(2, RngPurpose::kProbe);
  int misses = 0;
  for (std::uint32_t block = 0; block < 200; ++block) {
    Ray16 rays;
    Hit16 hits;
    for (int i = 0; i < 16; ++i) {
      const auto u = rng.uniform4(block, 0, static_cast<std::uint32_t>(i));
      rays.set(i, {0.1F * u[2], 0.1F * u[3], 0}, sample_sphere(u[0], u[1]));
    }
    // Lanes beyond the count may hold anything.
    for (float* lanes : {rays.ox, rays.oy, rays.oz, rays.dx, rays.dy, rays.dz})
      std::fill_n(lanes + 13, 3, std::numeric_limits<float>::quiet_NaN());
    std::memset(&hits, 0x80, sizeof hits);
    scene.closest16(rays, 13, hits);
    for (int i = 0; i < 13; ++i) {
      // A bool that nobody has set is no bool, and to read it is undefined.
      unsigned char front = 0;
      std::memcpy(&front, &hits.front[i], 1);
      ASSERT_LE(front, 1);
      Hit hit;
      const bool found = scene.closest(rays.origin(i), rays.direction(i), hit);
      ASSERT_EQ(found, hits.triangle[i] != RayTracer::kMiss);
      if (!found) {
        ++misses;
        continue;
      }
      EXPECT_EQ(hit.triangle.index(), hits.triangle[i]);
      EXPECT_EQ(hit.front, hits.front[i]);
      EXPECT_NEAR(hit.distance, hits.distance[i], 1e-5);
      EXPECT_EQ(scene.is_at_edge(hits, i), scene.is_at_edge(hits.triangle[i], hits.u[i], hits.v[i]));
    }
    for (int i = 13; i < 16; ++i) EXPECT_EQ(hits.triangle[i], RayTracer::kMiss);
  }
  EXPECT_GT(misses, 50);  // the box is open on one side
}

// A wedge of two one-sided walls, seen from outside: where they meet, rounding decides whether a ray meets
// the front of one or, a hair behind it, the back of the other.
TEST(RayTracer, AWedgeShowsFewBacksAtItsEdge) {
  RoomBuilder room;
  const MaterialId m = room.material("wall", 0.5);
  room.box(Vec3(-1, -1, -1), Vec3(1, 1, 1), {m, m, m, m, m, m}, 1);
  room.quad(m, {Vec3(0, 0.1, -1), Vec3(0, 0.1, 1), Vec3(1, 0.7, 1), Vec3(1, 0.7, -1)}, 1);
  room.quad(m, {Vec3(0, 0.1, -1), Vec3(0.9, -0.8, -1), Vec3(0.9, -0.8, 1), Vec3(0, 0.1, 1)}, 1);
  const MeshResult built = room.mesh();
  const RayTracer scene(built.mesh);
  const CounterRng rng(5, RngPurpose::kProbe);
  int first_look = 0;
  int second_look = 0;
  for (std::uint32_t block = 0; block < 20'000; ++block) {
    Ray16 rays;
    for (int i = 0; i < 16; ++i) {
      const auto u = rng.uniform4(block, 0, static_cast<std::uint32_t>(i));
      const Vec3f from(-0.9F + 0.5F * u[0], -0.8F + 1.6F * u[1], -0.5F + u[2]);
      const Vec3f at(0, 0.1F, -0.5F + u[3]);
      rays.set(i, from, (at - from).normalized());
    }
    Hit16 hits;
    const auto backs = [&] {
      int count = 0;
      for (int i = 0; i < 16; ++i) count += hits.triangle[i] == RayTracer::kMiss || !hits.front[i] ? 1 : 0;
      return count;
    };
    scene.closest16(rays, 16, hits);
    first_look += backs();
    scene.look_again16(rays, 16, hits);
    second_look += backs();
  }
  EXPECT_GT(first_look, 1000) << "rays aimed at the edge itself meet backs";
  // What remains are rays that come flat to both faces.
  EXPECT_LE(second_look, first_look / 1000);
}

// From outside, the near and the far face of a rim are equally far; which of them a ray meets first was
// decided by rounding, so that a few packets of 1e8 lit the insides of closed boxes.
TEST(RayTracer, RimsHideTheInsidesOfTwoSidedBoxes) {
  RoomBuilder room;
  const MaterialId m = room.material("wall", 0.5, 0, true);
  room.box(Vec3(-1, -1, -1), Vec3(1, 1, 1), {m, m, m, m, m, m}, 1);
  const Vec3 low(-0.3, -0.5, -0.1);
  const Vec3 high(0.1, 0.2, 0.3);
  room.solid(low, high, m, 1);
  const MeshResult built = room.mesh();
  const RayTracer scene(built.mesh);
  constexpr std::uint32_t kHullTriangles = 12;  // those of the box follow
  const CounterRng rng(6, RngPurpose::kProbe);
  const auto is_inside = [](std::uint32_t t, bool front) {
    return t != RayTracer::kMiss && t >= kHullTriangles && !front;
  };
  int first_look = 0;
  int second_look = 0;
  int alone = 0;
  for (std::uint32_t block = 0; block < 20'000; ++block) {
    Ray16 rays;
    for (int i = 0; i < 16; ++i) {
      const auto u = rng.uniform4(block, 0, static_cast<std::uint32_t>(i));
      const auto v = rng.uniform4(block, 1, static_cast<std::uint32_t>(i));
      const Vec3f from(0.2F + 0.7F * u[0], -0.9F + 1.8F * u[1], -0.9F + 1.8F * u[2]);
      const int axis = static_cast<int>(3 * u[3]);
      Vec3 at;
      for (int k = 0; k < 3; ++k) at[k] = v[static_cast<std::size_t>(k)] < 0.5F ? low[k] : high[k];
      at[axis] = low[axis] + (high[axis] - low[axis]) * static_cast<double>(v[3]);
      rays.set(i, from, (at.cast<float>() - from).normalized());
    }
    Hit16 hits;
    const auto insides = [&] {
      int count = 0;
      for (int i = 0; i < 16; ++i) count += is_inside(hits.triangle[i], hits.front[i]) ? 1 : 0;
      return count;
    };
    scene.closest16(rays, 16, hits);
    first_look += insides();
    scene.look_again16(rays, 16, hits);
    second_look += insides();
    for (int i = 0; i < 16; ++i) {
      Hit hit;
      if (scene.closest({rays.ox[i], rays.oy[i], rays.oz[i]}, {rays.dx[i], rays.dy[i], rays.dz[i]}, hit))
        alone += is_inside(static_cast<std::uint32_t>(hit.triangle.index()), hit.front) ? 1 : 0;
    }
  }
  EXPECT_GT(first_look, 1000) << "rays aimed at the rims themselves meet insides";
  // What remains passes by corners.
  EXPECT_LE(second_look, first_look / 1000);
  EXPECT_LE(alone, first_look / 1000);
}

TEST(RayTracer, VisibilityStopsAtWallsAndNotAtItsEnds) {
  RoomBuilder room;
  const MaterialId m = room.material("wall", 0.5, 0, true);
  room.box(Vec3(-1, -1, -1), Vec3(1, 1, 1), {m, m, m, m, m, m}, 1);
  room.quad(m, {Vec3(0, -0.5, -0.5), Vec3(0, 0.5, -0.5), Vec3(0, 0.5, 0.5), Vec3(0, -0.5, 0.5)}, 1);
  const MeshResult built = room.mesh();
  const RayTracer scene(built.mesh);
  const Vec3f left = scene.ray_origin(TriangleId(0), 0.3F, 0.3F, true);
  const Vec3f right = scene.ray_origin(TriangleId(2), 0.3F, 0.3F, true);
  const Vec3f floor = scene.ray_origin(TriangleId(4), 0.2F, 0.2F, true);
  EXPECT_FALSE(scene.visible(left, right));
  EXPECT_TRUE(scene.visible(left, floor));
  EXPECT_TRUE(scene.visible(floor, floor));
}

TEST(RayTracer, CamerasSeeThroughTheBacksOfOneSidedFaces) {
  RoomBuilder room;
  const MaterialId m = room.material("wall", 0.5);
  room.box(Vec3(-1, -1, -1), Vec3(1, 1, 1), {m, m, m, m, m, m}, 1);
  const MeshResult built = room.mesh();
  const RayTracer scene(built.mesh);
  Hit hit;
  ASSERT_TRUE(scene.closest(Vec3f(-3, 0.1F, 0.2F), Vec3f(1, 0, 0), hit));
  EXPECT_FALSE(hit.front);
  ASSERT_TRUE(scene.closest_for_camera(Vec3f(-3, 0.1F, 0.2F), Vec3f(1, 0, 0), hit));
  EXPECT_TRUE(hit.front);
  EXPECT_NEAR(hit.distance, 4, 1e-5);
}

}  // namespace
}  // namespace reemit

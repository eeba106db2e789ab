// Against a test of every face for every ray, in double precision, which shares nothing with the tree.

#include "solver/trace/face_sieve.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

constexpr double kBallRadius = 0.4;
const Vec3 kBallMiddle(1.1, 1.9, 0.9);

/// A closed room with a crate, tilted sheets and a sphere.
test::RoomBuilder room_of_faces() {
  test::RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5);
  room.box(Vec3::Zero(), {3, 3, 2.5}, {wall, wall, wall, wall, wall, wall}, 1);
  room.solid({1.6, 0.4, 0.01}, {2.6, 1.2, 1.1}, wall, 1);
  for (int i = 0; i < 5; ++i) {
    const double x = 0.3 + 0.5 * i;
    room.quad(wall, {Vec3(x, .2, .4), Vec3(x + .3, .2, .9), Vec3(x + .3, .5, .9), Vec3(x, .5, .4)}, 1);
  }
  room.shape(wall, Sphere{kBallMiddle, kBallRadius, false}, 1);
  return room;
}

/// How clearly a line goes through a triangle: the least of its barycentric coordinates there, below 0 if it
/// passes by; behind the start it passes by at any rate.
double depth_in_triangle(const std::array<Vec3, 3>& corner, const Vec3& origin, const Vec3& direction) {
  const Vec3 e1 = corner[1] - corner[0];
  const Vec3 e2 = corner[2] - corner[0];
  const Vec3 p = direction.cross(e2);
  const double det = e1.dot(p);
  if (std::fabs(det) < 1e-12) return -1;
  const Vec3 s = origin - corner[0];
  const double u = s.dot(p) / det;
  const double v = direction.dot(s.cross(e1)) / det;
  if (e2.dot(s.cross(e1)) / det < 0) return -1;
  return std::min({u, v, 1 - u - v});
}

/// The same of the sphere, as a share of its radius.
double depth_in_sphere(const Vec3& origin, const Vec3& direction) {
  const Vec3 to_middle = kBallMiddle - origin;
  const double along = to_middle.dot(direction);
  return along < 0 ? -1 : 1 - (to_middle - along * direction).norm() / kBallRadius;
}

// Rays that miss or go through by less than 1e-5 of a face are left to rounding.
TEST(FaceSieve, finds_the_rays_that_go_through_one_of_its_faces) {
  const test::RoomBuilder builder = room_of_faces();
  const ZoneMesh mesh = builder.mesh().mesh;
  const RayTracer rays(mesh);
  std::vector<bool> chosen(mesh.triangle_count());
  for (std::size_t t = 12; t < chosen.size(); ++t)
    chosen[t] = t % 3 == 0 || mesh.triangle(TriangleId(t)).is_curved();
  const FaceSieve sieve(rays, chosen);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal;
  std::size_t crossed = 0, compared = 0;
  for (int block = 0; block < 4000; ++block) {
    Ray16 block_rays;
    std::array<Vec3, 16> origin, direction;
    const int count = 1 + block % 16;
    for (int i = 0; i < 16; ++i) {
      const auto k = static_cast<std::size_t>(i);
      do {
        origin[k] = {3 * uniform(random), 3 * uniform(random), 2.5 * uniform(random)};
      } while ((origin[k] - kBallMiddle).norm() < 1.01 * kBallRadius);
      direction[k] = Vec3(normal(random), normal(random), normal(random)).normalized();
      block_rays.set(i, rays.normalised(origin[k]), direction[k].cast<float>());
    }
    const std::uint32_t found = sieve.crossed16(block_rays, count);
    EXPECT_EQ(found >> count, 0U) << "of " << count << " rays";
    for (int i = 0; i < count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      double depth = depth_in_sphere(origin[k], direction[k]);
      for (std::size_t t = 0; t < chosen.size(); ++t) {
        const TriangleId id(t);
        if (chosen[t] && !mesh.triangle(id).is_curved())
          depth =
              std::max(depth, depth_in_triangle({mesh.corner(id, 0), mesh.corner(id, 1), mesh.corner(id, 2)},
                                                origin[k], direction[k]));
      }
      if (std::fabs(depth) < 1e-5) continue;
      ++compared;
      crossed += depth > 0 ? 1 : 0;
      ASSERT_EQ((found >> i & 1U) != 0, depth > 0) << "ray " << i << " of block " << block << ", " << depth;
    }
  }
  EXPECT_GT(crossed, compared / 20);
  EXPECT_LT(crossed, compared / 2);
}

TEST(FaceSieve, of_no_faces_lets_nothing_through) {
  const test::RoomBuilder builder = room_of_faces();
  const ZoneMesh mesh = builder.mesh().mesh;
  const RayTracer rays(mesh);
  const FaceSieve sieve(rays, std::vector<bool>(mesh.triangle_count(), false));
  Ray16 block;
  for (int i = 0; i < 16; ++i)
    block.set(i, Vec3f::Zero(), Vec3f(1, 0.1F * static_cast<float>(i), 0).normalized());
  EXPECT_EQ(sieve.crossed16(block, 16), 0U);
}

}  // namespace
}  // namespace reemit

#include "solver/trace/shape_hit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "solver/sampling/counter_rng.h"
#include "solver/sampling/warp.h"
#include "solver/trace/ray_tracer.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::RoomBuilder;

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Signed distance-like function of a shape without its limits in height: 0 on its surface.
double surface_function(const CurvedShape& shape, const Vec3& p) {
  if (const auto* s = std::get_if<Sphere>(&shape)) return (p - s->centre).norm() - s->radius;
  const Frustum f = frustum_of(shape);
  const double h = f.axis.dot(p - f.base);
  if (f.height == 0) return h;
  const double r = (p - f.base - h * f.axis).norm();
  return r - (f.r0 + (f.r1 - f.r0) * h / f.height);
}

/// Is a zero of the function on the shape?
bool within(const CurvedShape& shape, const Vec3& p) {
  if (std::holds_alternative<Sphere>(shape)) return true;
  const Frustum f = frustum_of(shape);
  const double h = f.axis.dot(p - f.base);
  if (f.height > 0) return h >= 0 && h <= f.height;
  const double r = (p - f.base).norm();
  return r <= f.r0 && r >= f.r1;
}

/// First zero of the function along a ray by small steps and bisection.
double marched(const CurvedShape& shape, const Vec3& o, const Vec3& d, double far) {
  constexpr int kSteps = 4000;
  double t0 = 0;
  double f0 = surface_function(shape, o);
  for (int i = 1; i <= kSteps; ++i) {
    const double t1 = far * i / kSteps;
    const double f1 = surface_function(shape, o + t1 * d);
    if ((f0 < 0) != (f1 < 0)) {
      double low = t0;
      double high = t1;
      for (int k = 0; k < 50; ++k) {
        const double middle = 0.5 * (low + high);
        ((surface_function(shape, o + middle * d) < 0) == (f0 < 0) ? low : high) = middle;
      }
      if (within(shape, o + low * d)) return low;
    }
    t0 = t1;
    f0 = f1;
  }
  return kNone;
}

std::vector<CurvedShape> some_shapes() {
  return {Sphere{{0.1, -0.2, 0.3}, 0.4, false},
          Disk{{0, 0.1, 0}, Vec3(1, 2, -1).normalized(), 0.5, 0},
          Disk{{0, 0.1, 0}, Vec3(1, 2, -1).normalized(), 0.5, 0.3},
          Cylinder{{-0.3, -0.2, -0.4}, {0.2, 0.3, 0.4}, 0.3, false},
          Cone{{-0.3, -0.2, -0.4}, {0.2, 0.3, 0.4}, 0.4, 0.15, false},
          Cone{{-0.3, -0.2, -0.4}, {0.2, 0.3, 0.4}, 0.1, 0.5, true},
          Cone{{0, 0, -0.4}, {0, 0, 0.4}, 0.5, 0, false}};
}

TEST(ShapeTarget, NearestHitsAreThoseOfMarchingAlongTheRay) {
  const CounterRng rng(4, RngPurpose::kProbe);
  for (const CurvedShape& shape : some_shapes()) {
    const ShapeTarget target(shape);
    int hits = 0;
    int different = 0;
    for (std::uint32_t i = 0; i < 2000; ++i) {
      const auto a = rng.uniform4(i, 0, 0);
      const auto b = rng.uniform4(i, 1, 0);
      // Origins in the cube, so inside and outside of the shape.
      const Vec3 o = 2 * Vec3(a[0], a[1], a[2]) - Vec3::Ones();
      const Vec3 d = sample_sphere(b[0], b[1]).cast<double>();
      const double t = target.nearest(o, d, 0, 4);
      const double expected = marched(shape, o, d, 4);
      // Steps miss pairs of hits that lie closer together than a step, and rims by their width.
      if (std::isinf(t) != std::isinf(expected) || (t < kNone && std::fabs(t - expected) > 5e-6)) ++different;
      if (t < kNone) {
        ++hits;
        // Disks are hit a millionth of the way before they are reached.
        EXPECT_LT(std::fabs(surface_function(shape, o + t * d)), 4e-6);
      }
    }
    EXPECT_LE(different, 4);
    EXPECT_GT(hits, 50);
  }
}

TEST(ShapeTarget, StartsAndEndsOfRaysLimitTheHits) {
  const ShapeTarget ball(Sphere{{0, 0, 0}, 0.5, false});
  const Vec3 o(-1, 0.3, 0);  // hits at 0.6 and 1.4
  EXPECT_NEAR(ball.nearest(o, Vec3::UnitX(), 0, 9), 0.6, 1e-15);
  EXPECT_NEAR(ball.nearest(o, Vec3::UnitX(), 0.7, 9), 1.4, 1e-15);
  EXPECT_EQ(ball.nearest(o, Vec3::UnitX(), 1.5, 9), kNone);
  EXPECT_EQ(ball.nearest(o, Vec3::UnitX(), 0, 0.5), kNone);
  const ShapeTarget tube(Cylinder{{0, 0, -0.5}, {0, 0, 0.5}, 0.5, false});
  EXPECT_NEAR(tube.nearest(o, Vec3::UnitX(), 0, 9), 0.6, 1e-15);
  EXPECT_NEAR(tube.nearest(o, Vec3::UnitX(), 0.7, 9), 1.4, 1e-15);
  EXPECT_EQ(tube.nearest(o, Vec3::UnitX(), 0.7, 1.3), kNone);
  EXPECT_EQ(tube.nearest({0, 0, -1}, Vec3::UnitZ(), 0, 9), kNone);    // along the axis
  EXPECT_EQ(tube.nearest({-1, 0, 0.6}, Vec3::UnitX(), 0, 9), kNone);  // above the rim
  EXPECT_NEAR(tube.nearest({-1, 0, 0.9}, Vec3(1, 0, -0.5).normalized(), 0, 9), std::hypot(1.5, 0.75),
              1e-12);  // over the near rim, onto the far inside
}

TEST(ShapeTarget, FromWithinShapesComeBeforeWhatTouchesThem) {
  constexpr double kSooner = 2e-6;
  const ShapeTarget ball(Sphere{{0, 0, 0}, 0.5, false});
  const ShapeTarget tube(Cylinder{{0, 0, -0.5}, {0, 0, 0.5}, 0.5, false});
  for (const ShapeTarget* target : {&ball, &tube}) {
    const Vec3 within(0.1, 0, 0);
    EXPECT_NEAR(target->nearest(within, Vec3::UnitX(), 0, 9), 0.4, 1e-15);
    EXPECT_NEAR(target->first(within, Vec3::UnitX(), 0, 9), 0.4 - kSooner, 1e-15);
    EXPECT_NEAR(target->first(within, Vec3::UnitX(), 0, 0.4 - 0.5 * kSooner), 0.4 - kSooner, 1e-15);
    EXPECT_EQ(target->first(within, Vec3::UnitX(), 0, 0.39), kNone);
    EXPECT_NEAR(target->first({-1, 0, 0}, Vec3::UnitX(), 0, 9), 0.5, 1e-15) << "from outside";
  }
  EXPECT_NEAR(tube.first({-1, 0, 0.9}, Vec3(1, 0, -0.5).normalized(), 0, 9), std::hypot(1.5, 0.75), 1e-12)
      << "over the near rim, onto the far inside";
}

TEST(ShapeTarget, RaysThatTouch) {
  const ShapeTarget ball(Sphere{{0, 0, 0}, 0.5, false});
  const ShapeTarget tube(Cylinder{{0, 0, -1}, {0, 0, 1}, 0.5, false});
  for (const double gap : {1e-6, 1e-9, 1e-12}) {
    const double half = std::sqrt(0.25 - std::pow(0.5 - gap, 2));
    for (const ShapeTarget* target : {&ball, &tube}) {
      EXPECT_NEAR(target->nearest({-1, 0.5 - gap, 0}, Vec3::UnitX(), 0, 9), 1 - half, 1e-15 / half);
      EXPECT_EQ(target->nearest({-1, 0.5 + gap, 0}, Vec3::UnitX(), 0, 9), kNone);
    }
  }
  // From a point on the surface, along the tangent and a little into the body.
  EXPECT_EQ(ball.nearest({0, 0.5, 0}, Vec3(1, 1e-6, 0), 1e-9, 9), kNone);
  EXPECT_NEAR(ball.nearest({0, 0.5, 0}, Vec3(1, -1e-6, 0), 1e-9, 9), 1e-6, 1e-10);
}

TEST(ShapeTarget, SpheresOfAMillionthOfTheRoomAreExact) {
  constexpr double kRadius = 1e-6;
  const CounterRng rng(5, RngPurpose::kProbe);
  const Vec3 centre(0.7, -0.6, 0.5);
  const ShapeTarget ball(Sphere{centre, kRadius, false});
  int hits = 0;
  for (std::uint32_t i = 0; i < 10'000; ++i) {
    const auto a = rng.uniform4(i, 0, 0);
    const auto b = rng.uniform4(i, 1, 0);
    const Vec3 o = 2 * Vec3(a[0], a[1], a[2]) - Vec3::Ones();
    const Vec3 to = centre - o;
    const Vec3 side = to.cross(sample_sphere(b[0], b[1]).cast<double>()).normalized();
    const double miss = 1.2 * kRadius * static_cast<double>(b[2]);  // of the centre
    const Vec3 d = (to + miss * side).normalized();
    const double off = (to - to.dot(d) * d).norm();
    const double t = ball.nearest(o, d, 0, 9);
    if (std::fabs(off - kRadius) < 1e-12) continue;
    ASSERT_EQ(t < kNone, off < kRadius);
    if (t == kNone) continue;
    ++hits;
    EXPECT_NEAR((o + t * d - centre).norm(), kRadius, 1e-4 * kRadius);
    EXPECT_LT(t, to.norm());
  }
  EXPECT_GT(hits, 8000);
}

/// A closed box with a capped cylinder that stands on the floor, a ball and a truncated cone.
RoomBuilder mixed_room(MaterialId& wall) {
  RoomBuilder room;
  wall = room.material("wall", 0.5);
  room.box({0, 0, 0}, {3, 3, 3}, {wall, wall, wall, wall, wall, wall}, 2);
  room.shape(wall, Cylinder{{1, 1, 0}, {1, 1, 1.1}, 0.4, false}, 2);
  room.shape(wall, Disk{{1, 1, 1.1}, {0, 0, 1}, 0.4, 0}, 2);
  room.shape(wall, Sphere{{2.2, 0.8, 0.9}, 0.5, false}, 2);
  room.shape(wall, Cone{{1, 2.2, 1}, {1.2, 2.2, 2}, 0.5, 0.2, false}, 2);
  room.shape(wall, Disk{{2.2, 2.2, 2}, Vec3(1, 1, 1).normalized(), 0.5, 0.2}, 2);
  return room;
}

TEST(CurvedRayTracer, BlocksOfSixteenEqualSingleRays) {
  MaterialId wall;
  const RoomBuilder room = mixed_room(wall);
  const MeshResult built = room.mesh();
  const RayTracer scene(built.mesh);
  const CounterRng rng(6, RngPurpose::kProbe);
  int curved = 0;
  for (std::uint32_t block = 0; block < 2000; ++block) {
    Ray16 rays;
    Hit16 hits;
    const int count = 1 + static_cast<int>(block % 16);
    for (int i = 0; i < count; ++i) {
      const auto u = rng.uniform4(block, 0, static_cast<std::uint32_t>(i));
      const auto w = rng.uniform4(block, 1, static_cast<std::uint32_t>(i));
      rays.set(i, scene.normalised(3 * Vec3(u[2], u[3], w[0])), sample_sphere(u[0], u[1]));
    }
    scene.closest16(rays, count, hits);
    for (int i = 0; i < count; ++i) {
      Hit hit;
      ASSERT_TRUE(scene.closest(rays.origin(i), rays.direction(i), hit));
      ASSERT_EQ(hit.triangle.index(), hits.triangle[i]);
      EXPECT_EQ(hit.front, hits.front[i]);
      EXPECT_NEAR(hit.distance, hits.distance[i], 1e-6);
      EXPECT_NEAR(hit.u, hits.u[i], 1e-4);
      EXPECT_NEAR(hit.v, hits.v[i], 1e-4);
      curved += scene.is_curved(hit.triangle) ? 1 : 0;
    }
  }
  EXPECT_GT(curved, 2000);
}

TEST(CurvedRayTracer, HitsLieWhereTheRayMeetsTheShapeAndOnItsNormal) {
  MaterialId wall;
  const RoomBuilder room = mixed_room(wall);
  const MeshResult built = room.mesh();
  const RayTracer scene(built.mesh);
  const CounterRng rng(7, RngPurpose::kProbe);
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    const auto u = rng.uniform4(i, 0, 0);
    const auto w = rng.uniform4(i, 1, 0);
    const Vec3f d = sample_sphere(u[0], u[1]);
    const Vec3f o = scene.normalised(3 * Vec3(u[2], u[3], w[0]));
    Hit hit;
    ASSERT_TRUE(scene.closest(o, d, hit));
    const Vec3f at = o + hit.distance * d;
    ASSERT_LT((scene.point(hit.triangle, hit.u, hit.v) - at).norm(), 4e-6F) << "2e-6 sooner from within";
    const float cosine = scene.normal(hit.triangle, hit.u, hit.v).dot(d);
    if (std::fabs(cosine) > 1e-3F) {
      EXPECT_EQ(hit.front, cosine < 0);
    }
  }
}

TEST(CurvedRayTracer, VisibilityStopsAtShapesAndNotAtItsEnds) {
  MaterialId wall;
  const RoomBuilder room = mixed_room(wall);
  const MeshResult built = room.mesh();
  const RayTracer scene(built.mesh);
  const CounterRng rng(8, RngPurpose::kProbe);
  int seen = 0;
  int hidden = 0;
  for (std::uint32_t i = 0; i < 400'000; ++i) {
    const auto u = rng.uniform4(i, 0, 0);
    const auto w = rng.uniform4(i, 1, 0);
    const auto count = static_cast<float>(built.mesh.triangle_count());
    const TriangleId t0(static_cast<std::size_t>(w[0] * count));
    const TriangleId t1(static_cast<std::size_t>(w[1] * count));
    const auto [a0, b0] = sample_triangle(u[0], u[1]);
    const auto [a1, b1] = sample_triangle(u[2], u[3]);
    const Vec3f from = scene.ray_origin(t0, a0, b0, true);
    const Vec3f to = scene.ray_origin(t1, a1, b1, true);
    const float distance = (to - from).norm();
    // Only ends that face each other: what asks for visibility has looked at the horizons.
    if (distance < 1e-3F || scene.normal(t0, a0, b0).dot(to - from) < 1e-3F * distance ||
        scene.normal(t1, a1, b1).dot(from - to) < 1e-3F * distance)
      continue;
    Hit hit;
    ASSERT_TRUE(scene.closest(from, (to - from) / distance, hit));
    if (std::fabs(hit.distance - distance) < 1e-4F) continue;  // too close to call
    ASSERT_EQ(scene.visible(from, to), hit.distance > distance) << i;
    EXPECT_EQ(scene.visible(from, to), scene.visible(to, from)) << i;
    (hit.distance > distance ? seen : hidden) += 1;
  }
  EXPECT_GT(hidden, 1000);
  EXPECT_GT(seen, 400);
}

/// Rays from everywhere on the fronts but covered points, many from rims and corners, that meet nothing or a
/// back.
template <class Covered>
int lost_rays(const RoomBuilder& room, std::uint32_t count, const Covered& covered) {
  const MeshResult built = room.mesh();
  const RayTracer scene(built.mesh);
  const CounterRng rng(9, RngPurpose::kProbe);
  int lost = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const TriangleId t(i % built.mesh.triangle_count());
    const auto u = rng.uniform4(i, 0, 0);
    auto [a, b] = sample_triangle(u[0], u[1]);
    if (i % 7 == 0) a = 0;
    if (i % 11 == 0) b = i % 2 == 0 ? 0.0F : 1 - a;
    if (covered(scene.in_room(scene.point(t, a, b)))) continue;
    const Vec3f n = scene.normal(t, a, b);
    const Vec3f d = Frame(n).to_world(sample_cosine_hemisphere(u[2], u[3]));
    Hit hit;
    if (!scene.closest(scene.ray_origin(t, a, b, true), d, hit) || !hit.front) ++lost;
  }
  return lost;
}

TEST(CurvedRayTracer, AMillionRaysStayInAClosedRoom) {
  for (const double scale : {1.0, 1e-3, 1e4}) {
    RoomBuilder room;
    const MaterialId wall = room.material("wall", 0.5);
    room.box({0, 0, 0}, scale * Vec3(3, 3, 3), {wall, wall, wall, wall, wall, wall}, 2);
    room.shape(wall, Cylinder{scale * Vec3(1, 1, 0), scale * Vec3(1, 1, 1.1), scale * 0.4, false}, 2);
    room.shape(wall, Disk{scale * Vec3(1, 1, 1.1), {0, 0, 1}, scale * 0.4, 0}, 2);
    const auto below_cylinder = [&](const Vec3& p) {
      return p.z() < 1e-5 * scale && std::hypot(p.x() - scale, p.y() - scale) < 0.40002 * scale;
    };
    EXPECT_EQ(lost_rays(room, scale == 1 ? 1'000'000 : 200'000, below_cylinder), 0) << scale;
  }
}

TEST(CurvedRayTracer, RaysAtTheRimOfACappedCylinderDoNotSlipInside) {
  RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5);
  const Vec3 top(0.3, -0.2, 0.4);
  const Vec3 base(-0.2, 0.1, -0.5);
  const Vec3 axis = (top - base).normalized();
  room.box({-1, -1, -1}, {1, 1, 1}, {wall, wall, wall, wall, wall, wall}, 1);
  room.shape(wall, Cylinder{base, top, 0.25, false}, 1);
  room.shape(wall, Disk{top, axis, 0.25, 0}, 1);
  room.shape(wall, Disk{base, -axis, 0.25, 0}, 1);
  const MeshResult built = room.mesh();
  const RayTracer scene(built.mesh);
  const CounterRng rng(10, RngPurpose::kProbe);
  const Vec3 u = axis.unitOrthogonal();
  const Vec3 v = axis.cross(u);
  int backs = 0;
  int bodies = 0;
  for (std::uint32_t i = 0; i < 500'000; ++i) {
    const auto r = rng.uniform4(i, 0, 0);
    const auto s = rng.uniform4(i, 1, 0);
    const double phi = 2 * pi * static_cast<double>(r[0]);
    // Aims within a few roundings of the rim.
    const double near_rim = 4e-7 * (2 * static_cast<double>(s[0]) - 1);
    const Vec3 aim = (i % 2 == 0 ? top : base) + (0.25 + near_rim) * (std::cos(phi) * u + std::sin(phi) * v);
    const Vec3 from = 0.95 * (2 * Vec3(r[1], r[2], r[3]) - Vec3::Ones());
    const double h = axis.dot(from - base);
    const double radius = (from - base - h * axis).norm();
    if (radius < 0.26 && h > -0.01 && h < axis.dot(top - base) + 0.01) continue;  // inside
    Hit hit;
    const Vec3f d = (aim - from).normalized().cast<float>();
    ASSERT_TRUE(scene.closest(scene.normalised(from), d, hit));
    backs += hit.front ? 0 : 1;
    bodies += scene.is_curved(hit.triangle) ? 1 : 0;
  }
  EXPECT_EQ(backs, 0);
  EXPECT_GT(bodies, 100'000);
}

}  // namespace
}  // namespace reemit

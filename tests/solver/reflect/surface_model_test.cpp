#include "solver/reflect/surface_model.h"

#include <array>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "solver/room/room.h"
#include "solver/sampling/sobol.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::rgb;
using test::RoomBuilder;

/// Three triangles: a one-sided wall, a two-sided one, and a lamp with a narrow beam from both of its sides.
class Surfaces : public testing::Test {
 protected:
  Surfaces() {
    const std::array<Vec3, 3> corners{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    room_.triangle(room_.material("one-sided", rgb(0.2, 0.4, 0.6), rgb(0, 0, 0)), corners, 2);
    room_.triangle(room_.material("two-sided", rgb(0.1, 0.9, 0.3), rgb(0, 0, 0), true), corners, 1);
    const MaterialId lamp = room_.material("lamp", rgb(0.5, 0.5, 0.5), pi * rgb(1, 2, 3), true);
    room_.scene().materials[lamp.index()].emits_both_sides = true;
    room_.scene().materials[lamp.index()].emission_exponent = 4;
    room_.triangle(lamp, corners, 1);
    mesh_ = room_.mesh().mesh;
    walls_.emplace(room_.scene(), mesh_);
  }
  const SurfaceModel& surfaces() const { return walls_->surfaces(); }

  RoomBuilder room_{BandSet::rgb()};
  ZoneMesh mesh_{BaseMesh{}};
  std::optional<Room> walls_;
};

TEST_F(Surfaces, KnowWhatEachSideReflects) {
  EXPECT_EQ(surfaces().surface_count(), 3U);
  EXPECT_EQ(surfaces().band_count(), 3U);
  EXPECT_EQ(surfaces().reflectance(SurfaceId(0), true)[1], 0.4);
  EXPECT_EQ(surfaces().largest_reflectance(ZoneId(0), TriangleId(1), true), 0.9);
  EXPECT_EQ(surfaces().reflectance(TriangleId(0), true)[2], 0.6F);
  EXPECT_EQ(surfaces().reflectance(TriangleId(0), false)[2], 0.0F) << "the back of a one-sided face absorbs";
  EXPECT_EQ(surfaces().reflectance(TriangleId(1), false)[0], 0.1F);
}

TEST_F(Surfaces, KnowWhatEachSideEmits) {
  EXPECT_FALSE(surfaces().emits(TriangleId(0), true));
  EXPECT_TRUE(surfaces().emits(TriangleId(2), true));
  EXPECT_TRUE(surfaces().emits(TriangleId(2), false));
  EXPECT_TRUE(surfaces().emits(SurfaceId(2)));
  EXPECT_EQ(surfaces().emitted(TriangleId(1), true)[0], 0.0F);
  // The power of the beam is its integral: emitted() pi = exitance = integral of emission_shape cos.
  double integral = 0;
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    const double cosine = (i + 0.5) / kSteps;
    integral += 2 * pi * cosine / kSteps *
                static_cast<double>(surfaces().emission_shape(TriangleId(2), static_cast<float>(cosine)));
  }
  EXPECT_NEAR(integral, pi, 1e-5);
  EXPECT_NEAR(static_cast<double>(surfaces().emitted(TriangleId(2), true)[1]) * pi,
              surfaces().exitance(SurfaceId(2))[1], 1e-6);
  EXPECT_EQ(surfaces().emission_shape(TriangleId(0), 0.3F), 1.0F);
}

TEST_F(Surfaces, ReflectTheirReflectanceAndAreReciprocal) {
  SurfacePoint x = surface_point(walls_->rays(), TriangleId(1), 0.3F, 0.3F, false);
  const SobolSequence numbers(5);
  constexpr std::uint32_t kSamples = 1 << 12;
  double albedo[3] = {};
  for (std::uint32_t k = 0; k < kSamples; ++k) {
    x.towards = surfaces().sample(x, numbers.sample(k, 2), numbers.sample(k, 3)).direction;
    const ScatterSample s = surfaces().sample(x, numbers.sample(k, 0), numbers.sample(k, 1));
    ASSERT_GT(s.direction.dot(x.normal), 0);
    ASSERT_NEAR(s.direction.norm(), 1, 1e-5);
    SurfaceModel::PointValues here;
    const BrdfValue there = surfaces().value(x, s.direction, here);
    SurfacePoint back = x;
    back.towards = s.direction;
    for (std::size_t b = 0; b < 3; ++b) {
      EXPECT_EQ(there(b), surfaces().value(back, x.towards, here)(b));
      albedo[b] += static_cast<double>(there(b) * s.cosine_over_pdf) / kSamples;
    }
  }
  for (std::size_t b = 0; b < 3; ++b)
    EXPECT_NEAR(albedo[b], surfaces().reflectance(SurfaceId(1), true)[b], 1e-6) << b;
}

TEST_F(Surfaces, SampleByTheDensityTheyState) {
  // The integral of the cosine over the hemisphere, by samples of the stated density: cos^2 has the mean 1/2.
  const SurfacePoint x = surface_point(walls_->rays(), TriangleId(0), 0.3F, 0.3F, true);
  const SobolSequence numbers(6);
  constexpr std::uint32_t kSamples = 1 << 14;
  double sum = 0;
  for (std::uint32_t k = 0; k < kSamples; ++k) {
    const ScatterSample s = surfaces().sample(x, numbers.sample(k, 0), numbers.sample(k, 1));
    sum += static_cast<double>(s.cosine_over_pdf * s.direction.dot(x.normal)) / kSamples;
  }
  EXPECT_NEAR(sum, 2 * pi / 3, 2e-3);
}

TEST(SurfacePoint, OfAHitLooksBackAlongTheRay) {
  RoomBuilder room;
  const MaterialId grey = room.material("grey", 0.5);
  room.box(Vec3::Zero(), {1, 1, 1}, {grey, grey, grey, grey, grey, grey}, 1);
  const ZoneMesh mesh = room.mesh().mesh;
  const Room walls(room.scene(), mesh);
  const Vec3f direction = Vec3f(0.3F, -0.2F, -1).normalized();
  Hit hit;
  ASSERT_TRUE(walls.rays().closest(walls.rays().normalised({0.5, 0.5, 0.5}), direction, hit));
  const SurfacePoint x = surface_point(walls.rays(), hit, direction);
  EXPECT_EQ(x.towards, Vec3f(-direction));
  EXPECT_NEAR(x.normal.dot(x.towards), -direction.z(), 1e-6);
  EXPECT_EQ(surface_point(walls.rays(), hit.triangle, hit.u, hit.v, hit.front).towards, Vec3f(0, 0, 0));
}

}  // namespace
}  // namespace reemit

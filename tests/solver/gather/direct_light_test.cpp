#include "solver/gather/direct_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "solver/sampling/warp.h"
#include "tests/support/mean_test.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::MeanTest;
using test::RoomBuilder;

/// A room with what direct light needs.
struct Lit {
  explicit Lit(const RoomBuilder& room)
      : mesh(room.mesh().mesh), walls(room.scene(), mesh), direct(walls), bands(room.scene().bands.count()) {}

  /// Independent estimates of the irradiance of the first band at a point.
  MeanTest irradiance(const SurfacePoint& x, int samples = 64) const {
    MeanTest result;
    for (std::uint64_t replicate = 0; replicate < 48; ++replicate) {
      std::vector<double> sum(bands, 0.0);
      direct.add_samples(x, SobolSequence(500 + replicate), 0, samples, sum.data());
      result.add(sum[0] / samples);
    }
    return result;
  }
  SurfacePoint point(std::size_t triangle, float u, float v, bool front = true) const {
    return surface_point(walls.rays(), TriangleId(triangle), u, v, front);
  }

  ZoneMesh mesh;
  Room walls;
  DirectLight direct;
  std::size_t bands;
};

/// A square receiver in the plane z = 0, facing up, whose first triangle has `middle` at (1/2, 0).
void add_receiver(RoomBuilder& room, const Vec3& middle, double half) {
  const Vec3 x(half, 0, 0);
  const Vec3 y(0, half, 0);
  room.triangle(room.material("receiver", 0.5), {middle - x, middle + x, middle + y}, 1);
}

void add_downward(RoomBuilder& room, MaterialId material, double x0, double x1, double y0, double y1,
                  double z) {
  room.quad(material, {Vec3(x0, y0, z), Vec3(x0, y1, z), Vec3(x1, y1, z), Vec3(x1, y0, z)}, 1);
}

TEST(DirectLight, rectangle_over_a_point) {
  RoomBuilder room;
  add_receiver(room, {0, 0, 0}, 0.2);
  add_downward(room, room.material("lamp", 0, pi), -0.5, 0.5, -0.5, 0.5, 1);
  const Lit lit(room);
  const MeanTest e = lit.irradiance(lit.point(0, 0.5F, 0));
  EXPECT_TRUE(e.agrees_with(0.7522746884541075));  // irr.rect.center of the validation page
  EXPECT_TRUE(e.would_notice(0.02, 0.7522746884541075));
}

TEST(DirectLight, a_bias_of_two_percent_is_rejected) {
  RoomBuilder room;
  add_receiver(room, {0, 0, 0}, 0.2);
  add_downward(room, room.material("lamp", 0, 1.02 * pi), -0.5, 0.5, -0.5, 0.5, 1);
  const Lit lit(room);
  EXPECT_FALSE(lit.irradiance(lit.point(0, 0.5F, 0)).agrees_with(0.7522746884541075));
}

TEST(DirectLight, does_not_depend_on_scale_or_place) {
  for (const double scale : {1e-3, 1.0, 1e6}) {
    RoomBuilder room;
    const Vec3 shift(scale * 1e3, -scale * 1e3, scale * 500);
    const auto at = [&](double x, double y, double z) { return Vec3(scale * Vec3(x, y, z) + shift); };
    room.triangle(room.material("receiver", 0.5), {at(-0.2, 0, 0), at(0.2, 0, 0), at(0, 0.2, 0)}, 1);
    room.quad(room.material("lamp", 0, pi),
              {at(-0.5, -0.5, 1), at(-0.5, 0.5, 1), at(0.5, 0.5, 1), at(0.5, -0.5, 1)}, 1);
    const Lit lit(room);
    EXPECT_TRUE(lit.irradiance(lit.point(0, 0.5F, 0)).agrees_with(0.7522746884541075)) << scale;
  }
}

TEST(DirectLight, umbra_inside_the_light) {
  // occ.rect.annulus: 2x2 light at z = 2, blocker 0.5 x 0.5 at z = 1, receiver on the axis.
  RoomBuilder room;
  add_receiver(room, {0, 0, 0}, 0.1);
  add_downward(room, room.material("lamp", 0, pi), -1, 1, -1, 1, 2);
  add_downward(room, room.material("blocker", 0.5), -0.25, 0.25, -0.25, 0.25, 1);
  const Lit lit(room);
  const MeanTest e = lit.irradiance(lit.point(0, 0.5F, 0), 1024);
  EXPECT_TRUE(e.agrees_with(0.521437890723937));
  EXPECT_TRUE(e.would_notice(0.02, 0.521437890723937));
}

TEST(DirectLight, two_sided_lamps_light_both_sides_and_one_sided_ones_do_not) {
  for (const bool both : {false, true}) {
    RoomBuilder room;
    add_receiver(room, {0, 0, 0}, 0.2);
    const MaterialId lamp = room.material("lamp", 0, pi, both);
    room.scene().materials[lamp.index()].emits_both_sides = both;
    // Faces up, away from the receiver.
    room.quad(lamp, {Vec3(-0.5, -0.5, 1), Vec3(0.5, -0.5, 1), Vec3(0.5, 0.5, 1), Vec3(-0.5, 0.5, 1)}, 1);
    const Lit lit(room);
    const MeanTest e = lit.irradiance(lit.point(0, 0.5F, 0));
    if (both)
      EXPECT_TRUE(e.agrees_with(0.7522746884541075));
    else
      EXPECT_EQ(e.mean(), 0);
  }
}

TEST(DirectLight, point_light_follows_the_inverse_square_of_metres) {
  for (const double height : {0.5, 1.0, 4.0}) {
    RoomBuilder room;
    add_receiver(room, {0, 0, 0}, 3);
    room.scene().lights.push_back(PointLight{"lamp", {1, 0, height}, Spectrum::Constant(1, 7.0)});
    const Lit lit(room);
    const double r2 = 1 + height * height;
    EXPECT_TRUE(lit.irradiance(lit.point(0, 0.5F, 0)).agrees_with(7 * height / std::pow(r2, 1.5)));
  }
}

TEST(DirectLight, spot_falls_off_as_the_specification_says) {
  const double inner = 0.3;
  const double outer = 0.6;
  for (const double angle : {0.0, 0.25, 0.45, 0.59, 0.61}) {
    RoomBuilder room;
    add_receiver(room, {0, 0, 0}, 3);
    const Vec3 direction(std::sin(angle), 0, -std::cos(angle));
    room.scene().lights.push_back(
        SpotLight{"spot", {0, 0, 2}, direction, Spectrum::Constant(1, 8.0), inner, outer});
    const Lit lit(room);
    const double linear =
        std::clamp((std::cos(angle) - std::cos(outer)) / (std::cos(inner) - std::cos(outer)), 0.0, 1.0);
    const double expected = 8.0 / 4 * linear * linear;
    EXPECT_NEAR(lit.irradiance(lit.point(0, 0.5F, 0)).mean(), expected, 2e-4);
  }
}

TEST(DirectLight, parallel_light_falls_with_the_cosine_and_is_blocked) {
  RoomBuilder room;
  add_receiver(room, {0, 0, 0}, 1);
  add_receiver(room, {10, 0, 0}, 1);
  add_downward(room, room.material("roof", 0.5), 9, 14, -3, 3, 1);
  const Vec3 direction = Vec3(-0.6, 0, -0.8);
  room.scene().lights.push_back(DirectionalLight{"sun", direction, Spectrum::Constant(1, 5.0)});
  const Lit lit(room);
  EXPECT_TRUE(lit.irradiance(lit.point(0, 0.5F, 0)).agrees_with(5 * 0.8));
  EXPECT_EQ(lit.irradiance(lit.point(1, 0.5F, 0)).mean(), 0);
}

TEST(DirectLight, dark_sealed_room_inside_a_bright_one_gets_exactly_nothing) {
  RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5, 0, true);
  const MaterialId lamp = room.material("lamp", 0.5, 1, true);
  room.box({-1, -1, -1}, {1, 1, 1}, {wall, wall, wall, wall, wall, wall}, 1);
  room.box({-3, -3, -3}, {3, 3, 3}, {lamp, lamp, lamp, lamp, lamp, lamp}, 1);
  room.scene().lights.push_back(PointLight{"bulb", {2, 2, 2}, Spectrum::Constant(1, 100.0)});
  const Lit lit(room);
  const SobolSequence places(3);
  double sum = 0;
  for (std::uint32_t i = 0; i < 12 * 2048; ++i) {
    // A share of the points lies on the edges, where leaks show first.
    const bool edge = i % 4 == 0;
    const auto [u, v] = sample_triangle(edge ? 1.0F : places.sample(i, 0), places.sample(i, 1));
    lit.direct.add_samples(lit.point(i % 12, u, v), SobolSequence(i), 0, 4, &sum);
  }
  EXPECT_EQ(sum, 0);
}

TEST(DirectLight, many_luminaires_are_chosen_without_bias) {
  // 20 x 20 lamps of very different strength above a receiver: far more than can all be tried per sample.
  RoomBuilder room;
  add_receiver(room, {0, 0, 0}, 0.1);
  double expected = 0;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) {
      const Vec3 p(0.5 * (i - 9.5), 0.5 * (j - 9.5), 2 + 0.1 * ((i * 7 + j * 3) % 5));
      const double intensity = (i * 31 + j * 17) % 23 == 0 ? 50 : 1;
      room.scene().lights.push_back(PointLight{"lamp", p, Spectrum::Constant(1, intensity)});
      expected += intensity * p.z() / std::pow(p.squaredNorm(), 1.5);
    }
  const Lit lit(room);
  const MeanTest e = lit.irradiance(lit.point(0, 0.5F, 0));
  EXPECT_TRUE(e.agrees_with(expected));
  EXPECT_TRUE(e.would_notice(0.02, expected));
}

TEST(DirectLight, bands_keep_their_own_light) {
  RoomBuilder room(BandSet::rgb());
  add_receiver(room, {0, 0, 0}, 1);
  const Spectrum intensity = Eigen::Array3d(1, 2, 0);
  room.scene().lights.push_back(PointLight{"lamp", {0, 0, 1}, intensity});
  const Lit lit(room);
  std::vector<double> sum(3, 0.0);
  std::vector<double> squares(3, 0.0);
  lit.direct.add_samples(lit.point(0, 0.5F, 0), SobolSequence(1), 0, 8, sum.data(), squares.data());
  EXPECT_NEAR(sum[0], 8, 1e-3);
  EXPECT_NEAR(sum[1], 16, 1e-3);
  EXPECT_EQ(sum[2], 0);
  EXPECT_NEAR(squares[1], 32, 1e-2);
}

TEST(DirectLight, room_without_luminaires_is_black) {
  RoomBuilder room;
  add_receiver(room, {0, 0, 0}, 1);
  const Lit lit(room);
  EXPECT_TRUE(lit.direct.empty());
  double sum = 0;
  lit.direct.add_samples(lit.point(0, 0.5F, 0), SobolSequence(1), 0, 8, &sum);
  EXPECT_EQ(sum, 0);
}

/// Irradiance at (0,0,0) upwards of a shape of radiance 1 that lets `clear` through and emits on both sides.
MeanTest light_of_clear(const CurvedShape& shape, double clear) {
  RoomBuilder room;
  add_receiver(room, {0, 0, 0}, 0.002);
  const MaterialId lamp = room.material("lamp", 0, pi, true);
  Material& material = room.scene().materials[lamp.index()];
  material.emits_both_sides = true;
  if (clear > 0) material.non_diffuse.specular_transmittance = room.flat(clear);
  room.shape(lamp, shape, 2);
  const Lit lit(room);
  return lit.irradiance(lit.point(0, 0.5F, 0), 256);
}

// The far inner side is seen through the wall before it, at the same places of the picture.
TEST(DirectLight, far_side_of_a_clear_sphere) {
  for (const double clear : {0.0, 0.5, 1.0}) {
    const MeanTest e = light_of_clear(Sphere{{0, 0, 2}, 0.5}, clear);
    const double truth = (1 + clear) * pi * 0.5 * 0.5 / (2 * 2);
    EXPECT_TRUE(e.agrees_with(truth)) << clear << ": " << e.mean() << " against " << truth;
    EXPECT_TRUE(e.would_notice(0.02, truth));
  }
}

// Its axis lies level: whatever is seen of the inside is seen through the wall before it.
TEST(DirectLight, far_side_of_a_clear_cylinder) {
  const double radius = 0.4;
  const double clear = 0.6;
  double truth = 0;
  constexpr int kSteps = 600;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double angle = 2 * pi * (i + 0.5) / kSteps;
      const Vec3 outwards(0, std::cos(angle), std::sin(angle));
      const Vec3 p = Vec3((j + 0.5) / kSteps - 0.5, 0, 2) + radius * outwards;
      const double cos_outside = -outwards.dot(p) / p.norm();
      const double seen = cos_outside > 0 ? cos_outside : -clear * cos_outside;
      truth += p.z() / p.norm() * seen / p.squaredNorm() * 2 * pi * radius / (kSteps * kSteps);
    }
  const MeanTest e = light_of_clear(Cylinder{{-0.5, 0, 2}, {0.5, 0, 2}, radius}, clear);
  EXPECT_TRUE(e.agrees_with(truth)) << e.mean() << " against " << truth;
  EXPECT_TRUE(e.would_notice(0.02, truth));
}

}  // namespace
}  // namespace reemit

// Direct light of every shape of luminaire against contour integrals, from a thousandth to a thousand times
// its size away.

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "solver/gather/direct_light.h"
#include "tests/support/contour_irradiance.h"
#include "tests/support/mean_test.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::Contour;
using test::MeanTest;
using test::RoomBuilder;

/// A luminaire of radiance 1 and size about 1, what the contour integral says of it, and where it is looked
/// at from.
struct Lamp {
  std::string name;
  bool both_sides = false;
  std::function<void(RoomBuilder&, MaterialId)> add;
  std::function<double(const Vec3& x, const Vec3& n)> irradiance;
  Vec3 near_point;  ///< On the luminaire.
  Vec3 away;        ///< Unit direction in which points leave it.
  /// A pane stands behind the receiver: shadow rays ask what they meet, not whether they meet anything.
  bool beside_a_pane = false;
};

constexpr std::array<std::array<double, 2>, 4> kRectangle{{{0, 0}, {1, 0}, {1, 0.7}, {0, 0.7}}};
/// An arrow with a notch and a hole.
constexpr std::array<std::array<double, 2>, 7> kNotched{
    {{0, 0}, {1, 0}, {1, 0.8}, {0.7, 0.8}, {0.6, 0.3}, {0.4, 0.8}, {0, 0.8}}};
constexpr std::array<std::array<double, 2>, 4> kHole{{{0.1, 0.1}, {0.3, 0.1}, {0.3, 0.5}, {0.1, 0.4}}};

template <std::size_t N>
Contour in_plane(const std::array<std::array<double, 2>, N>& corners) {
  Contour points;
  for (const auto& [a, b] : corners) points.emplace_back(a - 0.5, b - 0.35, 0);
  return points;
}

void add_polygon(RoomBuilder& room, MaterialId material, const std::vector<Contour>& loops) {
  Surface s;
  s.name = "lamp";
  s.material = material;
  Face& face = s.faces.emplace_back();
  for (const Contour& loop : loops) {
    std::vector<std::uint32_t> indices;
    for (const Vec3& p : loop) {
      indices.push_back(static_cast<std::uint32_t>(s.positions.size()));
      s.positions.push_back(p);
    }
    if (face.outer.empty())
      face.outer = indices;
    else
      face.holes.push_back(indices);
  }
  room.scene().surfaces.push_back(s);
}

Lamp polygon_lamp(const std::string& name, const std::vector<Contour>& loops, const Vec3& near_point) {
  return {name,
          false,
          [loops](RoomBuilder& room, MaterialId m) { add_polygon(room, m, loops); },
          [loops](const Vec3& x, const Vec3& n) {
            double sum = 2 * test::contour_irradiance(loops.front(), x, n);
            for (const Contour& loop : loops) sum -= test::contour_irradiance(loop, x, n);
            return sum;  // the outer loop less the holes
          },
          near_point,
          Vec3::UnitZ()};
}

Lamp shape_lamp(const std::string& name, const CurvedShape& shape,
                std::function<double(const Vec3&, const Vec3&)> irradiance, const Vec3& near_point,
                const Vec3& away) {
  return {name,
          false,
          [shape](RoomBuilder& room, MaterialId m) { room.shape(m, shape, 1); },
          std::move(irradiance),
          near_point,
          away};
}

Lamp rectangle_lamp() {
  return polygon_lamp("rectangle", {in_plane(kRectangle)}, {0.1, 0.05, 0});
}
Lamp triangle_lamp() {
  return polygon_lamp("triangle", {{{-0.5, -0.4, 0}, {0.6, -0.3, 0}, {-0.1, 0.5, 0}}}, {0, -0.1, 0});
}
Lamp notched_lamp() {
  return polygon_lamp("polygon with a notch and a hole", {in_plane(kNotched), in_plane(kHole)},
                      {0.4, 0.1, 0});
}
Lamp disk_lamp() {
  const Disk disk{{0, 0, 0}, {0, 0, 1}, 0.5, 0};
  return shape_lamp(
      "disk", disk,
      [](const Vec3& x, const Vec3& n) {
        return test::contour_irradiance(test::circle(Vec3::Zero(), Vec3::UnitZ(), 0.5), x, n);
      },
      {0.1, 0.2, 0}, Vec3::UnitZ());
}
Lamp ring_lamp() {
  return shape_lamp(
      "ring", Disk{{0, 0, 0}, {0, 0, 1}, 0.5, 0.2},
      [](const Vec3& x, const Vec3& n) {
        return test::contour_irradiance(test::circle(Vec3::Zero(), Vec3::UnitZ(), 0.5), x, n) -
               test::contour_irradiance(test::circle(Vec3::Zero(), Vec3::UnitZ(), 0.2), x, n);
      },
      {0.3, 0.15, 0}, Vec3::UnitZ());
}
Lamp sphere_lamp() {
  return shape_lamp(
      "sphere", Sphere{{0, 0, 0}, 0.5, false},
      [](const Vec3& x, const Vec3& n) {
        return test::contour_irradiance(test::outline_of_sphere(Vec3::Zero(), 0.5, x), x, n);
      },
      {0.5, 0, 0}, Vec3::UnitX());
}
Lamp cylinder_lamp() {
  return shape_lamp(
      "cylinder", Cylinder{{0, 0, -0.5}, {0, 0, 0.5}, 0.2, false},
      [](const Vec3& x, const Vec3& n) {
        return test::contour_irradiance(test::outline_of_cylinder({0, 0, -0.5}, {0, 0, 0.5}, 0.2, x), x, n);
      },
      {0.2, 0, 0.1}, Vec3(1, 0, 0));
}
std::vector<Lamp> all_lamps() {
  return {rectangle_lamp(), triangle_lamp(), notched_lamp(), disk_lamp(),
          ring_lamp(),      sphere_lamp(),   cylinder_lamp()};
}

/// The room of a lamp and a small black receiver, meshed as the program does it.
class LitReceiver {
 public:
  /// The triangle's centroid is x, its size `size` [m].
  LitReceiver(const Lamp& lamp, const Vec3& x, const Vec3& normal, double size, double exponent = 0)
      : result_(make(lamp, x, normal.normalized(), size, exponent)),
        walls_(room_.scene(), result_.mesh),
        direct_(walls_) {
    constexpr float kThird = 1.0F / 3;
    for (std::size_t t = 0; t < result_.mesh.flat_count(); ++t)
      if (result_.mesh.triangle(TriangleId(t)).surface.index() == 0)
        point_ = surface_point(walls_.rays(), TriangleId(t), kThird, kThird, true);
  }

  /// Where shadow rays start: RayTracer::kLift off the receiver, which counts where the luminaire is about
  /// to set.
  Vec3 ray_start() const { return walls_.rays().in_room(ray_origin(walls_.rays(), point_)); }

  MeanTest irradiance(std::uint64_t seed, int samples) const {
    MeanTest result;
    for (std::uint64_t replicate = 0; replicate < 48; ++replicate) {
      double sum = 0;
      direct_.add_samples(point_, SobolSequence(seed + replicate), 0, samples, &sum);
      result.add(sum / samples);
    }
    return result;
  }
  /// With so many samples that the standard error is below 0.1 %, as a pilot run with other random numbers
  /// tells.
  MeanTest precise_irradiance() const {
    constexpr double kTarget = 5e-4;
    constexpr int kMost = 1 << 15;
    int samples = 64;
    while (samples < kMost) {
      const MeanTest pilot = irradiance(100'000, samples);
      if (!(pilot.standard_error() > kTarget * pilot.mean())) break;
      samples *= 4;
    }
    return irradiance(700, samples);
  }

 private:
  MeshResult make(const Lamp& lamp, const Vec3& x, const Vec3& n, double size, double exponent) {
    const Vec3 u = n.unitOrthogonal();
    const Vec3 v = n.cross(u);
    room_.triangle(room_.material("receiver", 0),
                   {x + size * u, x + size * (-0.5 * u + v), x + size * (-0.5 * u - v)}, 1);
    const MaterialId m = room_.material("lamp", 0, pi, lamp.both_sides);
    room_.scene().materials[m.index()].emits_both_sides = lamp.both_sides;
    room_.scene().materials[m.index()].emission_exponent = exponent;
    lamp.add(room_, m);
    if (lamp.beside_a_pane) {
      const MaterialId pane = room_.material("pane", 0, 0, true);
      room_.scene().materials[pane.index()].non_diffuse.specular_transmittance = room_.flat(0.5);
      const Vec3 behind = x - 0.1 * size * n;
      room_.triangle(pane, {behind, behind + 0.1 * size * u, behind + 0.1 * size * v}, 1);
    }
    return build_mesh(room_.scene());
  }

  RoomBuilder room_;
  MeshResult result_;
  Room walls_;
  DirectLight direct_;
  SurfacePoint point_;
};

/// Four standard errors of 48 estimates: a right program fails with odds of 1 in 4500 per point. `rounding`:
/// relative, what positions in single precision may do.
void expect_agreement(const std::string& what, const MeanTest& e, double truth, double rounding) {
  EXPECT_LT(e.standard_error(), 1e-3 * truth) << what;
  EXPECT_LE(std::fabs(e.mean() - truth), 4 * e.standard_error() + rounding * truth)
      << what << ": " << e.mean() << " +- " << e.standard_error() << ", truth " << truth << ", off by "
      << e.mean() / truth - 1;
}

/// n turned by an angle about an axis across it.
Vec3 turned(const Vec3& n, double angle) {
  return Eigen::AngleAxisd(angle, Vec3(0.3, -0.2, 0.5).cross(n).normalized()) * n;
}

void expect_lit_as_stated(const Lamp& lamp, double distance, double rounding) {
  const Vec3 x = lamp.near_point + distance * lamp.away;
  // 0: facing. 1: tilted. pi/2: the horizon cuts the luminaire.
  for (const double angle : {0.0, 1.0, 0.5 * pi}) {
    const Vec3 n = turned(-lamp.away, angle);
    const LitReceiver lit(lamp, x, n, 0.1 * distance);
    const double truth = lamp.irradiance(lit.ray_start(), n);
    ASSERT_GT(truth, 0);
    expect_agreement(lamp.name + " at " + std::to_string(distance) + ", turned by " + std::to_string(angle),
                     lit.precise_irradiance(), truth, rounding);
  }
}

TEST(DirectLightShapes, ContoursGiveTheClosedForms) {
  const Vec3 up = Vec3::UnitZ();
  // Disk on its axis: pi r^2/(r^2+h^2); a sphere above the horizon: pi (r/d)^2 cos; a rectangle from above a
  // corner.
  EXPECT_NEAR(test::contour_irradiance(test::circle({0, 0, 2}, up, 1), Vec3::Zero(), up), pi / 5, 1e-8);
  EXPECT_NEAR(
      test::contour_irradiance(test::outline_of_sphere({1, 0, 2}, 0.5, Vec3::Zero()), Vec3::Zero(), up),
      pi * 0.25 / 5 * 2 / std::sqrt(5), 1e-8);
  const Contour square{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  EXPECT_NEAR(test::contour_irradiance(square, Vec3::Zero(), up), std::sqrt(0.5) * std::atan(std::sqrt(0.5)),
              1e-12);
  // An endless cylinder beside a point: pi r/d.
  EXPECT_NEAR(test::contour_irradiance(
                  test::outline_of_cylinder({0, -1e4, 2}, {0, 1e4, 2}, 0.5, Vec3::Zero()), Vec3::Zero(), up),
              pi * 0.25, 1e-6);
  // Half above the horizon counts half as much if the other half is its mirror image.
  const Contour wall = test::circle({0, 0, 0}, Vec3::UnitX(), 1);
  const Vec3 beside(-1, 0, 0);
  const double half = test::contour_irradiance(wall, beside, up);
  EXPECT_NEAR(half, test::contour_irradiance(wall, beside, -up), 1e-12);
}

TEST(DirectLightShapes, AtMiddleDistances) {
  for (const Lamp& lamp : all_lamps()) expect_lit_as_stated(lamp, 0.8, 2e-5);
}

TEST(DirectLightShapes, AtAThousandthOfTheirSize) {
  // Rings are drawn from evenly over their area: a tenth of their size is as close as that is precise.
  for (const Lamp& lamp : all_lamps()) expect_lit_as_stated(lamp, lamp.name == "ring" ? 0.1 : 1e-3, 1e-4);
}

TEST(DirectLightShapes, AtAThousandTimesTheirSize) {
  for (const Lamp& lamp : all_lamps()) expect_lit_as_stated(lamp, 1e3, 2e-4);
}

TEST(DirectLightShapes, BesideAPaneTheyAreSeenAsWithout) {
  for (Lamp lamp : all_lamps()) {
    lamp.beside_a_pane = true;
    expect_lit_as_stated(lamp, 0.8, 2e-5);
    expect_lit_as_stated(lamp, 1e3, 2e-4);
  }
  Lamp lamp = sphere_lamp();
  lamp.both_sides = lamp.beside_a_pane = true;
  for (const Vec3& n : {Vec3(0, 0, 1), Vec3(0.6, 0, 0.8)})
    expect_agreement("sphere from inside",
                     LitReceiver(lamp, Vec3(0.1, 0.2, 0.3), n, 1e-2).precise_irradiance(), pi, 2e-5);
}

TEST(DirectLightShapes, AlmostInThePlaneOfFlatOnes) {
  for (Lamp lamp : {rectangle_lamp(), triangle_lamp(), notched_lamp(), disk_lamp(), ring_lamp()}) {
    for (const double height : {1e-2, 1e-3}) {
      lamp.near_point = Vec3(1, 0.3, height);
      lamp.away = Vec3(1, 0.3, 0).normalized();
      expect_lit_as_stated(lamp, 0.2, 3e-7 / height + 2e-5);
    }
  }
}

TEST(DirectLightShapes, SpheresAndCylindersMostlyBelowTheHorizon) {
  for (const Lamp& lamp : {sphere_lamp(), cylinder_lamp()})
    for (const double slope : {0.05, 0.12}) {
      // The horizon passes 0.3 or 0.44 above the middle of the sphere, whose radius is 0.5.
      const Vec3 x(2, 0, 0.2);
      const Vec3 n = Vec3(slope, 0.1, 1).normalized();
      const LitReceiver lit(lamp, x, n, 0.1);
      const double truth = lamp.irradiance(lit.ray_start(), n);
      ASSERT_GT(truth, 0);
      expect_agreement(lamp.name + " under a slope of " + std::to_string(slope), lit.precise_irradiance(),
                       truth, 1e-4);
    }
}

TEST(DirectLightShapes, InsideAnInwardSphereItIsPiEverywhere) {
  const Lamp lamp = shape_lamp(
      "inward sphere", Sphere{{0.2, 0.1, 0}, 1, true}, [](const Vec3&, const Vec3&) { return pi; },
      Vec3::Zero(), Vec3::UnitZ());
  for (const Vec3& x : {Vec3(0.2, 0.1, 0), Vec3(0.5, -0.3, 0.4), Vec3(0.2, 0.1, 0.99)})
    for (const Vec3& n : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(0.6, 0.8, 0)}) {
      const LitReceiver lit(lamp, x, n, 1e-3);
      expect_agreement("inward sphere", lit.precise_irradiance(), pi, 1e-5);
    }
}

TEST(DirectLightShapes, InsideAnInwardCylinder) {
  // The hemisphere less what is seen through the ends.
  const Vec3 base(0, 0, -1);
  const Vec3 top(0, 0, 1);
  constexpr double kRadius = 0.6;
  const Lamp lamp = shape_lamp(
      "inward cylinder", Cylinder{base, top, kRadius, true},
      [&](const Vec3& x, const Vec3& n) {
        return pi - test::contour_irradiance(test::circle(base, Vec3::UnitZ(), kRadius), x, n) -
               test::contour_irradiance(test::circle(top, Vec3::UnitZ(), kRadius), x, n);
      },
      Vec3::Zero(), Vec3::UnitZ());
  for (const Vec3& x : {Vec3(0, 0, 0), Vec3(0.4, -0.2, 0.5), Vec3(0.5, 0.2, -0.95)})
    for (const Vec3& n : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(-0.48, 0.64, 0.6)}) {
      const LitReceiver lit(lamp, x, n, 1e-3);
      const double truth = lamp.irradiance(lit.ray_start(), n);
      expect_agreement("inside a cylinder", lit.precise_irradiance(), truth, 1e-4);
    }
}

TEST(DirectLightShapes, OpenEndOfAnInwardCylinder) {
  // On the axis in front of one end: what that disk would give less what the other one hides nothing of.
  const Lamp lamp = shape_lamp(
      "open end", Cylinder{{0, 0, -1}, {0, 0, 0}, 0.5, true},
      [](const Vec3& x, const Vec3& n) {
        return test::contour_irradiance(test::circle({0, 0, 0}, Vec3::UnitZ(), 0.5), x, n) -
               test::contour_irradiance(test::circle({0, 0, -1}, Vec3::UnitZ(), 0.5), x, n);
      },
      Vec3::Zero(), Vec3::UnitZ());
  for (const double height : {0.1, 1.0}) {
    const Vec3 n = Vec3(0.2, 0.1, -1).normalized();
    const LitReceiver lit(lamp, Vec3(0, 0, height), n, 1e-3);
    expect_agreement("open end", lit.precise_irradiance(), lamp.irradiance(lit.ray_start(), n), 1e-4);
  }
}

TEST(DirectLightShapes, BacksShineIfBothSidesEmitAndElseNot) {
  for (Lamp lamp : {rectangle_lamp(), triangle_lamp(), notched_lamp(), disk_lamp(), ring_lamp()}) {
    const Vec3 x(0.2, 0.3, -0.7);
    const Vec3 n = Vec3(0.1, 0.4, 1).normalized();
    EXPECT_EQ(LitReceiver(lamp, x, n, 1e-2).irradiance(5, 64).mean(), 0) << lamp.name;
    lamp.both_sides = true;
    const LitReceiver lit(lamp, x, n, 1e-2);
    expect_agreement(lamp.name + " from behind", lit.precise_irradiance(),
                     lamp.irradiance(lit.ray_start(), n), 2e-5);
  }
  Lamp lamp = sphere_lamp();
  const Vec3 x(0.1, 0.2, 0.3);  // inside
  EXPECT_EQ(LitReceiver(lamp, x, Vec3::UnitZ(), 1e-2).irradiance(5, 64).mean(), 0);
  lamp.both_sides = true;
  expect_agreement("sphere from inside", LitReceiver(lamp, x, Vec3::UnitZ(), 1e-2).precise_irradiance(), pi,
                   2e-5);
  lamp = cylinder_lamp();
  lamp.both_sides = true;
  const LitReceiver outside(lamp, {1, 0.2, 0.1}, Vec3(-1, 0, 0.1), 1e-2);
  expect_agreement("cylinder of two sides", outside.precise_irradiance(),
                   lamp.irradiance(outside.ray_start(), Vec3(-1, 0, 0.1).normalized()), 2e-5);
}

TEST(DirectLightShapes, NarrowBeamsFollowTheirPowerOfTheCosine) {
  // A disk of radius r with L = cos^e at the height h over its axis: integral over the disk of
  // cos^(e+2) / d^2 = 2 pi h^(e+2) / (e+2) (h^-(e+2) - (h^2+r^2)^-((e+2)/2)).
  for (const double e : {0.5, 3.0, 40.0})
    for (const double h : {0.3, 2.0}) {
      const LitReceiver lit(disk_lamp(), {0, 0, h}, -Vec3::UnitZ(), 1e-2, e);
      const double truth = 2 * pi / (e + 2) * (1 - std::pow(h / std::hypot(h, 0.5), e + 2));
      expect_agreement("beam of power " + std::to_string(e), lit.precise_irradiance(), truth, 1e-4);
    }
}

}  // namespace
}  // namespace reemit

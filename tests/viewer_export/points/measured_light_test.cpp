#include "viewer_export/points/measured_light.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/model/error.h"
#include "scenes/model/interrupted.h"
#include "solver/progressive_solver.h"
#include "tests/support/hand_made_solution.h"
#include "tests/support/never.h"
#include "tests/support/refusal.h"
#include "tests/support/variable_furnace.h"

namespace reemit {
namespace {

using ::testing::HasSubstr;

using test::kNever;
using test::RoomBuilder;
using test::VariableFurnace;

/// Form factor from a point to a rectangle of a x b in a plane parallel to its own at height h that begins
/// above it (Howell's catalogue, B-4).
double of_corner(double a, double b, double h) {
  const double x = a / h;
  const double y = b / h;
  return (x / std::hypot(1, x) * std::atan(y / std::hypot(1, x)) +
          y / std::hypot(1, y) * std::atan(x / std::hypot(1, y))) /
         (2 * std::numbers::pi);
}

/// The same of the rectangle from (x0,y0) to (x1,y1), seen from the origin.
double of_rectangle(double x0, double x1, double y0, double y1, double h) {
  return of_corner(x1, y1, h) - of_corner(x0, y1, h) - of_corner(x1, y0, h) + of_corner(x0, y0, h);
}

constexpr double kExitance = 5;

/// A black room of 4 x 3 x 2 m with a lamp of 1 x 0.5 m under its ceiling.
RoomBuilder black_room() {
  RoomBuilder room;
  const MaterialId black = room.material("black", 0);
  room.box(Vec3::Zero(), Vec3(4, 3, 2), {black, black, black, black, black, black}, 2);
  room.quad(room.material("lamp", 0, kExitance),
            {Vec3(1, 1, 1.9), Vec3(1, 1.5, 1.9), Vec3(2, 1.5, 1.9), Vec3(2, 1, 1.9)}, 1);
  return room;
}

double lamp_at(const Vec3& place) {
  return kExitance *
         of_rectangle(1 - place.x(), 2 - place.x(), 1 - place.y(), 1.5 - place.y(), 1.9 - place.z());
}

MeasuredLight measure(const RoomBuilder& room, const Solution& solution, PointSet points,
                      const MeasureSettings& settings = {}) {
  const Room walls(room.scene(), solution.mesh);
  return measure_light(walls, solution, {std::move(points)}, settings, {}, kNever);
}

/// Over the room, 1.2 m below the lamp.
PointSet plane_of_black_room() {
  return grid_points("plane", {Vec3(0, 0, 0.7), Vec3(4, 0, 0), Vec3(0, 3, 0), 12, 9}, Vec3(0, 0, 1));
}

/// Rms over points of their difference from the truth, in stated standard errors.
template <class Truth>
double spread(const MeasuredLight& light, double factor, const Truth& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < light.irradiance.size(); ++i) {
    const Irradiance& found = light.irradiance[i];
    sum += std::pow((factor * static_cast<double>(found.all) - truth(light.sets[0].places[i])) /
                        static_cast<double>(found.standard_error),
                    2);
  }
  return std::sqrt(sum / static_cast<double>(light.irradiance.size()));
}

TEST(MeasuredLight, OfALampIsItsFormFactor) {
  const RoomBuilder room = black_room();
  const MeasuredLight light = measure(room, test::dark_solution(room), plane_of_black_room());
  for (std::size_t i = 0; i < light.irradiance.size(); ++i) {
    const double truth = lamp_at(light.sets[0].places[i]);
    // The lamp is sampled by its solid angle, so that what is left of noise is below 1 %.
    EXPECT_NEAR(light.irradiance[i].all, truth, 0.01 * truth) << i;
    EXPECT_EQ(light.irradiance[i].all, light.irradiance[i].direct);
    EXPECT_NEAR(light.illuminance[i].all, 179 * light.irradiance[i].all, 1e-3 * light.illuminance[i].all);
  }
}

TEST(MeasuredLight, FacesOneWay) {
  const RoomBuilder room = black_room();
  PointSet points{"pair", {Vec3(1.5, 1.2, 1), Vec3(1.5, 1.2, 1)}, {Vec3(0, 0, 1), Vec3(0, 0, -1)}};
  const MeasuredLight light = measure(room, test::dark_solution(room), points);
  EXPECT_GT(light.irradiance[0].all, 0);
  EXPECT_EQ(light.irradiance[1].all, 0);
}

TEST(MeasuredLight, PointsOnASurfaceLieBeforeIt) {
  const RoomBuilder room = black_room();
  const PointSet floor =
      grid_points("floor", {Vec3::Zero(), Vec3(4, 0, 0), Vec3(0, 3, 0), 7, 5}, Vec3(0, 0, 1));
  const MeasuredLight light = measure(room, test::dark_solution(room), floor);
  for (std::size_t i = 0; i < floor.size(); ++i)
    EXPECT_NEAR(light.irradiance[i].all, lamp_at(floor.places[i]), 0.01 * lamp_at(floor.places[i])) << i;
}

/// Points all over the furnace, facing all ways.
PointSet all_over_the_furnace() {
  PointSet points{"all over", {}, {}};
  for (int i = 0; i < 200; ++i) {
    points.places.emplace_back(0.05 + 1.9 * std::fmod(0.755 * i, 1), 0.05 + 1.4 * std::fmod(0.569 * i, 1),
                               0.05 + 0.9 * std::fmod(0.382 * i, 1));
    points.normals.push_back(Vec3(std::sin(2.0 * i), std::cos(3.0 * i), std::sin(5.0 * i + 1)).normalized());
  }
  return points;
}

Solution solved_furnace(const VariableFurnace& furnace) {
  SolverSettings settings;
  settings.packets = 400'000;
  return solve_zones(furnace.room().scene(), furnace.room().mesh(), settings, {}, kNever);
}

// Irradiance is the same everywhere, whichever way a point faces. Points share the noise of zones, so that
// the spread of 200 is known to some 15 %: allowed is a third either way. A bias of 2 % must show.
TEST(MeasuredLight, IsThatOfTheFurnaceWithinItsErrors) {
  const VariableFurnace furnace(8);
  const Solution solution = solved_furnace(furnace);
  MeasureSettings settings;
  settings.gather_rays = 1024;
  settings.light_samples = 256;
  const MeasuredLight light = measure(furnace.room(), solution, all_over_the_furnace(), settings);
  const auto truth = [](const Vec3&) { return VariableFurnace::kRadiosity; };
  RecordProperty("spread", std::to_string(spread(light, 1, truth)));
  EXPECT_GT(spread(light, 1, truth), 0.67);
  EXPECT_LT(spread(light, 1, truth), 1.33);
  EXPECT_GT(spread(light, 1.02, truth), 1.33);
  const SetSummary& all = light.summaries.front();
  // 4 standard errors with 15 degrees of freedom: a false alarm once in 800 seeds.
  EXPECT_NEAR(all.mean, 179 * VariableFurnace::kRadiosity, 4 * all.standard_error);
  EXPECT_LT(all.standard_error, 0.005 * all.mean);
  EXPECT_LE(all.least, all.mean);
  EXPECT_GE(all.most, all.mean);
}

TEST(MeasuredLight, ComesToTheErrorAskedFor) {
  const VariableFurnace furnace(4);
  const Solution solution = solved_furnace(furnace);
  MeasureSettings settings;
  settings.error_target = 0.02;
  const MeasuredLight light = measure(furnace.room(), solution, all_over_the_furnace(), settings);
  EXPECT_LT(light.info.error, 0.02);
  EXPECT_GT(light.info.error, 0.005);
  EXPECT_FALSE(light.limited_by_zones);
}

// A bright set does not decide for a dark one: the one that is known worst does.
TEST(MeasuredLight, ComesToTheErrorAskedForInEachSet) {
  RoomBuilder room = black_room();
  const MaterialId black(0);
  room.quad(black, {Vec3(0, 2.2, 0.4), Vec3(4, 2.2, 0.4), Vec3(4, 3, 0.4), Vec3(0, 3, 0.4)}, 1);
  const Solution solution = test::dark_solution(room);
  const Room walls(room.scene(), solution.mesh);
  const PointSet shaded =
      grid_points("shaded", {Vec3(0.5, 2.3, 0.1), Vec3(3, 0, 0), Vec3(0, 0.6, 0), 8, 4}, Vec3(0, 0, 1));
  MeasureSettings settings;
  settings.error_target = 0.02;
  const MeasuredLight light =
      measure_light(walls, solution, {plane_of_black_room(), shaded}, settings, {}, kNever);
  ASSERT_EQ(light.summaries.size(), 2U);
  EXPECT_LT(light.summaries[1].mean, 0.2 * light.summaries[0].mean);
  EXPECT_GT(light.summaries[1].mean, 0);
  EXPECT_LT(light.summaries[1].error, 0.02);
  EXPECT_LT(2 * light.summaries[0].error, light.summaries[1].error);
  EXPECT_EQ(light.info.error, light.summaries[1].error);
}

/// A room of 4 x 3 x 2 m, black, with a spot of this intensity at the middle of its ceiling.
RoomBuilder room_of_spot(double intensity) {
  RoomBuilder room;
  const MaterialId black = room.material("black", 0);
  room.box(Vec3::Zero(), Vec3(4, 3, 2), {black, black, black, black, black, black}, 2);
  room.scene().lights.emplace_back(
      SpotLight{"spot", {2, 1.5, 1.99}, Vec3(0, 0, -1), room.flat(intensity), 1.4, 1.5});
  return room;
}

double spot_at(double intensity, const Vec3& place) {
  const Vec3 to = Vec3(2, 1.5, 1.99) - place;
  return intensity * to.z() / std::pow(to.norm(), 3);
}

// Between a lamp without area and a point all rays are alike, and yet a gauze passes a share of them. The
// spread of 48 points about the truth is known to 10 %; a gauze that has all or nothing pass states no error.
TEST(MeasuredLight, OfASpotThroughAGauzeIsTheShareThatPasses) {
  RoomBuilder room = room_of_spot(10);
  constexpr double kOpacity = 0.6;
  const MaterialId gauze = room.material("gauze", 0, 0, true);
  room.scene().materials[gauze.index()].textures.opacity_factor = kOpacity;
  room.quad(gauze, {Vec3(0, 0, 1.5), Vec3(4, 0, 1.5), Vec3(4, 3, 1.5), Vec3(0, 3, 1.5)}, 1);
  const PointSet plane =
      grid_points("plane", {Vec3(1, 0.5, 0.7), Vec3(2, 0, 0), Vec3(0, 2, 0), 8, 6}, Vec3(0, 0, 1));
  const MeasuredLight light = measure(room, test::dark_solution(room), plane);
  const auto truth = [](const Vec3& place) { return (1 - kOpacity) * spot_at(10, place); };
  for (std::size_t i = 0; i < plane.size(); ++i) {
    EXPECT_NEAR(light.irradiance[i].all, truth(plane.places[i]), 0.25 * truth(plane.places[i])) << i;
    EXPECT_GT(light.irradiance[i].standard_error, 0) << i;
  }
  EXPECT_GT(spread(light, 1, truth), 0.7);
  EXPECT_LT(spread(light, 1, truth), 1.4);
}

TEST(MeasuredLight, OfADimLampBesideBrightOnesBehindAWallIsExact) {
  RoomBuilder room = room_of_spot(1e-3);
  const MaterialId black(0);
  room.quad(black, {Vec3(0, 0, 1.5), Vec3(4, 0, 1.5), Vec3(4, 3, 1.5), Vec3(0, 3, 1.5)}, 1);
  auto& lights = room.scene().lights;
  std::get<SpotLight>(lights[0]).position = Vec3(2, 1.5, 1.49);
  for (int i = 0; i < 40; ++i)
    lights.emplace_back(SpotLight{"bright", {0.1 * i, 1, 1.9}, Vec3(0, 0, -1), room.flat(1e4), 1.4, 1.5});
  MeasureSettings settings;
  settings.error_target = 0.01;
  const MeasuredLight light = measure(room, test::dark_solution(room), plane_of_black_room(), settings);
  for (std::size_t i = 0; i < light.irradiance.size(); ++i) {
    const Vec3 from_lamp = light.sets[0].places[i] + Vec3(0, 0, 0.5);
    EXPECT_NEAR(light.irradiance[i].all, spot_at(1e-3, from_lamp), 1e-4 * spot_at(1e-3, from_lamp)) << i;
  }
}

TEST(MeasuredLight, WhereNoRayFindsAnyIsNotKnownToBeNone) {
  RoomBuilder room = black_room();
  const MaterialId black(0);
  room.box(Vec3(1, 1, 0.2), Vec3(2, 2, 0.8), {black, black, black, black, black, black}, 1);
  const PointSet inside{"inside", {Vec3(1.5, 1.5, 0.5)}, {Vec3(0, 0, 1)}};
  MeasureSettings settings;
  settings.error_target = 0.01;
  const MeasuredLight light = measure(room, test::dark_solution(room), inside, settings);
  EXPECT_EQ(light.irradiance[0].all, 0);
  EXPECT_EQ(light.summaries[0].dark_points, std::vector<std::size_t>{0});
  EXPECT_TRUE(std::isinf(light.summaries[0].error));
  EXPECT_TRUE(std::isinf(light.info.error));
}

/// A black room with a mirror on the ceiling that a spot shines at: its image shines down. 5 stated standard
/// errors at each of 16 points and 0.5 % for the radius of photons, odds of a false alarm below 1 in 400.
TEST(MeasuredLight, HasTheLightOfASpotOverAMirror) {
  RoomBuilder room;
  const MaterialId black = room.material("black", 0);
  const MaterialId mirror = room.material("mirror", 0);
  room.scene().materials[mirror.index()].non_diffuse.specular_reflectance = room.flat(0.9);
  room.box(Vec3::Zero(), Vec3(2, 2, 2), {black, black, black, black, black, mirror}, 2);
  constexpr double kIntensity = 10;
  room.scene().lights.emplace_back(
      SpotLight{"spot", {1, 1, 1}, Vec3(0, 0, 1), room.flat(kIntensity), 0.2, 0.3});
  SolverSettings settings;
  settings.packets = 200'000;
  const Solution solution = solve_zones(room.scene(), room.mesh(), settings, {}, kNever);
  const PointSet plane =
      grid_points("plane", {Vec3(0.8, 0.8, 0.5), Vec3(0.4, 0, 0), Vec3(0, 0.4, 0), 4, 4}, Vec3(0, 0, 1));
  const MeasuredLight light = measure(room, solution, plane);
  double mean = 0;
  for (std::size_t i = 0; i < plane.size(); ++i) {
    const Vec3 to = Vec3(1, 1, 3) - plane.places[i];
    const double truth = 0.9 * kIntensity * to.z() / std::pow(to.norm(), 3);
    mean += truth / static_cast<double>(plane.size());
    const auto error = static_cast<double>(light.irradiance[i].standard_error);
    EXPECT_NEAR(static_cast<double>(light.irradiance[i].all), truth, 5 * error + 0.005 * truth) << i;
    EXPECT_LT(error, 0.1 * truth);
    EXPECT_EQ(light.irradiance[i].direct, 0);
  }
  const SetSummary& set = light.summaries[0];
  const double efficacy = room.scene().bands.efficacy_lm_per_w()[0];
  EXPECT_NEAR(set.mean, efficacy * mean, 5 * set.standard_error + 0.005 * set.mean);
  EXPECT_LT(set.standard_error, 0.02 * set.mean);
}

TEST(MeasuredLight, SameBitsOnAnyNumberOfThreads) {
  const VariableFurnace furnace(4);
  const Solution solution = solved_furnace(furnace);
  MeasureSettings settings;
  settings.gather_rays = 64;
  settings.light_samples = 32;
  settings.threads = 1;
  const MeasuredLight one = measure(furnace.room(), solution, all_over_the_furnace(), settings);
  settings.threads = 2;
  const MeasuredLight two = measure(furnace.room(), solution, all_over_the_furnace(), settings);
  for (std::size_t i = 0; i < one.irradiance.size(); ++i) {
    EXPECT_EQ(one.irradiance[i].all, two.irradiance[i].all);
    EXPECT_EQ(one.irradiance[i].standard_error, two.irradiance[i].standard_error);
  }
}

TEST(MeasuredLight, EndsWhenInterruptedAndRefusesNothingToDo) {
  const RoomBuilder room = black_room();
  const Solution solution = test::dark_solution(room);
  const Room walls(room.scene(), solution.mesh);
  const std::atomic<bool> now = true;
  EXPECT_THROW(measure_light(walls, solution, {plane_of_black_room()}, {}, {}, now), Interrupted);
  EXPECT_THROW(measure_light(walls, solution, {}, {}, {}, kNever), InputError);
}

TEST(MeasuredLight, RefusesPointsThatAreNone) {
  const RoomBuilder room = black_room();
  const Solution solution = test::dark_solution(room);
  const Room walls(room.scene(), solution.mesh);
  const auto refusal = [&](const PointSet& points) {
    return test::refusal_of([&] {
      measure_light(walls, solution, {plane_of_black_room(), points}, {}, {}, kNever);
    });
  };
  const Vec3 up = Vec3::UnitZ();
  EXPECT_THAT(refusal({"a", {}, {}}), HasSubstr("a: no points"));
  EXPECT_THAT(refusal({"b", {Vec3(1, 1, 1), Vec3(2, 1, 1)}, {up}}), HasSubstr("2 points and 1 normals"));
  EXPECT_THAT(refusal({"c", {Vec3(1, 1, std::nan(""))}, {up}}), HasSubstr("c: point 1"));
  EXPECT_THAT(refusal({"d", {Vec3(1, 1, 1), Vec3(1, 1e30, 1)}, {up, up}}), HasSubstr("d: point 2"));
  for (const Vec3& normal : {Vec3(0, 0, 3), Vec3(0, 0, 0)})
    EXPECT_THAT(refusal({"e", {Vec3(1, 1, 1)}, {normal}}), HasSubstr("not of length 1"));
}

}  // namespace
}  // namespace reemit

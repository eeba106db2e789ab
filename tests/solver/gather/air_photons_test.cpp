// Light over a mirror at points in the air, against the image of the lamp behind the mirror.

#include "solver/gather/air_photons.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "solver/gather/caustic_map.h"
#include "solver/room/room.h"
#include "tests/support/mean_test.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using test::MeanTest;
using test::RoomBuilder;

constexpr double kIntensity = 7, kReflectance = 0.8;
const Vec3 kLamp(1, 0, 2), kImage(-1, 0, 2);
constexpr double kBarrierAt = 2;

/// A black floor, a lamp without area above it before a mirror at x = 0, and if asked for a thin black screen
/// upright on the floor.
RoomBuilder mirror_room(bool screen = false) {
  RoomBuilder room;
  const MaterialId black = room.material("black", 0, 0, true);
  room.quad(black, {Vec3(0, -2, 0), Vec3(4, -2, 0), Vec3(4, 2, 0), Vec3(0, 2, 0)}, 4);
  if (screen)
    room.quad(
        black,
        {Vec3(kBarrierAt, -2, 0), Vec3(kBarrierAt, 2, 0), Vec3(kBarrierAt, 2, 1), Vec3(kBarrierAt, -2, 1)},
        1);
  const MaterialId silver = room.material("mirror", 0);
  room.scene().materials[silver.index()].non_diffuse.specular_reflectance = room.flat(kReflectance);
  room.quad(silver, {Vec3(0, -3, 0), Vec3(0, 3, 0), Vec3(0, 3, 4), Vec3(0, -3, 4)}, 1);
  room.scene().lights.emplace_back(PointLight{"lamp", kLamp, room.flat(kIntensity)});
  return room;
}

double of_image(const Vec3& at, const Vec3& normal) {
  const Vec3 to = kImage - at;
  return kReflectance * kIntensity * std::max(0.0, normal.dot(to)) / std::pow(to.norm(), 3);
}

struct FacingPoint {
  Vec3 at, normal;
};

class AirPhotonsOfMirror {
 public:
  explicit AirPhotonsOfMirror(std::vector<FacingPoint> points, bool screen = false)
      : builder_(mirror_room(screen)), points_(std::move(points)) {
    for (std::uint32_t i = 0; i < points_.size(); ++i)
      measuring_.push_back(measuring_point(room_.rays(), points_[i].at, points_[i].normal, i));
    for (const std::uint64_t seed : {1, 2})
      sets_.emplace_back(room_, kParts, seed, nullptr, nullptr, PointsInAir{measuring_, 2});
  }

  /// Mean over points first .. first + count - 1 of what photons bring, over that of the image; an estimate
  /// for each part of each set of photons.
  MeanTest over_truth(std::size_t first, std::size_t count) const {
    double truth = 0;
    for (std::size_t i = first; i < first + count; ++i) truth += of_image(points_[i].at, points_[i].normal);
    MeanTest mean;
    for (const CausticMap& photons : sets_)
      for (std::size_t part = 0; part < kParts; ++part) {
        float sum = 0;
        const float weight = 1;
        for (std::size_t i = first; i < first + count; ++i)
          photons.add_irradiance(measuring_[i], part, &weight, &sum);
        mean.add(static_cast<double>(sum) / truth);
      }
    return mean;
  }

 private:
  static constexpr std::size_t kParts = 16;

  RoomBuilder builder_;
  ZoneMesh mesh_ = builder_.mesh().mesh;
  Room room_{builder_.scene(), mesh_};
  std::vector<FacingPoint> points_;
  std::vector<MeasuringPoint> measuring_;
  std::vector<CausticMap> sets_;
};

std::vector<FacingPoint> grid(const Vec3& corner, const Vec3& along, const Vec3& across, const Vec3& normal) {
  constexpr int kSide = 12;
  std::vector<FacingPoint> points;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j)
      points.push_back(
          {corner + (i + 0.5) / kSide * along + (j + 0.5) / kSide * across, normal.normalized()});
  return points;
}

/// Five grids, and points that face anywhere, each with a plane of its own. Of 32 estimates: 5 standard
/// errors, odds of a false alarm below 1 in 6,000.
TEST(AirPhotons, bring_what_the_image_of_the_lamp_does) {
  std::vector<FacingPoint> points;
  for (const std::vector<FacingPoint>& more :
       {grid({.5, -1, .8}, {2, 0, 0}, {0, 2, 0}, {0, 0, 1}),      // facing upwards
        grid({.6, -1, 1.2}, {0, 2, 0}, {0, 0, 1.5}, {-1, 0, 0}),  // the mirror
        grid({.7, -1, 1}, {1, 0, .5}, {0, 2, 0}, {-.5, 0, 1}),    // and between, on a plane that leans
        grid({.5, -1.5, 0}, {3, 0, 0}, {0, 3, 0}, {0, 0, 1}),     // on the floor itself
        grid({.2, -1, 2.5}, {2, 0, 0}, {0, 2, 0}, {0, 0, -1})})   // where light comes from below alone
    points.insert(points.end(), more.begin(), more.end());
  const std::size_t of_grid = points.size() / 5;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  while (points.size() < 7 * of_grid) {
    const FacingPoint point{Vec3(1.5 + unit(random), unit(random), 1.2 + 0.8 * unit(random)),
                            Vec3(unit(random), unit(random), unit(random)).normalized()};
    // Where light grazes, a photon that meets the plane at all counts for much.
    if (point.normal.dot((kImage - point.at).normalized()) > 0.2) points.push_back(point);
  }
  const AirPhotonsOfMirror photons(points);
  const auto check = [&](std::size_t first, std::size_t count, double bias) {
    const MeanTest mean = photons.over_truth(first, count);
    EXPECT_TRUE(mean.agrees_with(1)) << points[first].at.transpose();
    EXPECT_TRUE(mean.would_notice(bias, 1))
        << points[first].at.transpose() << " +- " << mean.standard_error();
  };
  for (std::size_t g = 0; g < 5; ++g) check(g * of_grid, of_grid, 0.03);
  check(5 * of_grid, 2 * of_grid, 0.03);
  check(0, points.size(), 0.02);
}

/// Points before and behind a screen, nearer than a photon's radius: none is lost at it, and none comes
/// through. Without the slope in the gain, 1.04.
TEST(AirPhotons, end_at_walls) {
  constexpr std::size_t kEach = 100;
  std::vector<FacingPoint> points;
  for (const double side : {-0.03, 0.03})
    for (std::size_t i = 0; i < kEach; ++i)
      points.push_back(
          {Vec3(kBarrierAt + side, -1.8 + 3.6 * static_cast<double>(i) / (kEach - 1), 0.4), Vec3::UnitZ()});
  const AirPhotonsOfMirror photons(points, true);
  const MeanTest mean = photons.over_truth(0, kEach);
  EXPECT_TRUE(mean.agrees_with(1));
  EXPECT_TRUE(mean.would_notice(0.06, 1)) << mean.standard_error();
  EXPECT_EQ(photons.over_truth(kEach, kEach).mean(), 0);
}

TEST(AirPhotons, bring_nothing_to_points_that_look_away_or_were_not_named) {
  const RoomBuilder builder = mirror_room();
  const ZoneMesh mesh = builder.mesh().mesh;
  const Room room(builder.scene(), mesh);
  const std::vector<MeasuringPoint> points{measuring_point(room.rays(), {1, 0, 1}, {1, 0, 0}, 0),
                                           measuring_point(room.rays(), {1, 0, 1}, {-1, 0, 0}, 1)};
  const CausticMap photons(room, 1, 1, nullptr, nullptr, PointsInAir{points});
  const auto at = [&](const MeasuringPoint& x) {
    const float weight = 1;
    float sum = 0;
    photons.add_irradiance(x, 0, &weight, &sum);
    return sum;
  };
  EXPECT_EQ(at(points[0]), 0);
  EXPECT_GT(at(points[1]), 0);
  EXPECT_EQ(at(measuring_point(room.rays(), {1, 0, 1}, {-1, 0, 0})), 0);
}

}  // namespace
}  // namespace reemit

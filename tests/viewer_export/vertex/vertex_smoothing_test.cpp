// Smoothed vertices against long gathers of the same solution.
#include "viewer_export/vertex/vertex_smoothing.h"

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "tests/support/mean_test.h"
#include "tests/support/never.h"
#include "tests/support/test_rooms.h"
#include "viewer_export/vertex/vertex_radiance.h"

namespace reemit {
namespace {

using test::kNever;
using test::MeanTest;
using test::RoomBuilder;

/// A floor under a lamp, one half of it in the shadow of a board, and a wall beside it.
RoomBuilder shaded_floor() {
  RoomBuilder room;
  const MaterialId grey = room.material("floor", 0.5);
  const MaterialId white = room.material("wall", 0.8);
  const MaterialId lamp = room.material("lamp", 0, 10);
  const MaterialId board = room.material("board", 0, 0, true);
  room.quad(grey, {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 2, 0), Vec3(0, 2, 0)}, 24);
  room.quad(white, {Vec3(0, 0, 0), Vec3(0, 2, 0), Vec3(0, 2, 1.5), Vec3(0, 0, 1.5)}, 12);
  room.quad(lamp, {Vec3(.9, .9, 2), Vec3(.9, 1.1, 2), Vec3(1.1, 1.1, 2), Vec3(1.1, .9, 2)}, 1);
  room.quad(board, {Vec3(1, -1, 1), Vec3(3, -1, 1), Vec3(3, 3, 1), Vec3(1, 3, 1)}, 1);
  return room;
}

Solution solved(const RoomBuilder& room) {
  SolverSettings settings;
  settings.packets = 1U << 18;
  return solve(room.scene(), room.mesh(), settings, {}, kNever);
}

VertexData vertices_of(const RoomBuilder& room, const Solution& solution, const VertexSettings& settings) {
  return gather_vertices(Room(room.scene(), solution.mesh), solution, settings, {}, kNever);
}

/// Few rays, which leave several per cent of noise.
VertexSettings few_rays(bool smooth, std::uint64_t seed = 1) {
  VertexSettings settings;
  settings.gather_rays = 64;
  settings.light_samples = 32;
  settings.smooth = smooth;
  settings.seed = seed;
  return settings;
}

VertexSettings many_rays() {
  VertexSettings settings;
  settings.gather_rays = 4096;
  settings.light_samples = 2048;
  settings.seed = 77;
  return settings;
}

/// Radiance that other surfaces sent.
std::vector<double> indirect(const VertexData& data) {
  std::vector<double> values;
  for (std::size_t k = 0; k < data.radiance.size(); ++k)
    values.push_back(static_cast<double>(data.radiance[k]) - static_cast<double>(data.direct_radiance[k]));
  return values;
}

template <class Values>
double rms_difference(const Values& a, const Values& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    sum += std::pow(static_cast<double>(a[k]) - static_cast<double>(b[k]), 2);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(VertexSmoothing, LeavesLessThanHalfOfTheNoiseOfIndirectLightAndSaysSo) {
  const RoomBuilder room = shaded_floor();
  const Solution solution = solved(room);
  const VertexData truth = vertices_of(room, solution, many_rays());
  const VertexData before = vertices_of(room, solution, few_rays(false));
  const VertexData after = vertices_of(room, solution, few_rays(true));
  ASSERT_FALSE(before.smoothed);
  ASSERT_TRUE(after.smoothed);
  ASSERT_EQ(truth.vertex_count(), after.vertex_count());
  const double noise = rms_difference(indirect(before), indirect(truth));
  const double left = rms_difference(indirect(after), indirect(truth));
  RecordProperty("left", std::to_string(left / noise));
  EXPECT_LT(left, 0.5 * noise);
  // The half-shadow of the board is three vertices wide.
  EXPECT_LT(rms_difference(after.direct_radiance, truth.direct_radiance),
            1.15 * rms_difference(before.direct_radiance, truth.direct_radiance));
  const double error = rms_difference(after.radiance, truth.radiance);
  const double stated =
      rms_difference(after.radiance_stderr, std::vector<float>(after.radiance_stderr.size(), 0.0F));
  EXPECT_GT(stated, 0.7 * error);
  EXPECT_LT(stated, 2 * error);
}

// A closed room with a ten-thousandth of the light of the one beside it has errors of its own.
TEST(VertexSmoothing, ErrorsOfADarkRoomAreNotThoseOfABrightOne) {
  RoomBuilder room;
  const MaterialId grey = room.material("wall", 0.5);
  for (const double exitance : {1e4, 1.0}) {
    const double x = exitance > 1 ? 0 : 2;
    const MaterialId lamp = room.material("lamp", 0, exitance);
    room.box({x, 0, 0}, {x + 1, 1, 1}, {grey, grey, grey, grey, grey, grey}, 8);
    room.quad(lamp, {Vec3(x + .4, .4, .9), Vec3(x + .4, .6, .9), Vec3(x + .6, .6, .9), Vec3(x + .6, .4, .9)},
              1);
  }
  SolverSettings settings;
  settings.packets = 1U << 18;
  settings.method = SolveMethod::kWalk;
  const Solution solution = solve(room.scene(), room.mesh(), settings, {}, kNever);
  const VertexData data = vertices_of(room, solution, few_rays(true));
  double light[2] = {0, 0};
  double error[2] = {0, 0};
  for (std::size_t v = 0; v < data.vertex_count(); ++v) {
    const bool is_dark = data.positions[v].x() > 1.5;
    light[is_dark ? 1 : 0] += std::pow(static_cast<double>(data.radiance[v]), 2);
    error[is_dark ? 1 : 0] += std::pow(static_cast<double>(data.radiance_stderr[v]), 2);
  }
  EXPECT_LT(light[1], 1e-7 * light[0]);
  // Few packets have come to the dark room, so its zones are noisier, but known.
  EXPECT_LT(std::sqrt(error[0] / light[0]), 0.3);
  EXPECT_LT(std::sqrt(error[1] / light[1]), 1);
}

TEST(VertexSmoothing, KeepsTheMean) {
  const RoomBuilder room = shaded_floor();
  const Solution solution = solved(room);
  const VertexData truth = vertices_of(room, solution, many_rays());
  double of_truth = 0;
  for (const float l : truth.radiance) of_truth += static_cast<double>(l);
  MeanTest mean;
  for (std::uint64_t seed = 1; seed <= 32; ++seed) {
    const VertexData data = vertices_of(room, solution, few_rays(true, seed));
    double sum = 0;
    for (const float l : data.radiance) sum += static_cast<double>(l);
    mean.add(sum / of_truth);
  }
  EXPECT_TRUE(mean.agrees_with(1));
  EXPECT_TRUE(mean.would_notice(0.02, 1)) << mean.standard_error();
}

TEST(VertexSmoothing, KeepsAShadow) {
  // Under the far end of the board there is no direct light, and a vertex that no shadow ray finds a lamp
  // from stays without it.
  const RoomBuilder room = shaded_floor();
  const Solution solution = solved(room);
  const VertexData data = vertices_of(room, solution, few_rays(true));
  std::size_t dark = 0;
  for (std::size_t v = 0; v < data.vertex_count(); ++v) {
    if (data.surfaces[v].index() != 0 || data.positions[v].x() < 1.25) continue;
    EXPECT_EQ(data.direct_radiance[v], 0) << data.positions[v].transpose();
    ++dark;
  }
  EXPECT_GT(dark, 100U);
}

TEST(VertexSmoothing, PartsAreNoMoreThanAllAndIrradianceFits) {
  const RoomBuilder room = shaded_floor();
  const Solution solution = solved(room);
  const VertexData data = vertices_of(room, solution, few_rays(true));
  for (std::size_t v = 0; v < data.vertex_count(); ++v) {
    EXPECT_LE(data.direct_radiance[v], data.radiance[v] * 1.0001F);
    const double reflectance = data.surfaces[v].index() == 0 ? 0.5 : 0.8;
    if (data.surfaces[v].index() < 2) {
      EXPECT_NEAR(data.radiance[v], reflectance / std::numbers::pi * static_cast<double>(data.irradiance[v]),
                  1e-5);
    }
  }
}

TEST(VertexSmoothing, SameBitsOnAnyNumberOfThreads) {
  const RoomBuilder room = shaded_floor();
  const Solution solution = solved(room);
  VertexSettings settings = few_rays(true);
  settings.threads = 1;
  const VertexData one = vertices_of(room, solution, settings);
  settings.threads = 2;
  const VertexData two = vertices_of(room, solution, settings);
  EXPECT_EQ(one.radiance, two.radiance);
  EXPECT_EQ(one.radiance_stderr, two.radiance_stderr);
}

TEST(VertexSmoothing, OpalSheetsStayAsTheyWereGathered) {
  RoomBuilder room = shaded_floor();
  const MaterialId opal = room.material("opal", 0.3, 0, true);
  room.scene().materials[opal.index()].non_diffuse.diffuse_transmittance = room.flat(0.4);
  room.quad(opal, {Vec3(.2, .5, .5), Vec3(.8, .5, .5), Vec3(.8, 1.5, .5), Vec3(.2, 1.5, .5)}, 6);
  const Solution solution = solved(room);
  const VertexData before = vertices_of(room, solution, few_rays(false));
  const VertexData after = vertices_of(room, solution, few_rays(true));
  std::size_t seen = 0;
  for (std::size_t v = 0; v < after.vertex_count(); ++v) {
    if (after.surfaces[v].index() != 4) continue;
    EXPECT_EQ(after.radiance[v], before.radiance[v]);
    ++seen;
  }
  EXPECT_GT(seen, 50U);
}

}  // namespace
}  // namespace reemit

#include "solver/gather/hemisphere_gather.h"

#include <array>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "scenes/model/error.h"
#include "solver/gather/path_tracer.h"
#include "solver/room/room.h"
#include "solver/sampling/sobol.h"
#include "tests/support/hand_made_solution.h"
#include "tests/support/mean_test.h"

namespace reemit {
namespace {

using test::MeanTest;
using test::RoomBuilder;

constexpr float kPi = std::numbers::pi_v<float>;

/// A solved room with what gathering needs.
struct Gathering {
  Gathering(const RoomBuilder& room, Solution solved, double close_hit)
      : solution(std::move(solved)),
        walls(room.scene(), solution.mesh),
        field(walls, solution),
        direct(walls),
        gather(field, direct, GatherSettings{.close_hit = close_hit}),
        path(walls, direct, 1) {}

  /// Independent estimates of the indirect irradiance of the first band from `count` rays each.
  MeanTest gathered(const SurfacePoint& x, int count = 256) const {
    MeanTest result;
    GatherBatch batch(gather);
    const std::vector<float> weight(gather.band_count(), 1.0F / static_cast<float>(count));
    for (std::uint32_t replicate = 0; replicate < 48; ++replicate) {
      const SobolSequence sequence(900 + replicate);
      std::vector<float> sum(gather.band_count(), 0.0F);
      for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i)
        batch.add(x, sequence.sample(i, 0), sequence.sample(i, 1), {7, replicate, i}, weight.data(),
                  sum.data());
      batch.flush();
      result.add(static_cast<double>(kPi * sum[0]));
    }
    return result;
  }
  /// The same by path tracing.
  MeanTest traced(const SurfacePoint& x, int count) const {
    MeanTest result;
    std::vector<float> weight(gather.band_count());
    for (std::uint32_t replicate = 0; replicate < 48; ++replicate) {
      const SobolSequence sequence(4900 + replicate);
      std::vector<float> sum(gather.band_count(), 0.0F);
      for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
        weight.assign(weight.size(), 1.0F / static_cast<float>(count));
        path.add_indirect(x, sequence.sample(i, 0), sequence.sample(i, 1), {7, replicate, i}, weight.data(),
                          sum.data());
      }
      result.add(static_cast<double>(kPi * sum[0]));
    }
    return result;
  }

  Solution solution;
  Room walls;
  RadianceField field;
  DirectLight direct;
  HemisphereGather gather;
  PathTracer path;
};

/// Box of 1 x 2 x 3 m in which every wall emits M and reflects rho.
RoomBuilder furnace(double exitance, double reflectance, std::uint32_t divisions) {
  RoomBuilder room;
  const MaterialId m = room.material("wall", reflectance, exitance);
  room.box({0, 0, 0}, {1, 2, 3}, {m, m, m, m, m, m}, divisions);
  return room;
}

TEST(HemisphereGather, furnace_is_exact_when_zones_are_read) {
  // Radiosity is M/(1-rho) everywhere, so M arrives directly and rho M/(1-rho) indirectly: every single ray
  // reads the same.
  const double rho = 0.7;
  const double m = 3;
  const RoomBuilder room = furnace(m, rho, 4);
  const Gathering g(room, test::uniform_solution(room, m, rho * m / (1 - rho)), 0);
  for (std::size_t t = 0; t < g.solution.mesh.triangle_count(); ++t)
    for (const float v : {0.01F, 0.3F, 0.98F}) {
      const MeanTest e = g.gathered(surface_point(g.walls.rays(), TriangleId(t), 0.01F, v, true), 64);
      EXPECT_NEAR(e.mean(), rho * m / (1 - rho), 1e-4);
      EXPECT_LT(e.standard_error(), 1e-5);
    }
}

TEST(HemisphereGather, close_hits_keep_the_mean) {
  // One zone per triangle: every hit is close, and the chain of bounces ends by reading a zone.
  const double rho = 0.7;
  const double m = 3;
  const RoomBuilder room = furnace(m, rho, 1);
  const Gathering g(room, test::uniform_solution(room, m, rho * m / (1 - rho)), 10);
  for (const float u : {0.01F, 0.4F}) {
    const MeanTest e = g.gathered(surface_point(g.walls.rays(), TriangleId(3), u, 0.3F, true), 1024);
    EXPECT_TRUE(e.agrees_with(rho * m / (1 - rho)));
    EXPECT_TRUE(e.would_notice(0.02, rho * m / (1 - rho)));
    EXPECT_FALSE(e.agrees_with(1.02 * rho * m / (1 - rho))) << "a bias of 2 % must not pass";
  }
}

TEST(HemisphereGather, close_hits_do_not_read_their_own_zone) {
  // The zones hold nonsense; a gather that continues all hits to the last bounce reads it only there, with
  // weight rho^(bounces+1), so what it finds is nearly the truth.
  const double rho = 0.1;
  const double m = 3;
  const RoomBuilder room = furnace(m, rho, 1);
  const Gathering g(room, test::uniform_solution(room, 0, 0), 10);
  const MeanTest e = g.gathered(surface_point(g.walls.rays(), TriangleId(3), 0.2F, 0.3F, true), 1024);
  // rho M (1 + rho + rho^2 + rho^3): direct light after one to four bounces.
  EXPECT_TRUE(e.agrees_with(rho * m * (1 + rho + rho * rho + rho * rho * rho)));
}

TEST(HemisphereGather, luminaires_add_nothing_but_their_reflection) {
  const RoomBuilder room = furnace(5, 0.5, 2);
  const Gathering g(room, test::uniform_solution(room, 0, 0), 0);
  EXPECT_EQ(g.gathered(surface_point(g.walls.rays(), TriangleId(0), 0.3F, 0.3F, true)).mean(), 0);
}

TEST(HemisphereGather, backs_of_one_sided_faces_absorb) {
  RoomBuilder room;
  const MaterialId floor = room.material("floor", 0.5);
  const MaterialId lid = room.material("lid", 0.5);
  room.triangle(floor, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, 1);
  room.quad(lid, {Vec3(-9, -9, 1), Vec3(9, -9, 1), Vec3(9, 9, 1), Vec3(-9, 9, 1)}, 1);  // faces up
  const Gathering g(room, test::uniform_solution(room, 1, 1), 0);
  EXPECT_EQ(g.gathered(surface_point(g.walls.rays(), TriangleId(0), 0.3F, 0.3F, true)).mean(), 0);
}

TEST(HemisphereGather, sequence_of_queued_points_keeps_sums_apart) {
  RoomBuilder room(BandSet::rgb());
  const MaterialId lit = room.material("lit", Eigen::Array3d(0.2, 0.4, 0.8), Eigen::Array3d(0, 0, 0));
  const MaterialId dark = room.material("dark", 0.0);
  room.box({0, 0, 0}, {1, 1, 1}, {lit, lit, lit, lit, lit, lit}, 1);
  room.box({5, 0, 0}, {6, 1, 1}, {dark, dark, dark, dark, dark, dark}, 1);
  const Gathering g(room, test::uniform_solution(room, 1, 1), 0);
  GatherBatch batch(g.gather);
  const std::array<float, 3> weight{1, 1, 0.5F};
  std::array<std::array<float, 3>, 2> sums{};
  const SobolSequence sequence(1);
  for (std::uint32_t i = 0; i < 37; ++i) {
    const std::size_t which = i % 2;
    batch.add(surface_point(g.walls.rays(), TriangleId(12 * which), 0.3F, 0.3F, true), sequence.sample(i, 0),
              sequence.sample(i, 1), {0, 0, i}, weight.data(), sums[which].data());
  }
  batch.flush();
  EXPECT_NEAR(sums[0][0], 19 * 0.2F * 2 / kPi, 1e-4);
  EXPECT_NEAR(sums[0][1], 19 * 0.4F * 2 / kPi, 1e-4);
  EXPECT_NEAR(sums[0][2], 0.5 * 19 * 0.8F * 2 / kPi, 1e-4);
  EXPECT_EQ(sums[1], (std::array<float, 3>{0, 0, 0}));
}

TEST(PathTracer, furnace) {
  for (const double rho : {0.3, 0.9}) {
    const double m = 2;
    const RoomBuilder room = furnace(m, rho, 1);
    const Gathering g(room, test::dark_solution(room), 0);
    const MeanTest e = g.traced(surface_point(g.walls.rays(), TriangleId(5), 0.3F, 0.1F, true), 2048);
    EXPECT_TRUE(e.agrees_with(rho * m / (1 - rho)));
    EXPECT_TRUE(e.would_notice(0.04, rho * m / (1 - rho))) << e.standard_error();
  }
}

TEST(RadianceField, refuses_another_room) {
  const RoomBuilder room = furnace(1, 0.5, 1);
  Solution solution = test::dark_solution(room);
  solution.surface_names.pop_back();
  const Room walls(room.scene(), solution.mesh);
  EXPECT_THROW(RadianceField(walls, solution), InputError);
  solution = test::dark_solution(room);
  solution.sums.direct.pop_back();
  EXPECT_THROW(RadianceField(walls, solution), InputError);
}

}  // namespace
}  // namespace reemit

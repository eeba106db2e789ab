#include "solver/gather/luminaire_packets.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "solver/gather/direct_audit.h"
#include "solver/progressive_solver.h"
#include "tests/support/never.h"
#include "tests/support/shelf_room.h"
#include "tests/support/skies.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using test::kNever;
using test::RoomBuilder;

/// A box with a window under an overcast sky. Packets of light that never comes in are few and heavy.
RoomBuilder sky_room() {
  RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5, 0, true);
  room.box({0, 0, 0}, {4, 4, 3}, {wall, wall, {}, wall, wall, wall}, 6);
  const auto piece = [&](double x0, double x1, double z0, double z1) {
    room.quad(wall, {Vec3(x0, 0, z0), Vec3(x0, 0, z1), Vec3(x1, 0, z1), Vec3(x1, 0, z0)}, 4);
  };
  piece(0, 4, 0, 1);
  piece(0, 4, 1.6, 3);
  piece(0, 1.5, 1, 1.6);
  piece(2.5, 4, 1, 1.6);
  room.scene().sky = test::sky_over_z(SkyKind::kOvercast, 100);
  return room;
}

Solution solved(const RoomBuilder& room, SamplingKind sampling, DirectSource direct, std::uint64_t packets) {
  SolverSettings settings;
  settings.sampling = sampling;
  settings.direct = direct;
  settings.packets = packets;
  settings.gather_small_zones = false;
  return solve_zones(room.scene(), room.mesh(), settings, {}, kNever);
}

struct Squares {
  double sum = 0;
  int zones = 0;
  double mean() const { return sum / zones; }
};

// The squared deviations of packets at random from what 8 times as many Sobol' packets find, in units of the
// variance that their weights foresee, are 1 on average, less where a zone counts with the weight of its
// side. The standard deviation of the mean over 180 zones is 0.1. By the mean power of all packets it would
// be 0.07 inside: an audit that sees nothing there.
TEST(LuminairePackets, say_how_much_they_vary_inside_and_outside) {
  const RoomBuilder room = sky_room();
  const Solution random = solved(room, SamplingKind::kRandom, DirectSource::kPackets, 500'000);
  const Solution truth = solved(room, SamplingKind::kSobol, DirectSource::kPackets, 4'000'000);
  const Room walls(room.scene(), random.mesh);
  const LuminairePackets packets(walls, random, kNever);
  std::array<Squares, 2> found;  // outside, inside
  for (std::size_t i = 0; i < random.mesh.zone_count(); ++i) {
    const ZoneId z(i);
    const double expected = truth.direct_irradiance(z, 0).mean;
    const double watts = packets.watts_per_packet(z);
    const double area = random.mesh.zone_area(z);
    if (expected * area < 16 * watts) continue;
    Squares& side = found[random.mesh.zone_is_front(z) ? 1 : 0];
    side.sum += std::pow(packets.irradiance(z) - expected, 2) * area / (expected * watts);
    ++side.zones;
  }
  for (const Squares& side : found) {
    EXPECT_GT(side.zones, 150);
    EXPECT_GT(side.mean(), 0.6);
    EXPECT_LT(side.mean(), 1.45);
  }
}

TEST(LuminairePackets, under_a_sky_agree_with_shadow_rays) {
  const RoomBuilder room = sky_room();
  for (const DirectSource direct : {DirectSource::kPackets, DirectSource::kBest}) {
    Solution solution = solved(room, SamplingKind::kRandom, direct, 1'000'000);
    const Room walls(room.scene(), solution.mesh);
    const DirectAudit audit = audit_direct_light(walls, solution, {}, {}, kNever);
    EXPECT_TRUE(audit.agrees()) << audit.different.size() << " zones differ";
  }
}

TEST(LuminairePackets, all_weigh_the_same_without_a_sky) {
  const RoomBuilder room = test::room_with_shelf();
  const Solution solution = solved(room, SamplingKind::kSobol, DirectSource::kBest, 100'000);
  const Room walls(room.scene(), solution.mesh);
  const LuminairePackets packets(walls, solution, kNever);
  EXPECT_NEAR(packets.watts_per_packet(ZoneId(0)), 0.12 * 20 / 100'000, 1e-9);
  EXPECT_EQ(packets.watts_per_packet(ZoneId(0)), packets.watts_per_packet(SurfaceId(3)));
  EXPECT_EQ(packets.largest_sky_irradiance(), 0);
}

}  // namespace
}  // namespace reemit

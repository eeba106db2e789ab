#include "solver/gather/small_zones.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "solver/progressive_solver.h"
#include "solver/tally/replicates.h"
#include "tests/support/chi_square.h"
#include "tests/support/never.h"
#include "tests/support/test_rooms.h"
#include "tests/support/variable_furnace.h"

namespace reemit {
namespace {

using test::kNever;
using test::VariableFurnace;

/// A furnace with screens of `cells` x `cells` cells whose zones have areas from 2e-4 down to 2e-8 m2; those
/// of the walls have 0.03 m2.
VariableFurnace room_of_many_sizes(int cells = 5) {
  VariableFurnace furnace(8);
  double x = 0.2;
  for (const double cell : {0.02, 0.006, 0.002, 0.0006, 0.0002}) {
    const double size = cells * cell;
    furnace.screen({x, 0.2, 0.3}, {size, 0, 0}, {0, 0.4 * size, size}, cells);
    x += 0.25;
  }
  return furnace;
}

Solution run(const VariableFurnace& furnace, bool gather, std::uint64_t seed = 1,
             std::uint64_t packets = 5'000'000) {
  SolverSettings settings;
  settings.packets = packets;
  settings.gather_small_zones = gather;
  settings.seed = seed;
  return solve_zones(furnace.room().scene(), furnace.room().mesh(), settings, {}, kNever);
}

bool is_small(const Solution& s, std::size_t z) {
  return s.mesh.zone_area(ZoneId(z)) < 3e-4;
}

/// Rms of the relative deviation from the truth over the small zones.
double rms_of_small_zones(const Solution& s) {
  double sum = 0;
  int count = 0;
  for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
    if (!is_small(s, z)) continue;
    sum += std::pow(s.irradiance(ZoneId(z), 0).mean / VariableFurnace::kRadiosity - 1, 2);
    ++count;
  }
  return std::sqrt(sum / count);
}

TEST(SmallZones, are_found_far_better_by_gathering_which_keeps_all_others) {
  const VariableFurnace furnace = room_of_many_sizes();
  const Solution before = run(furnace, false);
  const Solution after = run(furnace, true);
  EXPECT_EQ(before.record.gathered_zones, 0U);
  EXPECT_GT(after.record.gathered_zones, 400U);
  EXPECT_EQ(small_zone_count(after.mesh), 500U);
  EXPECT_GT(rms_of_small_zones(before), 0.5);
  EXPECT_LT(rms_of_small_zones(after), 0.1);
  for (std::size_t z = 0; z < after.mesh.zone_count(); ++z) {
    if (is_small(after, z)) continue;
    EXPECT_EQ(before.sums.direct[z], after.sums.direct[z]);
    EXPECT_EQ(before.sums.indirect[z], after.sums.indirect[z]);
  }
  EXPECT_EQ(before.sums.batches, after.sums.batches);
  EXPECT_TRUE(after.audit.balanced());
}

/// Irradiances of one small zone of each side of a screen, from many runs. The others of a screen would see
/// the same noise of the same walls and count it again: these screens have one cell.
std::vector<test::Measured> independent_zones() {
  std::vector<test::Measured> measured;
  const VariableFurnace furnace = room_of_many_sizes(1);
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Solution s = run(furnace, true, seed, 1'200'000);
    std::set<std::pair<SurfaceId, bool>> seen;
    for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
      if (!is_small(s, z)) continue;
      if (!seen.emplace(s.mesh.zone_surface(ZoneId(z)), s.mesh.zone_is_front(ZoneId(z))).second) continue;
      const Estimate e = s.irradiance(ZoneId(z), 0);
      measured.push_back({e.mean, e.stderr_of_mean});
    }
  }
  return measured;
}

TEST(SmallZones, have_the_right_mean_and_error) {
  const std::vector<test::Measured> measured = independent_zones();
  // Squared deviations in standard errors as chi-square; a bias of 2 % must be noticed.
  const auto fit = [&](double truth) {
    return test::agreement(measured, std::vector<test::Measured>(measured.size(), {truth, 0}),
                           static_cast<double>(ZoneSums::kGroups));
  };
  EXPECT_GT(fit(VariableFurnace::kRadiosity), test::kFalseAlarm);
  EXPECT_LT(fit(1.02 * VariableFurnace::kRadiosity), test::kFalseAlarm);
}

/// A box with a low table whose feet stand in its shadow, and zones of the floor much larger than that.
test::RoomBuilder room_with_low_table() {
  test::RoomBuilder room;
  const MaterialId white = room.material("white", 0.7, 0, true);
  const MaterialId lamp = room.material("lamp", 0.5, 20);
  room.box({0, 0, 0}, {1, 1, 1}, {white, white, white, white, white, white}, 2);
  room.quad(lamp, {Vec3(0.3, 0.3, 0.98), Vec3(0.3, 0.7, 0.98), Vec3(0.7, 0.7, 0.98), Vec3(0.7, 0.3, 0.98)},
            2);
  const double top = 0.08;
  room.quad(white, {Vec3(0.1, 0.1, top), Vec3(0.45, 0.1, top), Vec3(0.45, 0.35, top), Vec3(0.1, 0.35, top)},
            4);
  for (const double x : {0.12, 0.4})
    for (const double y : {0.12, 0.3})
      room.box({x, y, 0}, {x + 0.03, y + 0.03, top}, {white, white, white, white, {}, {}}, 4);
  return room;
}

/// Power of the light on all small zones together.
test::Measured light_on_small_zones(const Solution& s) {
  std::array<double, ZoneSums::kGroups> power{};
  for (std::size_t z = 0; z < s.mesh.zone_count(); ++z)
    if (is_small(s, z))
      for (std::size_t g = 0; g < power.size(); ++g)
        power[g] += s.mesh.zone_area(ZoneId(z)) *
                    (static_cast<double>(s.sums.group_total[g * s.sums.direct.size() + z]) /
                     static_cast<double>(s.sums.group_weight[g]));
  const ReplicateMean mean =
      mean_of_replicates(power.size(), power.size(), [&](std::size_t g) { return power[g]; });
  return {mean.mean, std::sqrt(mean.squared_error)};
}

Solution solved_by(const test::RoomBuilder& room, std::uint64_t packets) {
  SolverSettings settings;
  settings.packets = packets;
  return solve_zones(room.scene(), room.mesh(), settings, {}, kNever);
}

/// Light on all small zones as gathered, and as other packets bring it.
struct TwoWays {
  std::uint64_t gathered_zones;
  test::Measured gathered, by_packets;

  double error() const { return std::hypot(gathered.stderr_of_mean, by_packets.stderr_of_mean); }
};

TwoWays light_both_ways(const test::RoomBuilder& room, std::uint64_t packets, std::uint64_t packets_alone) {
  SolverSettings settings;
  settings.packets = packets;
  settings.direct = DirectSource::kPackets;  // small zones get few shadow rays
  const Solution gathered = solve_zones(room.scene(), room.mesh(), settings, {}, kNever);
  settings.gather_small_zones = false;
  settings.packets = packets_alone;
  settings.seed = 2;
  const Solution alone = solve_zones(room.scene(), room.mesh(), settings, {}, kNever);
  return {gathered.record.gathered_zones, light_on_small_zones(gathered), light_on_small_zones(alone)};
}

// Their floor is dark, but the mean of its zones is not: read as they stand they make feet a quarter
// brighter. Five standard errors, 2.5 %, are passed once in two million runs.
TEST(SmallZones, see_the_shadows_they_stand_in) {
  const TwoWays light = light_both_ways(room_with_low_table(), 6'000'000, 16'000'000);
  EXPECT_GT(light.gathered_zones, 100U);
  EXPECT_LT(light.error(), 0.005 * light.by_packets.mean);
  EXPECT_NEAR(light.gathered.mean, light.by_packets.mean, 5 * light.error());
}

/// A room whose ceiling is bright above a lamp that shines up, which a shade hides from everything below, and
/// 200 small zones each way in its middle.
test::RoomBuilder room_with_shaded_lamp() {
  test::RoomBuilder room;
  const MaterialId white = room.material("white", 0.5, 0, true);
  const MaterialId lamp = room.material("lamp", 0.5, 1);
  const MaterialId hidden = room.material("hidden lamp", 0.5, 20);
  room.box({0, 0, 0}, {1, 1, 1}, {white, white, white, white, white, white}, 2);
  room.quad(lamp, {Vec3(0.2, 0.2, 0.02), Vec3(0.8, 0.2, 0.02), Vec3(0.8, 0.8, 0.02), Vec3(0.2, 0.8, 0.02)},
            2);
  room.quad(white, {Vec3(0.3, 0.3, 0.95), Vec3(0.3, 0.7, 0.95), Vec3(0.7, 0.7, 0.95), Vec3(0.7, 0.3, 0.95)},
            2);
  room.quad(hidden, {Vec3(0.4, 0.4, 0.96), Vec3(0.6, 0.4, 0.96), Vec3(0.6, 0.6, 0.96), Vec3(0.4, 0.6, 0.96)},
            2);
  room.quad(white, {Vec3(0.4, 0.4, 0.5), Vec3(0.5, 0.4, 0.5), Vec3(0.5, 0.5, 0.5), Vec3(0.4, 0.5, 0.5)}, 10);
  return room;
}

// Each zone meets so few packets that they have little to say against its gather. Read as it stands, the
// ceiling sends them what only the shade gets, 36 % more than there is. Five standard errors are passed once
// in two million runs.
TEST(SmallZones, are_not_lit_by_what_is_hidden_from_them) {
  const TwoWays light = light_both_ways(room_with_shaded_lamp(), 2'000'000, 8'000'000);
  EXPECT_GT(light.gathered_zones, 300U);
  EXPECT_LT(light.error(), 0.01 * light.by_packets.mean);
  EXPECT_NEAR(light.gathered.mean, light.by_packets.mean, 5 * light.error());
}

/// A furnace of irradiance 1 on everything, with a cube of a millimetre that is open at the top and reflects
/// nine tenths.
test::RoomBuilder furnace_with_a_well() {
  test::RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5, 0.5);
  const MaterialId well = room.material("well", 0.9, 0.1);
  room.box({0, 0, 0}, {1, 1, 1}, {wall, wall, wall, wall, wall, wall}, 8);
  room.box({0.5, 0.5, 0.5}, {0.501, 0.501, 0.501}, {well, well, well, well, well, {}}, 2);
  return room;
}

// Hardly a packet enters it. Gathers that read what packets brought there find what a few reflections bring,
// a fifth of it all. Five standard errors are passed once in two million runs.
TEST(SmallZones, see_light_in_cavities_that_packets_hardly_enter) {
  const Solution s = solved_by(furnace_with_a_well(), 4'000'000);
  EXPECT_EQ(s.record.gathered_zones, 40U);
  const test::Measured power = light_on_small_zones(s);
  const double area = 5e-6;
  EXPECT_LT(power.stderr_of_mean, 0.004 * area);  // 2 % would be seen
  EXPECT_NEAR(power.mean, area, 5 * power.stderr_of_mean);
}

TEST(SmallZones, keep_caustics_and_the_inside_of_glass) {
  test::RoomBuilder room = room_with_low_table();
  Scene& scene = room.scene();
  const MaterialId glass = room.material("glass", 0, 0, true);
  NonDiffusePart& part = scene.materials[glass.index()].non_diffuse;
  part.specular_transmittance = room.flat(1);
  part.index_of_refraction = 1.5;
  part.angle_law = AngleLaw::kDielectric;
  part.is_solid = true;
  room.solid({0.5, 0.5, 0.2}, {0.55, 0.55, 0.25}, glass, 4);
  const MaterialId tray = room.material("tray", 0.5, 0, true);
  room.quad(tray,
            {Vec3(0.5, 0.5, 0.15), Vec3(0.55, 0.5, 0.15), Vec3(0.55, 0.55, 0.15), Vec3(0.5, 0.55, 0.15)}, 4);
  SolverSettings settings;
  settings.packets = 2'000'000;
  const Solution gathered = solve_zones(scene, room.mesh(), settings, {}, kNever);
  settings.gather_small_zones = false;
  const Solution packets = solve_zones(scene, room.mesh(), settings, {}, kNever);
  EXPECT_EQ(gathered.sums.caustic, packets.sums.caustic);
  std::size_t over_glass = 0;
  for (const ZoneId z : gathered.gathered.zones) {
    const bool is_glass = scene.surfaces[gathered.mesh.zone_surface(z).index()].material == glass;
    EXPECT_FALSE(is_glass && !gathered.mesh.zone_is_front(z)) << z.index();
    if (gathered.sums.caustic[z.index()] > 0) ++over_glass;
  }
  EXPECT_GT(over_glass, 10U);
}

/// A dim box in which a narrow beam lights a spot that fills a ten-thousandth of what a plate 30 cm over it
/// sees. `mirrored`: straight or over a mirror, where no gather rays can be aimed at it (BrightZones): the
/// spot is then on a tile beside the plate.
test::RoomBuilder plate_and_bright_spot(bool mirrored) {
  test::RoomBuilder room;
  const MaterialId white = room.material("white", 0.5, 0, true);
  const MaterialId lamp = room.material("lamp", 0.5, 0.2);
  MaterialId floor = white;
  if (mirrored) {
    floor = room.material("mirror", 0);
    room.scene().materials[floor.index()].non_diffuse.specular_reflectance = room.flat(0.9);
  }
  room.box({0, 0, 0}, {1, 1, 1}, {white, white, white, white, floor, white}, 8);
  room.quad(lamp, {Vec3(0.6, 0.6, 0.98), Vec3(0.6, 0.9, 0.98), Vec3(0.9, 0.9, 0.98), Vec3(0.9, 0.6, 0.98)},
            2);
  const Vec3 at = mirrored ? Vec3(0.3, 0.2, 0.3) : Vec3(0.2, 0.2, 0.001);
  room.quad(white, {at, at + Vec3(0.006, 0, 0), at + Vec3(0.006, 0.006, 0), at + Vec3(0, 0.006, 0)}, 1);
  const double to = mirrored ? 0.214 : 0.21;
  room.quad(white, {Vec3(0.2, 0.2, 0.3), Vec3(0.2, to, 0.3), Vec3(to, to, 0.3), Vec3(to, 0.2, 0.3)}, 1);
  const Vec3 from = mirrored ? Vec3(0.303, 0.203, 0.02) : Vec3(0.6, 0.203, 0.4);
  const Vec3 towards = at + Vec3(0.003, 0.003, 0) - from;
  room.scene().lights.push_back(
      SpotLight{"beam", from, towards.normalized(), room.flat(mirrored ? 5000 : 1000), 0.002, 0.003});
  return room;
}

/// That room, by packets and with small zones gathered.
struct PlateSolved {
  Solution gathered, packets;

  explicit PlateSolved(bool mirrored) {
    const test::RoomBuilder room = plate_and_bright_spot(mirrored);
    SolverSettings settings;
    settings.packets = 5'000'000;
    gathered = solve_zones(room.scene(), room.mesh(), settings, {}, kNever);
    settings.gather_small_zones = false;
    packets = solve_zones(room.scene(), room.mesh(), settings, {}, kNever);
  }

  /// The two zones of the plate that the spot lights.
  std::vector<ZoneId> over_the_spot() const {
    std::vector<ZoneId> zones;
    for (std::size_t z = 0; z < packets.mesh.zone_count(); ++z) {
      const Vec3 centre = packets.mesh.zone_centroid(ZoneId(z));
      if (is_small(packets, z) && centre.z() > 0.2 && centre.x() < 0.25 &&
          packets.irradiance(ZoneId(z), 0).mean > 0.03)
        zones.emplace_back(z);
    }
    EXPECT_EQ(zones.size(), 2U);
    return zones;
  }
};

// The pilot's rays miss the spot, and one of thousands that follow meets it: one half of the plate has far
// too much light then, and the other none of it, with a standard error that knows nothing of it. Packets know
// the light on each half to 5 %.
TEST(SmallZones, keep_what_packets_brought_where_few_gather_rays_meet_a_bright_spot) {
  const PlateSolved solved(true);
  EXPECT_GT(solved.gathered.record.gathered_zones, 2U);
  for (const ZoneId z : solved.over_the_spot()) {
    const Estimate by_packets = solved.packets.irradiance(z, 0);
    const Estimate kept = solved.gathered.irradiance(z, 0);
    EXPECT_EQ(kept.mean, by_packets.mean);
    EXPECT_EQ(kept.stderr_of_mean, by_packets.stderr_of_mean);
    EXPECT_LT(kept.stderr_of_mean, 0.06 * kept.mean);
  }
}

// Rays that are aimed at the spot find it. Against packets: 5 standard errors for two zones, odds of a false
// alarm below 1 in 3,000 by Student's t with 15 degrees of freedom.
TEST(SmallZones, are_gathered_where_rays_are_aimed_at_a_bright_spot) {
  const PlateSolved solved(false);
  for (const ZoneId z : solved.over_the_spot()) {
    const Estimate by_packets = solved.packets.irradiance(z, 0);
    const Estimate found = solved.gathered.irradiance(z, 0);
    EXPECT_LT(found.stderr_of_mean, 0.2 * by_packets.stderr_of_mean);
    EXPECT_LT(std::abs(found.mean - by_packets.mean),
              5 * std::hypot(by_packets.stderr_of_mean, found.stderr_of_mean));
  }
}

/// A box with a lamp that a hood hides but for an opening, and in its middle a sensor of a square millimetre:
/// a hundredth of what it can see is bright.
test::RoomBuilder room_with_sensor() {
  test::RoomBuilder room;
  const MaterialId grey = room.material("grey", 0.1, 0);
  const MaterialId lamp = room.material("lamp", 0, 100);
  room.box({0, 0, 0}, {1, 1, 1}, {grey, grey, grey, grey, grey, grey}, 8);
  room.quad(lamp, {Vec3(0, 0, 0.9), Vec3(0, 1, 0.9), Vec3(1, 1, 0.9), Vec3(1, 0, 0.9)}, 1);
  const auto hood = [&](double x0, double x1, double y0, double y1) {
    room.quad(grey, {Vec3(x0, y0, 0.89), Vec3(x0, y1, 0.89), Vec3(x1, y1, 0.89), Vec3(x1, y0, 0.89)}, 1);
  };
  hood(0, 0.45, 0, 1);
  hood(0.55, 1, 0, 1);
  hood(0.45, 0.55, 0, 0.45);
  hood(0.45, 0.55, 0.55, 1);
  room.quad(grey,
            {Vec3(0.5, 0.5, 0.1), Vec3(0.501, 0.5, 0.1), Vec3(0.501, 0.501, 0.1), Vec3(0.5, 0.501, 0.1)}, 1);
  return room;
}

// With as many shadow rays as other zones meet packets it is known to 4 %.
TEST(SmallZones, are_known_well_where_they_are_few) {
  const Solution s = solved_by(room_with_sensor(), 4'000'000);
  ASSERT_EQ(s.record.gathered_zones, 2U);
  const test::Measured power = light_on_small_zones(s);
  EXPECT_LT(power.stderr_of_mean, 0.03 * power.mean);
}

// A hundred sensors of 1 cm2 in a hall that a hundred thousand packets hardly light: none meets a packet but
// by luck, and each is known. All walls emit, so that the irradiance is M/(1 - rho) everywhere.
TEST(SmallZones, are_all_found_where_packets_meet_none) {
  test::RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5, 1);
  const MaterialId sensor = room.material("sensor", 0.01);
  room.box({0, 0, 0}, {20, 4, 20}, {wall, wall, wall, wall, wall, wall}, 8);
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j) {
      const Vec3 corner(1 + 1.9 * i, 0.8, 1.1 + 1.9 * j);
      room.quad(sensor,
                {corner, corner + Vec3(0, 0, 0.01), corner + Vec3(0.01, 0, 0.01), corner + Vec3(0.01, 0, 0)},
                1);
    }
  const Solution s = solved_by(room, 100'000);
  EXPECT_EQ(s.record.gathered_zones, 200U);
  for (std::size_t z = 0; z < s.mesh.zone_count(); ++z) {
    if (s.mesh.zone_area(ZoneId(z)) > 1e-3) continue;
    const Estimate e = s.irradiance(ZoneId(z), 0);
    // 15 degrees of freedom: odds of 1 in 10^4 for all zones together.
    EXPECT_NEAR(e.mean, 2, 8 * e.stderr_of_mean);
    EXPECT_LT(e.stderr_of_mean, 0.04);
  }
}

TEST(SmallZones, need_all_batch_groups) {
  SolverSettings settings;
  settings.packets = 30'000;
  settings.batch_packets = 3'000;
  const VariableFurnace furnace = room_of_many_sizes();
  const Solution s = solve_zones(furnace.room().scene(), furnace.room().mesh(), settings, {}, kNever);
  EXPECT_EQ(s.record.gathered_zones, 0U);
}

}  // namespace
}  // namespace reemit

#include "solver/gather/seen_light.h"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/hand_made_solution.h"
#include "tests/support/mean_test.h"

namespace reemit {
namespace {

using test::MeanTest;

/// Of a field of one part and one band, by zone [W/(m2 sr)].
std::vector<float> reflected_of(const RadianceField& field) {
  std::vector<float> reflected;
  for (std::size_t z = 0; z < field.room().mesh().zone_count(); ++z)
    reflected.push_back(field.reflected(ZoneId(z))[0]);
  return reflected;
}

/// A wide room with a tile of two zones of 0.5 m2 in its middle. A plate 1 mm above the half x > 0.5 m hides
/// all but 1/4 of the zone on its side of the diagonal and all but 3/4 of the other one.
class TileUnderPlate {
 public:
  TileUnderPlate(double rho_walls, double rho_plate) {
    const MaterialId wall = room_.material("wall", rho_walls);
    const MaterialId tile = room_.material("tile", kTile);
    const MaterialId plate = room_.material("plate", rho_plate, 0, true);
    tile_ = room_.mesh().mesh.triangle_count();
    room_.quad(tile, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, 1);
    room_.quad(plate, {Vec3(0.5, 0, 1e-3), Vec3(1, 0, 1e-3), Vec3(1, 1, 1e-3), Vec3(0.5, 1, 1e-3)}, 1);
    room_.box(Vec3(-9, -9, -9), {20, 20, 20}, {wall, wall, wall, wall, wall, wall}, 1);
  }

  static constexpr double kTile = 0.5;  ///< Its reflectance.

  const test::RoomBuilder& builder() const { return room_; }
  ZoneId tile_zone(const ZoneMesh& mesh, std::uint32_t number) const {
    return mesh.first_zone(TriangleId(static_cast<std::uint32_t>(tile_) + number), true);
  }

  /// Looks at tile zone 0 or 1, 512 times; every surface reflects its reflectance times 1 W/(m2 sr).
  void look(std::uint32_t number, MeanTest& open, MeanTest& misread) const {
    const Solution solution = test::uniform_solution(room_, 0, std::numbers::pi);
    const Room walls(room_.scene(), solution.mesh);
    const RadianceField field(walls, solution);
    const DirectLight direct(walls);
    const std::vector<float> reflected = reflected_of(field);
    const std::vector<double> scale{1.0};
    const ZoneId zone = tile_zone(solution.mesh, number);
    for (std::uint64_t seed = 1; seed <= 512; ++seed) {
      const SeenLight::Zone seen = SeenLight(field, direct, reflected, scale, seed).look(zone);
      open.add(seen.open);
      misread.add(seen.misread);
    }
  }

 private:
  test::RoomBuilder room_;
  std::size_t tile_;
};

/// Noise of 512 looks: 5 standard errors, odds below 1 in 46,000; 2 % for what comes out sideways below the
/// plate and for the quotient of two estimates.
void expect_near(const MeanTest& found, double truth) {
  EXPECT_NEAR(found.mean(), truth, 5 * found.standard_error() + 0.02 * std::abs(truth));
  EXPECT_LT(5 * found.standard_error(), 0.1 * std::abs(truth)) << "test too weak";
}

TEST(SeenLight, is_brighter_than_the_mean_where_a_dark_part_is_hidden) {
  // What is seen reflects 0.5 of the walls' 1 W/(m2 sr), what a black plate hides nothing.
  const TileUnderPlate room(1, 0);
  for (std::uint32_t number = 0; number < 2; ++number) {
    const double visible = number == 0 ? 0.25 : 0.75;
    MeanTest open, misread;
    room.look(number, open, misread);
    expect_near(open, visible);
    expect_near(misread, TileUnderPlate::kTile * (1 - visible));
  }
}

TEST(SeenLight, is_darker_than_the_mean_where_a_bright_part_is_hidden) {
  constexpr double kWalls = 0.2;
  const TileUnderPlate room(kWalls, 1);
  for (std::uint32_t number = 0; number < 2; ++number) {
    const double visible = number == 0 ? 0.25 : 0.75;
    MeanTest open, misread;
    room.look(number, open, misread);
    expect_near(open, visible);
    expect_near(misread, TileUnderPlate::kTile * (kWalls - 1) * (1 - visible));
  }
}

/// Every surface has a radiosity of 1 W/m2; reflectances are 0.5 and count as 1.
struct EvenlyLitRoom {
  explicit EvenlyLitRoom(const test::RoomBuilder& room)
      : solution(test::uniform_solution(room, 0, 1)), walls(room.scene(), solution.mesh) {}

  const Solution solution;
  const Room walls;
  const RadianceField field{walls, solution};
  const DirectLight direct{walls};
  const std::vector<double> scale{0.5 * std::numbers::inv_pi};
  const std::vector<float> reflected = reflected_of(field);
  const SeenLight seen{field, direct, reflected, scale, 1};
};

TEST(SeenLight, is_the_mean_where_nothing_is_hidden) {
  test::RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5);
  room.box(Vec3::Zero(), {3, 2, 1}, {wall, wall, wall, wall, wall, wall}, 8);
  const EvenlyLitRoom light(room);
  const ZoneMesh& mesh = light.solution.mesh;
  for (std::size_t z = 0; z < mesh.zone_count(); ++z) {
    if (!mesh.zone_is_front(ZoneId(z))) continue;
    EXPECT_GT(light.seen.look(ZoneId(z)).open, 0.3);
    EXPECT_NEAR(light.seen.look(ZoneId(z)).misread, 0, 0.02);
  }
}

// With a second look the noise of two estimates would be there instead of 0.
TEST(SeenLight, looks_once_where_most_rays_leave_the_room) {
  test::RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5, 0, true);
  room.quad(wall, {Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(2, 1, 0), Vec3(1, 1, 0)}, 8);
  room.quad(wall, {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(0, 1, 1), Vec3(0, 0, 1)}, 1);
  const EvenlyLitRoom light(room);
  const ZoneMesh& mesh = light.solution.mesh;
  int looked_at = 0;
  for (std::size_t z = 0; z < mesh.zone_count(); ++z) {
    if (mesh.zone_centroid(ZoneId(z)).x() < 1 || !mesh.zone_is_front(ZoneId(z))) continue;
    ++looked_at;
    EXPECT_EQ(light.seen.look(ZoneId(z)).misread, 0);
  }
  EXPECT_EQ(looked_at, 128);
}

TEST(SeenLight, zones_looked_at_together_get_their_own_looks_where_something_is_near) {
  const TileUnderPlate room(1, 0);
  const EvenlyLitRoom light(room.builder());
  const ZoneId first = room.tile_zone(light.solution.mesh, 0);
  std::array<SeenLight::Zone, 2> together;
  light.seen.look(first, together);
  for (std::size_t z = 0; z < together.size(); ++z) {
    const SeenLight::Zone alone = light.seen.look(ZoneId(first.index() + z));
    EXPECT_NE(alone.misread, 0);
    EXPECT_EQ(together[z].misread, alone.misread);
    EXPECT_EQ(together[z].open, alone.open);
  }
}

/// In a room with nothing in it. Zones of which some rays do not get far pass at times, and are taken to be
/// quite open then: that may make 1 % of the openness.
TEST(SeenLight, zones_looked_at_together_need_few_rays_where_nothing_is_near) {
  test::RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5);
  room.box(Vec3::Zero(), {3, 2, 1}, {wall, wall, wall, wall, wall, wall}, 16);
  const EvenlyLitRoom light(room);
  const std::size_t zones = light.solution.mesh.zone_count();
  MeanTest difference;
  std::size_t not_looked_at = 0;
  std::size_t by_few_rays =
      0;  // surely: by sixteen rays of its own a zone has the openness that it has alone
  for (std::size_t z = 0; z + SeenLight::kTogether <= zones; z += SeenLight::kTogether) {
    std::array<SeenLight::Zone, SeenLight::kTogether> together;
    light.seen.look(ZoneId(z), together);
    for (std::size_t i = 0; i < together.size(); ++i) {
      const SeenLight::Zone alone = light.seen.look(ZoneId(z + i));
      if (together[i].misread != 0) {
        EXPECT_EQ(together[i].misread, alone.misread);
        continue;
      }
      ++not_looked_at;
      by_few_rays += together[i].open != alone.open ? 1 : 0;
      difference.add(together[i].open - alone.open);
    }
  }
  EXPECT_GT(not_looked_at, zones / 4);
  EXPECT_GT(by_few_rays, 10U);
  EXPECT_NEAR(difference.mean(), 0, 0.01);
  EXPECT_LT(MeanTest::kErrors * difference.standard_error(), 0.01) << "test too weak";
}

}  // namespace
}  // namespace reemit

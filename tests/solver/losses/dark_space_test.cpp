#include "solver/losses/dark_space.h"

#include <array>
#include <atomic>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "tests/support/never.h"
#include "tests/support/skies.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using test::kNever;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A box of 4 m x 3 m x 4 m, reflectance 0.5; y is up.
class DarkRoom : public ::testing::Test {
 protected:
  DarkRoom() : grey_(room_.material("grey", 0.5, 0, true)), lamp_(room_.material("lamp", 0.5, 10, true)) {
    room_.box(Vec3(0, 0, 0), Vec3(4, 3, 4), {grey_, grey_, grey_, grey_, grey_, grey_}, 4);
  }

  /// A lamp of 0.6 m x 0.6 m that shines down.
  void lamp(const Vec3& corner) {
    const Vec3 u(0.6, 0, 0);
    const Vec3 v(0, 0, 0.6);
    room_.quad(lamp_, {corner, corner + u, corner + u + v, corner + v}, 2);
  }
  Solution solved(std::uint64_t packets = 1 << 14) const {
    SolverSettings settings;
    settings.packets = packets;
    return solve(room_.scene(), room_.mesh(), settings, {}, kNever);
  }
  DarkSpace dark_space(const StopToken* stop = nullptr) const {
    const Solution solution = solved();
    const Room walls(room_.scene(), solution.mesh);
    return find_dark_space(PacketRoom(walls), solution, stop);
  }

  static Camera camera_at(const Vec3& eye, const Vec3& look_at) {
    Camera camera;
    camera.eye = eye;
    camera.look_at = look_at;
    return camera;
  }

  test::RoomBuilder room_;
  MaterialId grey_, lamp_;
};

TEST_F(DarkRoom, LampsInsideLeaveNoneDark) {
  lamp(Vec3(2, 2, 2));
  EXPECT_THAT(solved().light_warnings, IsEmpty());
  EXPECT_EQ(dark_space().share, 0);
}

TEST_F(DarkRoom, FewPacketsLeaveNoneDark) {
  lamp(Vec3(2, 2, 2));
  EXPECT_THAT(solved(64).light_warnings, IsEmpty());
}

TEST_F(DarkRoom, ARunThatIsCutOffSaysNothingOfTheDark) {
  lamp(Vec3(2, 2, 2));
  SolverSettings settings;
  settings.time_limit_s = 1e-9;
  const Solution solution = solve(room_.scene(), room_.mesh(), settings, {}, kNever);
  ASSERT_TRUE(solution.record.cut_off);
  EXPECT_THAT(solution.light_warnings, IsEmpty());
}

TEST_F(DarkRoom, WithItsLampOutsideIsNamed) {
  lamp(Vec3(10, 2, 1));
  EXPECT_GT(dark_space().share, 0.99);
  EXPECT_THAT(solved().light_warnings,
              ElementsAre(AllOf(HasSubstr("no light gets into"), HasSubstr("'quad2' (16 m2)"),
                                HasSubstr("and 3 more;"), HasSubstr("is a luminaire outside the room"))));
}

TEST_F(DarkRoom, WithItsLampShutInIsNamed) {
  room_.solid(Vec3(1, 1, 1), Vec3(2, 2, 2), grey_, 4);
  lamp(Vec3(1.2, 1.8, 1.2));
  EXPECT_NEAR(dark_space().share, 47.0 / 48, 0.01);
  EXPECT_THAT(solved().light_warnings, ElementsAre(HasSubstr("no light gets into 9")));
}

TEST_F(DarkRoom, CavitiesOfWallsAndFurnitureMayBeDark) {
  room_.solid(Vec3(-.3, -.3, -.3), Vec3(4.3, 3.3, 4.3), grey_, 4);
  room_.solid(Vec3(1, .1, 1), Vec3(3, 1, 3), grey_, 4);
  lamp(Vec3(2, 2, 2));
  const double cavity = 4.6 * 3.6 * 4.6 - 48;
  EXPECT_NEAR(dark_space().share, (cavity + 3.6) / (cavity + 48), 0.02);
  EXPECT_THAT(solved().light_warnings, IsEmpty());
}

TEST_F(DarkRoom, WithoutAWindowUnderASkyIsNamed) {
  room_.scene().sky = test::sky_over_z(SkyKind::kOvercast, 50);
  EXPECT_THAT(solved().light_warnings,
              ElementsAre(AllOf(HasSubstr("no light gets into"), HasSubstr("is a window opaque"))));
  room_.scene().cameras = {camera_at(Vec3(2, 1.5, 3), Vec3(2, 1, 0))};
  EXPECT_THAT(solved().light_warnings, ElementsAre(HasSubstr("is a window opaque")));
}

TEST_F(DarkRoom, SeenFromOutsideMayBeDarkUnderASky) {
  room_.scene().sky = test::sky_over_z(SkyKind::kOvercast, 50);
  room_.scene().cameras = {camera_at(Vec3(2, 1.5, 20), Vec3(2, 1, 0))};
  EXPECT_GT(dark_space().share, 0.99);
  EXPECT_THAT(solved().light_warnings, IsEmpty());
}

TEST_F(DarkRoom, IsNotLookedAtOnceSomebodyWaits) {
  lamp(Vec3(2, 2, 2));
  const std::atomic<bool> interrupt{true};
  const StopToken stop(interrupt);
  EXPECT_THROW(dark_space(&stop), Interrupted);
}

}  // namespace
}  // namespace reemit

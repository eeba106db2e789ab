#include "mesh/repair/dropped_luminaires.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/model/error.h"
#include "tests/mesh/test_room.h"

namespace reemit {
namespace {

using test::floor_rectangle;
using test::TestRoom;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

/// A closed room of 4 m x 3 m x 5 m with a lamp of the given outline and one of 1 m2 if `second` is above 0,
/// which emits `second` times as much.
class DroppedLuminaires : public ::testing::Test {
 protected:
  void lamp(const std::vector<Vec3>& outline) {
    room_.box("walls", room_.material(), Vec3(0, 0, 0), Vec3(4, 3, 5), true);
    double twice = 0;  // outlines here are planar and convex
    for (std::size_t i = 1; i + 1 < outline.size(); ++i)
      twice += (outline[i] - outline[0]).cross(outline[i + 1] - outline[0]).norm();
    area_ = 0.5 * twice;
    room_.polygon("tube", room_.material(true, 1 / area_), outline);
  }
  void second_lamp(double power) {
    room_.polygon("panel", room_.material(true, power), floor_rectangle(1, 1, 2, 2, 4));
  }
  TestRoom room_;
  double area_ = 0;
};

const std::vector<Vec3> kSpeck = floor_rectangle(2, 2, 2 + 1e-10, 2 + 1e-10, 2);
const std::vector<Vec3> kNeedle{{1, 1, 1}, {3, 1, 1}, {2, 1.00000002, 1}};

TEST_F(DroppedLuminaires, TheOnlyOneIsRefusedByName) {
  for (const auto& outline : {kSpeck, kNeedle}) {
    room_ = TestRoom();
    lamp(outline);
    EXPECT_THAT([&] { build_mesh(room_.scene()); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("'tube'"), HasSubstr("test-room:1, face 0"),
                                                HasSubstr("7.1e-07 m"), HasSubstr("nothing else lights"))));
  }
}

TEST_F(DroppedLuminaires, OneOfSeveralIsWarnedOfWithItsShare) {
  lamp(kNeedle);
  second_lamp(3);
  const MeshResult meshed = build_mesh(room_.scene());
  EXPECT_THAT(meshed.report.warnings,
              Contains(AllOf(HasSubstr("25 % of the power of luminous surfaces is lost"), HasSubstr("'tube'"),
                             Not(HasSubstr("'panel'")))));
  EXPECT_NEAR(meshed.report.surfaces[1].collapsed / area_, 1, 1e-9);
  EXPECT_EQ(meshed.report.surfaces[2].collapsed, 0);
  EXPECT_LT(test::worst_book_gap(meshed), 1e-9);
}

TEST_F(DroppedLuminaires, ALightWithoutAreaKeepsTheRoomLit) {
  lamp(kSpeck);
  room_.scene().lights.emplace_back(PointLight{"bulb", Vec3(2, 1, 2), Spectrum::Constant(1, 1.0)});
  EXPECT_THAT(build_mesh(room_.scene()).report.warnings,
              Contains(HasSubstr("100 % of the power of luminous")));
}

TEST_F(DroppedLuminaires, LostFacesThatEmitNothingAreNoMatter) {
  room_.box("walls", room_.material(), Vec3(0, 0, 0), Vec3(4, 3, 5), true);
  room_.polygon("hair", room_.material(), kNeedle);
  second_lamp(1);
  // Twice the same lamp is one lamp: a copy that goes takes no light with it.
  room_.polygon("copy", MaterialId(2), floor_rectangle(1, 1, 2, 2, 4));
  EXPECT_THAT(build_mesh(room_.scene()).report.warnings, Not(Contains(HasSubstr("luminous"))));
}

}  // namespace
}  // namespace reemit

#include <atomic>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/losses/lamp_losses.h"
#include "solver/losses/luminaire_warnings.h"
#include "solver/losses/opening_losses.h"
#include "solver/room/room.h"
#include "tests/solver/emit/luminaire_tables.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using test::RoomBuilder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A closed room of 4 m x 3 m x 4 m; y is up and quad3 is the ceiling at y = 3.
class LuminaireLosses : public ::testing::TestWithParam<bool> {
 protected:
  void walls(bool two_sided) {
    const MaterialId grey = room_.material("grey", 0.5, 0, two_sided);
    room_.box(Vec3(0, 0, 0), Vec3(4, 3, 4), {grey, grey, grey, grey, grey, grey}, 2);
  }

  /// Shines down with I = cos(gamma); 0.6 m x 1.2 m and 35 mm high.
  PhotometricLight troffer(const Vec3& position) const {
    PhotometricLight l;
    l.name = "troffer";
    l.position = position;
    l.orientation.col(0) = Vec3(1, 0, 0);
    l.orientation.col(1) = Vec3(0, 0, -1);
    l.orientation.col(2) = Vec3(0, 1, 0);
    l.table = test::lambertian_table();
    l.intensity_per_candela = room_.flat(1);
    l.opening = test::opening(LuminousOpening::Shape::kBox, 1.2, 0.6, 0.035);
    return l;
  }

  std::vector<OpeningLoss> losses() const {
    const MeshResult meshed = room_.mesh();
    const Room walls(room_.scene(), meshed.mesh);
    const PacketRoom transport(walls);
    return opening_losses(transport);
  }
  std::vector<std::string> warnings() const {
    const MeshResult meshed = room_.mesh();
    return luminaire_warnings(room_.scene(), meshed.mesh);
  }
  void light(PunctualLight l) { room_.scene().lights.push_back(std::move(l)); }

  RoomBuilder room_;
};

TEST_P(LuminaireLosses, OpeningsWithTheirMiddleAtTheCeilingLoseHalf) {
  walls(GetParam());
  light(troffer(Vec3(2, 3, 2)));
  const std::vector<OpeningLoss> found = losses();
  ASSERT_EQ(found.size(), 1u);
  // 4096 stratified points of a box of which half is above; 4 standard errors of independent ones are 0.031.
  EXPECT_NEAR(found[0].lost, 0.5, 0.031);
  EXPECT_EQ(found[0].beyond, found[0].lost);
  EXPECT_NEAR(found[0].seen, 1 - found[0].lost, 1e-12);
  EXPECT_EQ(found[0].surface, SurfaceId(3));
  EXPECT_THAT(warnings(), ElementsAre(AllOf(HasSubstr("light 'troffer'"), HasSubstr("across 'quad3'"),
                                            HasSubstr("mount"))));
}

TEST_P(LuminaireLosses, ThePartBeyondTheCeilingIsTheShareLost) {
  walls(GetParam());
  PhotometricLight l = troffer(Vec3(2, 3 - 0.0075, 2));  // 10 of 35 mm are above
  light(l);
  const Vec3 size = l.opening.size();
  const double sides = 2 * (size.x() + size.y()) * size.z();
  const double caps = 2 * size.x() * size.y();
  const double above = (sides * 10 / 35 + caps / 2) / (sides + caps);
  ASSERT_EQ(losses().size(), 1u);
  EXPECT_NEAR(losses()[0].lost, above, 0.031);  // 4 standard errors
}

TEST_P(LuminaireLosses, MountedBelowTheCeilingNothingIsLost) {
  walls(GetParam());
  light(troffer(Vec3(2, 3 - 0.0175, 2)));
  PhotometricLight flat = troffer(Vec3(1, 3, 1));
  flat.opening.height = 0;
  light(flat);
  light(PointLight{"bulb", Vec3(2, 2.999, 2), room_.flat(1)});
  light(DirectionalLight{"sun", Vec3(0, -1, 0), room_.flat(1)});
  EXPECT_THAT(losses(), IsEmpty());
  EXPECT_THAT(warnings(), IsEmpty());
}

TEST_P(LuminaireLosses, LampsThatLightNothingAreFarOutside) {
  walls(GetParam());
  light(SpotLight{"in millimetres", Vec3(2000, 2900, 2000), Vec3(0, -1, 0), room_.flat(1), 0.1, 0.3});
  light(PointLight{"bulb", Vec3(2, 2, 2), room_.flat(1)});
  const std::vector<OpeningLoss> found = losses();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].meets_nothing);
  EXPECT_EQ(found[0].lost, 1);
  EXPECT_THAT(warnings(), ElementsAre(AllOf(HasSubstr("'in millimetres'"), HasSubstr("meets nothing"))));
}

// A table top with two like sides is lit from within as any room is.
TEST_P(LuminaireLosses, LampsInsideOfFurnitureAreShutIn) {
  walls(GetParam());
  const MaterialId wood = room_.material("wood", 0.5, 0, true);
  room_.solid({1, 0.7, 1}, {2, 0.74, 2}, wood, 1);
  light(PointLight{"in the table", Vec3(1.5, 0.72, 1.5), room_.flat(1)});
  light(SpotLight{"washer", Vec3(2, 2, 0.05), Vec3(0, 0, -1), room_.flat(1), 0.1, 0.3});
  light(PointLight{"bulb", Vec3(2, 2, 2), room_.flat(1)});
  const std::vector<OpeningLoss> found = losses();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].is_shut_in);
  EXPECT_THAT(warnings(), ElementsAre(AllOf(HasSubstr("'in the table'"), HasSubstr("gets out of 'quad"))));
}

TEST_P(LuminaireLosses, LampsInOpalBodiesAreNot) {
  walls(GetParam());
  const MaterialId opal = room_.material("opal", 0.3, 0, true);
  room_.scene().materials[opal.index()].non_diffuse.diffuse_transmittance = room_.flat(0.5);
  room_.solid({1.4, 1.9, 1.4}, {1.6, 2.1, 1.6}, opal, 1);
  light(PointLight{"pendant", Vec3(1.5, 2, 1.5), room_.flat(1)});
  EXPECT_THAT(losses(), IsEmpty());
}

TEST_P(LuminaireLosses, RoomsAsGoodAsDarkAreNamed) {
  walls(GetParam());
  light(PointLight{"bulb", Vec3(1.5, 2, 1.5), room_.flat(1e-4)});
  EXPECT_THAT(warnings(), IsEmpty());
  std::get<PointLight>(room_.scene().lights[0]).intensity = room_.flat(1e-6);  // 1.6e-7 W/m2
  EXPECT_THAT(warnings(),
              ElementsAre(AllOf(HasSubstr("send out 1.26e-05 W"), HasSubstr("less than starlight"))));
}

INSTANTIATE_TEST_SUITE_P(Sides, LuminaireLosses, testing::Bool());

TEST_F(LuminaireLosses, LampsBehindASurfaceLoseWhatMeetsItsBack) {
  walls(false);
  light(SpotLight{"spot", Vec3(2, 3.2, 2), Vec3(0, -1, 0), room_.flat(1), 0.1, 0.3});
  light(troffer(Vec3(2, 3.5, 2)));
  const std::vector<OpeningLoss> found = losses();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].lost, 1);
  EXPECT_EQ(found[0].surface, SurfaceId(3));
  EXPECT_THAT(warnings(),
              ElementsAre(AllOf(HasSubstr("'spot'"), HasSubstr("100 %"), HasSubstr("behind 'quad3'")),
                          AllOf(HasSubstr("'troffer'"), HasSubstr("behind 'quad3'"))));
}

TEST_F(LuminaireLosses, LampsOutsideARoomOfTwoSidedFacesLoseAll) {
  walls(true);
  light(SpotLight{"spot", Vec3(2, 3.2, 2), Vec3(0, -1, 0), room_.flat(1), 0.1, 0.3});
  light(PointLight{"bulb", Vec3(2, 3.01, 2), room_.flat(1)});
  light(troffer(Vec3(2, 3.5, 2)));
  EXPECT_THAT(warnings(), ElementsAre(AllOf(HasSubstr("'spot': 100 %"), HasSubstr("behind 'quad3'")),
                                      AllOf(HasSubstr("'bulb': 100 %"), HasSubstr("behind 'quad3'")),
                                      AllOf(HasSubstr("'troffer': 100 %"), HasSubstr("behind 'quad3'"))));
}

TEST_F(LuminaireLosses, LampsInOpenRoomsAndOutdoorsLoseNothing) {
  const MaterialId grey = room_.material("grey", 0.5, 0, true);
  room_.box(Vec3(0, 0, 0), Vec3(4, 3, 4), {grey, grey, grey, grey, MaterialId(), grey}, 2);
  light(PointLight{"bulb", Vec3(2, 2, 2), room_.flat(1)});
  light(PointLight{"near the opening", Vec3(2, 2, 0.1), room_.flat(1)});
  light(SpotLight{"spot", Vec3(2, 3, 2), Vec3(0, -1, 0), room_.flat(1), 0.1, 0.3});
  EXPECT_THAT(warnings(), IsEmpty());
  room_ = RoomBuilder();
  const MaterialId ground = room_.material("ground", 0.5, 0, true);
  room_.quad(ground, {Vec3(0, 0, 0), Vec3(0, 0, 4), Vec3(4, 0, 4), Vec3(4, 0, 0)}, 2);
  light(PointLight{"lantern", Vec3(2, 2, 2), room_.flat(1)});
  EXPECT_THAT(warnings(), IsEmpty());
}

TEST_F(LuminaireLosses, LampsOnASurfaceAreNamed) {
  walls(true);
  light(PointLight{"bulb", Vec3(0, 1, 1), room_.flat(1)});
  const std::vector<OpeningLoss> found = losses();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].surface, SurfaceId(0));
  // Half of the sphere; 4096 stratified directions.
  EXPECT_NEAR(found[0].touching, 0.5, 0.02);
  EXPECT_EQ(found[0].lost, 0);
  EXPECT_THAT(warnings(), ElementsAre(AllOf(HasSubstr("'bulb'"), HasSubstr("lies in 'quad0'"))));
}

TEST_P(LuminaireLosses, LampsInAnEdgeOrACornerLightItAndLoseNothing) {
  walls(GetParam());
  light(PointLight{"edge", Vec3(0, 1, 0), room_.flat(1)});
  light(PointLight{"corner", Vec3(0, 3, 0), room_.flat(1)});
  light(SpotLight{"spot", Vec3(0, 1.5, 0), Vec3(0, -1, 0), room_.flat(1), 0.3, 1});
  const std::vector<OpeningLoss> found = losses();
  ASSERT_EQ(found.size(), 3u);
  EXPECT_NEAR(found[0].touching, 0.75, 0.02);
  EXPECT_NEAR(found[1].touching, 0.875, 0.02);
  EXPECT_NEAR(found[2].touching, 0.75, 0.02);
  for (const OpeningLoss& loss : found) EXPECT_EQ(loss.lost, 0);
}

TEST_F(LuminaireLosses, BacksFarAwayCountToo) {
  walls(true);
  const MaterialId paper = room_.material("paper", 0.5);
  // Looks up; the lamp below sees its back under the solid angle of a face of a cube about it.
  room_.quad(paper, {Vec3(1, 2, 1), Vec3(1, 2, 3), Vec3(3, 2, 3), Vec3(3, 2, 1)}, 2);
  light(PointLight{"bulb", Vec3(2, 1, 2), room_.flat(1)});
  ASSERT_EQ(losses().size(), 1u);
  EXPECT_NEAR(losses()[0].lost, 1.0 / 6, 0.023);  // 4 standard errors of 4096 independent directions
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("the back of 'quad6'")));
}

/// Of the lamps of a room.
std::vector<LampLoss> losses_of(const RoomBuilder& room) {
  const MeshResult meshed = room.mesh();
  const Room walls(room.scene(), meshed.mesh);
  const PacketRoom transport(walls);
  return lamp_losses(transport, collect_packet_sources(transport));
}

TEST_F(LuminaireLosses, ClosedLampsThatEmitInsideLightThemselvesByHalf) {
  walls(true);
  const MaterialId both = room_.material("both", 0.5, 10, true);
  room_.scene().materials[both.index()].emits_both_sides = true;
  const MaterialId outer = room_.material("outer", 0.5, 10, true);
  room_.shape(both, Sphere{Vec3(1, 1, 1), 0.3}, 2).shape(outer, Sphere{Vec3(3, 1, 1), 0.3}, 2);
  const std::vector<LampLoss> found = losses_of(room_);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].surfaces, ElementsAre(SurfaceId(6)));
  EXPECT_NEAR(found[0].onto_itself, 0.5, 1e-3);  // powers of both sides are equal; packets share them evenly
  EXPECT_THAT(warnings(), ElementsAre(AllOf(HasSubstr("'shape6'"), HasSubstr("50 %"))));
}

TEST_F(LuminaireLosses, OpalLampsThatEmitInsideLetMostOfItOut) {
  walls(true);
  const MaterialId both = room_.material("both", 0.2, 10, true);
  Material& opal = room_.scene().materials[both.index()];
  opal.emits_both_sides = true;
  opal.non_diffuse.diffuse_transmittance = room_.flat(0.6);
  room_.shape(both, Sphere{Vec3(1, 1, 1), 0.3}, 2);
  EXPECT_THAT(losses_of(room_), IsEmpty()) << "0.2 of its power stays inside";
  opal.non_diffuse.diffuse_transmittance = room_.flat(0.3);
  ASSERT_EQ(losses_of(room_).size(), 1u);
  EXPECT_NEAR(losses_of(room_)[0].onto_itself, 0.35, 1e-3);
}

TEST_F(LuminaireLosses, TheFacesOfABoxAreOneLamp) {
  walls(true);
  const MaterialId both = room_.material("both", 0.5, 10, true);
  room_.scene().materials[both.index()].emits_both_sides = true;
  room_.box(Vec3(1, 1, 1), Vec3(2, 2, 2), {both, both, both, both, both, both}, 2);
  const std::vector<LampLoss> found = losses_of(room_);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].surfaces.size(), 6u);
  EXPECT_NEAR(found[0].onto_itself, 0.5, 1e-3);
}

TEST_F(LuminaireLosses, RoomsWhoseWallsEmitAreNoLamps) {
  const MaterialId glowing = room_.material("glowing", 0.5, 10, true);
  room_.box(Vec3(0, 0, 0), Vec3(1, 1, 1), {glowing, glowing, glowing, glowing, glowing, glowing}, 2);
  EXPECT_THAT(losses_of(room_), IsEmpty());
}

/// A lamp of 1 m x 1 m that emits from the outer sides of all its faces.
void add_lamp(RoomBuilder& room, MaterialId glowing, double low, double high) {
  const Vec3 a(1, low, 1), b(2, low, 1), c(2, low, 2), d(1, low, 2);
  const Vec3 up(0, high - low, 0);
  for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, d), std::pair(d, a)})
    room.quad(glowing, {p, Vec3(p + up), Vec3(q + up), q}, 2);
  room.quad(glowing, {a, b, c, d}, 2);
  room.quad(glowing, {Vec3(a + up), Vec3(d + up), Vec3(c + up), Vec3(b + up)}, 2);
}

TEST_F(LuminaireLosses, LampsHalfSunkIntoTheCeilingAreNamed) {
  walls(true);
  add_lamp(room_, room_.material("glowing", 0.5, 10), 2.98, 3.02);
  const std::vector<LampLoss> found = losses_of(room_);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].stands_across);
  EXPECT_NEAR(found[0].outside, 0.48, 0.03);
  EXPECT_THAT(warnings(), ElementsAre(AllOf(HasSubstr("'quad6'"), HasSubstr("see nothing but the open"))));
}

TEST_F(LuminaireLosses, LampsInTheRoomAndOutdoorsAreNot) {
  walls(true);
  add_lamp(room_, room_.material("glowing", 0.5, 10), 2.9, 2.99);
  EXPECT_THAT(losses_of(room_), IsEmpty());
  // A lantern over a square.
  RoomBuilder outdoors;
  const MaterialId ground = outdoors.material("ground", 0.3);
  outdoors.quad(ground, {Vec3(-50, 0, -50), Vec3(-50, 0, 50), Vec3(50, 0, 50), Vec3(50, 0, -50)}, 2);
  add_lamp(outdoors, outdoors.material("lantern", 0.5, 10), 4, 4.5);
  EXPECT_THAT(losses_of(outdoors), IsEmpty());
}

TEST_P(LuminaireLosses, AreNotLookedForOnceSomebodyWaits) {
  walls(GetParam());
  light(troffer(Vec3(2, 3, 2)));
  const MeshResult meshed = room_.mesh();
  const Room walls(room_.scene(), meshed.mesh);
  const PacketRoom transport(walls);
  const std::atomic<bool> interrupt{true};
  const StopToken stop(interrupt);
  EXPECT_THROW(opening_losses(transport, &stop), Interrupted);
  EXPECT_THROW(luminaire_warnings(transport, collect_packet_sources(transport), &stop), Interrupted);
}

}  // namespace
}  // namespace reemit

#include "solver/losses/lost_light.h"

#include <array>
#include <atomic>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using test::RoomBuilder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A box of 4 m x 3 m x 4 m, reflectance 0.5, lit by its floor quad2; y is up.
class LostLight : public ::testing::Test {
 protected:
  LostLight() {
    const MaterialId grey = room_.material("grey", 0.5);
    const MaterialId lamp = room_.material("lamp", 0.5, 10);
    sides_ = {grey, grey, lamp, grey, grey, grey};
  }

  /// Quad of the ceiling between two x.
  void ceiling(double x0, double x1) {
    room_.quad(sides_[0], {Vec3(x0, 3, 0), Vec3(x1, 3, 0), Vec3(x1, 3, 4), Vec3(x0, 3, 4)}, 4);
  }
  void box(bool with_ceiling) {
    if (!with_ceiling) sides_[3] = MaterialId();
    room_.box(Vec3(0, 0, 0), Vec3(4, 3, 4), sides_, 4);
  }

  Solution solved(int threads = 1) const {
    SolverSettings settings;
    settings.packets = 1 << 16;
    settings.direct = DirectSource::kPackets;  // few packets are to find narrow gaps
    settings.threads = threads;
    const std::atomic<bool> interrupt = false;
    return solve(room_.scene(), room_.mesh(), settings, {}, interrupt);
  }
  std::vector<std::string> warnings() const { return solved().light_warnings; }
  static double escaped_share(const Solution& s) {
    return static_cast<double>(s.audit.bands[0].total_escaped()) /
           static_cast<double>(s.audit.bands[0].emitted);
  }

  RoomBuilder room_;
  std::array<MaterialId, 6> sides_;
};

TEST_F(LostLight, ATightRoomLosesNothing) {
  box(true);
  EXPECT_THAT(warnings(), IsEmpty());
}

TEST_F(LostLight, LuminairesThatLookAwayFromAllAreNamed) {
  // Over a floor that is open to all sides, a lamp that faces up.
  room_.quad(sides_[0], {Vec3(0, 0, 0), Vec3(0, 0, 4), Vec3(4, 0, 4), Vec3(4, 0, 0)}, 4);
  room_.quad(sides_[2], {Vec3(1, 1, 1), Vec3(1, 1, 2), Vec3(2, 1, 2), Vec3(2, 1, 1)}, 2);
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("no light meets a surface")));
}

TEST_F(LostLight, AGapIsNamedWithItsPlaceAndShare) {
  box(false);
  ceiling(0, 1);
  ceiling(1.004, 4);
  const Solution solution = solved();
  const double share = escaped_share(solution);
  EXPECT_GT(share, 2e-4);
  EXPECT_LT(share, 4e-3);
  EXPECT_THAT(solution.light_warnings,
              ElementsAre(AllOf(HasSubstr("leaves the room, whose faces nearly close"),
                                HasSubstr("gap of about"), HasSubstr("'quad5' and 'quad6'"))));
  const Room walls(room_.scene(), solution.mesh);
  const PacketRoom transport(walls);
  const EscapedLight found = find_escapes(transport, collect_packet_sources(transport), solution);
  // The ends of the slit may count as wider, and the share is that of some 2^17 probes.
  EXPECT_NEAR(found.through_gaps, share, 0.3 * share);
  ASSERT_FALSE(found.places.empty());
  for (const LightLoss& place : found.places) {
    EXPECT_EQ(place.way, LightLoss::Way::kGap);
    EXPECT_NEAR(place.place.x(), 1.002, 0.01);
    EXPECT_NEAR(place.place.y(), 3, 0.01);
    EXPECT_LT(place.width, 0.04);
  }
}

TEST_F(LostLight, ALuminaireThatShinesOutOfTheRoomItselfIsNamedAsOne) {
  box(true);
  room_.quad(sides_[2],
             {Vec3(1, -0.001, 1), Vec3(1.1, -0.001, 1), Vec3(1.1, -0.001, 1.1), Vec3(1, -0.001, 1.1)}, 1);
  EXPECT_THAT(warnings(),
              ElementsAre(AllOf(HasSubstr("whose faces nearly close"),
                                HasSubstr("a luminaire (does it lie in a face, or behind one?)"))));
}

TEST_F(LostLight, AnOpenRoomIsNoLeak) {
  box(false);
  const Solution solution = solved();
  EXPECT_GT(escaped_share(solution), 0.3);
  EXPECT_THAT(solution.light_warnings, IsEmpty());
}

TEST_F(LostLight, ASkylightIsNoLeak) {
  box(false);
  ceiling(0, 1);
  ceiling(2, 4);
  EXPECT_GT(escaped_share(solved()), 0.05);
  EXPECT_THAT(warnings(), IsEmpty());
}

/// A ceiling whose part from x = 1 to 2 is of such a window, and that has a gap if `gap` is not 0.
class LostLightBesideWindows : public LostLight {
 protected:
  void window(const Material& material, double gap) {
    box(false);
    ceiling(0, 1 - gap);
    ceiling(2, 4);
    room_.scene().materials.push_back(material);
    const MaterialId pane(room_.scene().materials.size() - 1);
    room_.quad(pane, {Vec3(1, 3, 0), Vec3(2, 3, 0), Vec3(2, 3, 4), Vec3(1, 3, 4)}, 4);
  }
  Material grey() const { return room_.scene().materials[sides_[0].index()]; }
};

TEST_F(LostLightBesideWindows, WhatGoesOutThroughThemIsMeantTo) {
  Material glass = grey();
  glass.two_sided = true;
  glass.reflectance = Spectrum::Zero(1);
  Material clear = glass;
  clear.non_diffuse.specular_transmittance = Spectrum::Constant(1, 0.9);
  Material opal = glass;
  opal.non_diffuse.diffuse_transmittance = Spectrum::Constant(1, 0.5);
  Material lace = glass;
  lace.textures.opacity_factor = 0.5;
  for (const Material& material : {clear, opal, lace}) {
    room_ = RoomBuilder();
    const MaterialId wall = room_.material("grey", 0.5);
    const MaterialId lamp = room_.material("lamp", 0.5, 10);
    sides_ = {wall, wall, lamp, wall, wall, wall};
    window(material, 0);
    const Solution solution = solved();
    EXPECT_GT(escaped_share(solution), 0.02);
    EXPECT_THAT(solution.light_warnings, IsEmpty());
  }
}

TEST_F(LostLightBesideWindows, GapsAreNamedAllTheSame) {
  Material lace = grey();
  lace.two_sided = true;
  lace.textures.opacity_factor = 0.5;
  window(lace, 0.004);
  EXPECT_THAT(warnings(), ElementsAre(AllOf(HasSubstr("leaves the room"), HasSubstr("gap of about"))));
}

TEST_F(LostLight, ALittleLightOnTheBackOfALampIsNoMistake) {
  box(true);
  const MaterialId panel = room_.material("panel", 0, 10);
  room_.quad(panel, {Vec3(1, 2.98, 1), Vec3(2, 2.98, 1), Vec3(2, 2.98, 2), Vec3(1, 2.98, 2)}, 4);
  const Solution solution = solved();
  double on_backs = 0;
  for (const RunQuanta quanta : solution.audit.bands[0].absorbed_on_backs)
    on_backs += static_cast<double>(quanta);
  EXPECT_GT(on_backs, 0);
  EXPECT_THAT(solution.light_warnings, IsEmpty());
}

TEST_F(LostLight, LightThatStartsOutsideIsNamed) {
  box(true);
  const MaterialId both = room_.material("both", 0.5, 2, true);
  room_.scene().materials[both.index()].emits_both_sides = true;
  // Reaches through the wall x = 4: the outer part shines into the open.
  room_.quad(both, {Vec3(3.6, 1, 1), Vec3(4.4, 1, 1), Vec3(4.4, 1, 2), Vec3(3.6, 1, 2)}, 4);
  EXPECT_THAT(warnings(), ElementsAre(AllOf(HasSubstr("leaves the room"), HasSubstr("'quad6'")),
                                      AllOf(HasSubstr("ends on backs"), HasSubstr("'quad1'"))));
}

TEST_F(LostLight, BacksThatTakeLightAreNamedWithTheirShare) {
  box(true);
  room_.quad(sides_[0], {Vec3(1, 2, 1), Vec3(1, 2, 3), Vec3(3, 2, 3), Vec3(3, 2, 1)}, 2);  // looks up
  const Solution solution = solved();
  const double share = static_cast<double>(solution.audit.bands[0].absorbed_on_backs[6]) /
                       static_cast<double>(solution.audit.bands[0].emitted);
  EXPECT_THAT(solution.light_warnings,
              ElementsAre(AllOf(HasSubstr("ends on backs of one-sided faces"), HasSubstr("'quad6'"),
                                HasSubstr(fmt::format("{:.3g} %", 100 * share)), HasSubstr("from 'quad2'"),
                                HasSubstr("--two-sided"))));
}

TEST_F(LostLight, WarningsDoNotDependOnThreads) {
  box(false);
  ceiling(0, 1);
  ceiling(1.004, 4);
  EXPECT_EQ(solved(1).light_warnings, solved(2).light_warnings);
}

TEST_F(LostLight, IsNotLookedForOnceSomebodyWaits) {
  box(false);
  ceiling(0, 1);
  ceiling(1.004, 4);
  const Solution solution = solved();
  const Room walls(room_.scene(), solution.mesh);
  const PacketRoom transport(walls);
  const PacketSources emission = collect_packet_sources(transport);
  const std::atomic<bool> interrupt{true};
  const StopToken stop(interrupt);
  EXPECT_THROW(find_escapes(transport, emission, solution, &stop), Interrupted);
  EXPECT_THROW(lost_light_warnings(transport, emission, solution, &stop), Interrupted);
}

}  // namespace
}  // namespace reemit

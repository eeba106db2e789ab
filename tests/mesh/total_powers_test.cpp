#include "mesh/zones/total_powers.h"

#include <gtest/gtest.h>

#include "tests/mesh/test_room.h"

namespace reemit {
namespace {

using test::floor_rectangle;
using test::TestRoom;

/// A closed room of 4 m x 3 m x 5 m with lamps of one material, whose power is 1 W as it was read.
class TotalPowers : public ::testing::Test {
 protected:
  TotalPowers() { room_.box("walls", room_.material(), Vec3(0, 0, 0), Vec3(4, 3, 5), true); }

  void lamp(const std::vector<Vec3>& outline, double area) {
    if (!lamp_.valid()) lamp_ = room_.material(true, 1);
    room_.polygon("lamp", lamp_, outline);
    read_ += area;
  }
  /// Power that the meshed surfaces send [W].
  double power() {
    Material& material = room_.scene().materials[lamp_.index()];
    material.area_of_total_power = read_ * (material.emits_both_sides ? 2 : 1);
    material.emitted_radiance *= 1 / (material.exitance()[0] * material.area_of_total_power);
    const auto [mesh, report] = build_mesh(room_.scene());
    spread_total_powers(report, mesh, room_.scene());
    const Spectrum once = material.emitted_radiance;
    spread_total_powers(report, mesh, room_.scene());
    EXPECT_EQ(once[0], material.emitted_radiance[0]);
    double meshed = 0;
    for (std::size_t s = 1; s < report.surfaces.size(); ++s) meshed += report.surfaces[s].meshed;
    return material.exitance()[0] * meshed * (material.emits_both_sides ? 2 : 1);
  }

  TestRoom room_;
  MaterialId lamp_;
  double read_ = 0;  // area [m2]
};

TEST_F(TotalPowers, StayWhereMeshingTakesNothing) {
  lamp(floor_rectangle(1, 1, 2, 2, 2), 1);
  EXPECT_NEAR(power(), 1, 1e-12);
}

TEST_F(TotalPowers, LeaveLampsOfGivenRadianceAlone) {
  lamp(floor_rectangle(1, 1, 2, 2, 2), 1);
  lamp(floor_rectangle(1.5, 1, 2.5, 2, 2), 1);
  const double before = room_.scene().materials[lamp_.index()].emitted_radiance[0];
  const auto [mesh, report] = build_mesh(room_.scene());
  spread_total_powers(report, mesh, room_.scene());
  EXPECT_EQ(room_.scene().materials[lamp_.index()].emitted_radiance[0], before);
  EXPECT_GT(before, 0);
}

TEST_F(TotalPowers, GoToWhatIsLeftOfLampsThatOverlap) {
  lamp(floor_rectangle(1, 1, 2, 2, 2), 1);
  lamp(floor_rectangle(1.5, 1, 2.5, 2, 2), 1);
  EXPECT_NEAR(power(), 1, 1e-9);
}

TEST_F(TotalPowers, GoToBothSidesOfALampThatIsThereTwice) {
  lamp(floor_rectangle(1, 1, 2, 2, 2), 1);
  lamp(floor_rectangle(1, 1, 2, 2, 2), 1);
  room_.scene().materials[lamp_.index()].emits_both_sides = true;
  EXPECT_NEAR(power(), 1, 1e-9);
}

TEST_F(TotalPowers, GoToWhatIsThereOfCutOuts) {
  lamp(floor_rectangle(1, 1, 2, 2, 2), 1);
  Material& material = room_.scene().materials[lamp_.index()];
  material.area_of_total_power = 1;
  auto [mesh, report] = build_mesh(room_.scene());
  std::vector<float> solid;
  for (std::size_t z = 0; z < mesh.zone_count(); ++z)
    solid.push_back(mesh.zone_surface(ZoneId(z)).index() == 0 ? 1.0F : 0.25F);
  mesh.set_solid_shares(solid);
  const Spectrum before = material.emitted_radiance;
  spread_total_powers(report, mesh, room_.scene());
  EXPECT_NEAR(material.emitted_radiance[0], 4 * before[0], 1e-9 * before[0]);
  EXPECT_NEAR(material.area_of_total_power, 0.25, 1e-9);
}

}  // namespace
}  // namespace reemit

#include "solver/solution/solution.h"

#include <cmath>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "solver/solution/opposite_zones.h"
#include "tests/solver/solution/sample_solution.h"

namespace reemit {
namespace {

struct Batch {
  double direct = 0;
  double indirect = 0;
  std::int64_t weight = 1;
};

// A solution whose zone 0 saw the given irradiances.
Solution with_batches(const std::vector<Batch>& batches) {
  Solution s = test::sample_solution(BandSet::grey());
  ZoneSums& sums = s.sums;
  sums.clear(s.mesh.zone_count(), Channels(1), false);
  for (const Batch& batch : batches) {
    sums.count_batch(batch.weight);
    const auto w = static_cast<double>(batch.weight);
    sums.direct[0] += w * batch.direct;
    sums.direct_cross[0] += w * w * batch.direct;
    sums.direct_squared[0] += std::pow(w * batch.direct, 2);
    sums.indirect[0] += w * batch.indirect;
    sums.indirect_cross[0] += w * w * batch.indirect;
    sums.indirect_squared[0] += std::pow(w * batch.indirect, 2);
    sums.total_squared[0] += std::pow(w * (batch.direct + batch.indirect), 2);
  }
  return s;
}

TEST(SolutionEstimates, WeighBatchesBySize) {
  const Solution s = with_batches({{1, 0, 1}, {4, 0, 2}, {3, 0, 1}});
  // Mean 12/4 = 3; deviations -2 1 0, squared with the squares of the weights 4 + 4; 16 - 6 = 10.
  EXPECT_DOUBLE_EQ(s.direct_irradiance(ZoneId(0), 0).mean, 3);
  EXPECT_DOUBLE_EQ(s.direct_irradiance(ZoneId(0), 0).stderr_of_mean, std::sqrt(8.0 / 10));
  EXPECT_DOUBLE_EQ(s.irradiance(ZoneId(0), 0).stderr_of_mean, std::sqrt(8.0 / 10));
  EXPECT_DOUBLE_EQ(s.sums.degrees_of_freedom(), 16.0 / 6 - 1);
}

TEST(SolutionEstimates, AreBatchMeans) {
  const Solution s = with_batches({{1, 2}, {3, 6}, {5, 1}});
  const ZoneId z(0);
  EXPECT_DOUBLE_EQ(s.direct_irradiance(z, 0).mean, 3);
  EXPECT_DOUBLE_EQ(s.indirect_irradiance(z, 0).mean, 3);
  EXPECT_DOUBLE_EQ(s.irradiance(z, 0).mean, 6);
  // Deviations -2 0 2; -1 3 -2; -3 3 0: sums of squares 8, 14, 18; n(n-1) = 6.
  EXPECT_DOUBLE_EQ(s.direct_irradiance(z, 0).stderr_of_mean, std::sqrt(8.0 / 6));
  EXPECT_DOUBLE_EQ(s.indirect_irradiance(z, 0).stderr_of_mean, std::sqrt(14.0 / 6));
  EXPECT_DOUBLE_EQ(s.irradiance(z, 0).stderr_of_mean, std::sqrt(18.0 / 6));
}

TEST(SolutionEstimates, EqualBatchesHaveNoErrorInsteadOfNaN) {
  const Solution s = with_batches({{0.1, 0.7}, {0.1, 0.7}, {0.1, 0.7}});
  EXPECT_NEAR(s.irradiance(ZoneId(0), 0).stderr_of_mean, 0, 1e-7);  // sqrt of rounding
  EXPECT_EQ(s.irradiance(ZoneId(1), 0).mean, 0);
  EXPECT_EQ(s.irradiance(ZoneId(1), 0).stderr_of_mean, 0);
}

TEST(SolutionEstimates, OneBatchSaysNothingAboutItsError) {
  const Solution s = with_batches({{1, 2}});
  EXPECT_EQ(s.irradiance(ZoneId(0), 0).mean, 3);
  EXPECT_EQ(s.irradiance(ZoneId(0), 0).stderr_of_mean, std::numeric_limits<double>::infinity());
}

TEST(SolutionEstimates, NoBatchIsExactlyDark) {
  const Solution s = with_batches({});
  EXPECT_EQ(s.irradiance(ZoneId(0), 0).mean, 0);
  EXPECT_EQ(s.irradiance(ZoneId(0), 0).stderr_of_mean, 0);
}

TEST(SolutionEstimates, RadiosityIsEmissionPlusReflection) {
  const Solution s = with_batches({{1, 2}, {3, 6}});
  const Estimate b = s.radiosity(ZoneId(0), 0);
  const double reflectance = s.materials[0].reflectance[0];
  EXPECT_DOUBLE_EQ(b.mean, reflectance * 6);
  EXPECT_DOUBLE_EQ(b.stderr_of_mean, reflectance * s.irradiance(ZoneId(0), 0).stderr_of_mean);
  const ZoneId lamp(s.mesh.zone_count() - 1);
  EXPECT_DOUBLE_EQ(s.radiosity(lamp, 0).mean, std::numbers::pi * s.materials[1].emitted_radiance[0]);
}

TEST(SolutionEstimates, OpalSheetsSendOnWhatArrivesBehindThem) {
  Solution s = with_batches({{1, 2}, {3, 6}});
  s.materials[0].non_diffuse.diffuse_transmittance = Spectrum::Constant(1, 0.2);
  // Cell 0 of the front lies before cell 0 of the back.
  const ZoneId back = s.mesh.first_zone(TriangleId(0), false);
  EXPECT_NEAR(s.radiosity(back, 0).mean, 0.2 * 6, 1e-12);
  EXPECT_NEAR(s.radiosity(back, 0).stderr_of_mean, 0.2 * s.irradiance(ZoneId(0), 0).stderr_of_mean, 1e-12);
  EXPECT_NEAR(s.radiosity(ZoneId(0), 0).mean, s.materials[0].reflectance[0] * 6, 1e-12);
}

TEST(OppositeZones, ShareTheAreaOfAZone) {
  BaseMesh base;
  base.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  base.triangles = {BaseTriangle{{0, 1, 2}, {}, SurfaceId(0), 0, 2, true},
                    BaseTriangle{{0, 2, 3}, {}, SurfaceId(0), 0, 2, true}};
  for (BaseTriangle& t : base.triangles) t.normal.fill(BaseTriangle::kFlat);
  // The two fronts are one zone, the backs have four cells each.
  ZoneGroups groups;
  groups.count = 1;
  groups.of_side = {0, ZoneGroups::kOwn, 0, ZoneGroups::kOwn};
  const ZoneMesh mesh(std::move(base), std::move(groups));
  const std::vector<ZoneShare> behind = opposite_zones(mesh, mesh.first_zone(TriangleId(0), true));
  ASSERT_EQ(behind.size(), 8U);
  for (const ZoneShare& b : behind) EXPECT_NEAR(b.share, 0.125, 1e-12);
  const std::vector<ZoneShare> before = opposite_zones(mesh, mesh.first_zone(TriangleId(1), false));
  ASSERT_EQ(before.size(), 1U);
  EXPECT_TRUE(mesh.is_group(before[0].zone));
  EXPECT_NEAR(before[0].share, 1, 1e-12);
}

TEST(SolutionEstimates, OnlyMarkedMaterialsEmitFromTheBack) {
  Solution s = test::sample_solution(BandSet::grey());
  s.materials[0].emitted_radiance[0] = 2;
  const ZoneId front = s.mesh.first_zone(TriangleId(0), true);
  const ZoneId back = s.mesh.first_zone(TriangleId(0), false);
  EXPECT_DOUBLE_EQ(s.emitted_radiosity(front, 0), 2 * std::numbers::pi);
  EXPECT_EQ(s.emitted_radiosity(back, 0), 0);
  s.materials[0].emits_both_sides = true;
  EXPECT_DOUBLE_EQ(s.emitted_radiosity(back, 0), 2 * std::numbers::pi);
}

TEST(SolutionEstimates, BlackZonesAreExact) {
  Solution s = with_batches({{1, 2}});
  s.materials[0].reflectance[0] = 0;
  EXPECT_EQ(s.radiosity(ZoneId(0), 0).stderr_of_mean, 0);
}

TEST(StopReasons, HaveDifferentWords) {
  std::set<std::string> words;
  for (const StopReason reason :
       {StopReason::kErrorTarget, StopReason::kTimeLimit, StopReason::kPacketCount, StopReason::kInterrupted,
        StopReason::kNoLuminaire, StopReason::kBatchLimit})
    words.insert(to_string(reason));
  EXPECT_EQ(words.size(), 6U);
  EXPECT_FALSE(words.contains("unknown"));
}

}  // namespace
}  // namespace reemit

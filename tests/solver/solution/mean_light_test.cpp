// Are the means over surfaces and materials those of their zones, and do their error bars tell how far the
// means stray from seed to seed?

#include "solver/solution/mean_light.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "solver/shoot/packet_batch.h"
#include "solver/tally/batch_statistics.h"
#include "tests/support/hand_made_solution.h"
#include "tests/support/test_rooms.h"

namespace reemit::test {
namespace {

/// A box of two materials with a small lamp under its ceiling, and a two-sided plate out of its sight.
/// Everything is grey, so the errors of the bands go together.
class LitBox {
 public:
  LitBox() {
    const MaterialId white = room_.material("white", 0.7);
    const MaterialId grey = room_.material("grey", 0.3);
    const MaterialId lamp = room_.material("lamp", 0.0, 40.0);
    const MaterialId plate = room_.material("plate", 0.5, 0.0, true);
    room_.box(Vec3::Zero(), {1, 1, 1}, {white, white, grey, white, grey, white}, 4);
    room_.quad(lamp, {Vec3(0.3, 0.3, 0.9), {0.3, 0.6, 0.9}, {0.6, 0.6, 0.9}, {0.6, 0.3, 0.9}}, 2);
    room_.quad(plate, {Vec3(0, 0, -1), {1, 0, -1}, {1, 1, -1}, {0, 1, -1}}, 1);
    mesh_ = room_.mesh().mesh;
    walls_.emplace(room_.scene(), mesh_);
    transport_.emplace(*walls_);
    emission_ = collect_packet_sources(*transport_);
  }

  /// Batches of these weights, as `solve` runs them.
  Solution run(std::uint64_t seed, const std::vector<std::int64_t>& weights) const {
    constexpr std::uint32_t kPackets = 256;
    Solution solution;
    solution.bands = room_.scene().bands;
    keep_surfaces(room_.scene(), solution);
    solution.mesh = mesh_;
    solution.sums.clear(mesh_.zone_count(), Channels(3), false);
    SolverSettings settings;
    settings.seed = seed;
    BatchBooks books = transport_->new_books();
    tbb::task_arena arena(1);  // the work is small
    arena.execute([&] {
      for (std::size_t k = 0; k < weights.size(); ++k) {
        books.clear();
        shoot_batch({*transport_, emission_, settings, static_cast<std::uint32_t>(k),
                     kPackets * static_cast<std::uint32_t>(weights[k])},
                    books);
        add_batch(mesh_, books, emission_.watts_per_quantum, weights[k], solution.sums);
      }
    });
    return solution;
  }

 private:
  RoomBuilder room_{BandSet::rgb()};
  ZoneMesh mesh_{BaseMesh{}};
  std::optional<Room> walls_;
  std::optional<PacketRoom> transport_;
  PacketSources emission_{Channels(3)};
};

/// Twenty batches, the last four as large as five others: groups of unequal weight.
std::vector<std::int64_t> unequal_batches() {
  std::vector<std::int64_t> weights(16, 1);
  weights.insert(weights.end(), 4, 5);
  return weights;
}

double lux(const Solution& solution, ZoneId z) {
  double sum = 0;
  for (std::size_t b = 0; b < 3; ++b)
    sum += solution.irradiance(z, b).mean * solution.bands.efficacy_lm_per_w()[static_cast<Eigen::Index>(b)];
  return sum;
}

TEST(MeanLight, IsTheAreaWeightedMeanOfTheZones) {
  const Solution solution = LitBox().run(1, unequal_batches());
  const RoomLight light = mean_light(solution);
  ASSERT_EQ(light.sides.size(), 9U) << "fronts of eight surfaces and the back of the screen";
  ASSERT_EQ(light.materials.size(), 4U);
  double grey_flux = 0;
  double grey_area = 0;
  for (const SideLight& side : light.sides) {
    double area = 0;
    double flux = 0;
    double leaving = 0;
    for (std::size_t i = 0; i < solution.mesh.zone_count(); ++i) {
      const ZoneId z(i);
      if (solution.mesh.zone_surface(z) != side.surface || solution.mesh.zone_is_front(z) != side.front)
        continue;
      const double a = solution.mesh.zone_area(z);
      area += a;
      flux += a * lux(solution, z);
      for (std::size_t b = 0; b < 3; ++b)
        leaving += a * solution.radiosity(z, b).mean *
                   solution.bands.efficacy_lm_per_w()[static_cast<Eigen::Index>(b)];
    }
    EXPECT_NEAR(side.light.area, area, 1e-12);
    EXPECT_NEAR(side.light.illuminance.mean, flux / area, 1e-9 * flux / area);
    EXPECT_NEAR(side.light.luminous_exitance.mean, leaving / area, 1e-9 * leaving / area);
    if (solution.surface_materials[side.surface.index()] == MaterialId(1)) {
      grey_flux += flux;
      grey_area += area;
    }
  }
  EXPECT_NEAR(light.materials[1].area, grey_area, 1e-12);
  EXPECT_NEAR(light.materials[1].illuminance.mean, grey_flux / grey_area, 1e-9 * grey_flux / grey_area);
  // The lamp reflects nothing: what it sends is known exactly.
  EXPECT_NEAR(light.materials[2].exitance[0].mean, 40, 1e-9);
  EXPECT_EQ(light.materials[2].exitance[0].stderr_of_mean, 0);
  EXPECT_NEAR(light.degrees_of_freedom, 36.0 * 36.0 / (4 * 36 + 12) - 1, 1e-9);
}

/// Squared spread over seeds of the illuminance of every side and material over what `error2_of` states, the
/// mean of both over all.
struct Calibration {
  double worst_low = 1;
  double worst_high = 1;
  double mean = 0;
};

template <class Error>
Calibration calibrate(const std::vector<std::vector<Estimate>>& runs, Error&& error2_of) {
  Calibration result;
  const std::size_t quantities = runs.front().size();
  for (std::size_t q = 0; q < quantities; ++q) {
    double mean = 0;
    double stated = 0;
    for (std::size_t r = 0; r < runs.size(); ++r) {
      mean += runs[r][q].mean / static_cast<double>(runs.size());
      stated += error2_of(r, q) / static_cast<double>(runs.size());
    }
    double spread = 0;
    for (const auto& run : runs)
      spread += std::pow(run[q].mean - mean, 2) / static_cast<double>(runs.size() - 1);
    const double ratio = stated / spread;
    result.worst_low = std::min(result.worst_low, ratio);
    result.worst_high = std::max(result.worst_high, ratio);
    result.mean += ratio / static_cast<double>(quantities);
  }
  return result;
}

TEST(MeanLight, ErrorsAreThoseOfTheSpreadOverSeeds) {
  constexpr std::size_t kSeeds = 200;
  const LitBox room;
  std::vector<std::vector<Estimate>> runs;
  std::vector<std::vector<double>> independent;  // squared errors if zones and bands had nothing in common
  for (std::size_t seed = 0; seed < kSeeds; ++seed) {
    const Solution solution = room.run(seed + 1, unequal_batches());
    const RoomLight light = mean_light(solution);
    std::vector<Estimate>& run = runs.emplace_back();
    std::vector<double>& apart = independent.emplace_back();
    for (std::size_t s = 0; s < 6; ++s) {
      run.push_back(light.sides[s].light.illuminance);
      double variance = 0;
      for (std::size_t i = 0; i < solution.mesh.zone_count(); ++i) {
        const ZoneId z(i);
        if (solution.mesh.zone_surface(z) != SurfaceId(s)) continue;
        for (std::size_t b = 0; b < 3; ++b)
          variance += std::pow(solution.mesh.zone_area(z) * solution.irradiance(z, b).stderr_of_mean *
                                   solution.bands.efficacy_lm_per_w()[static_cast<Eigen::Index>(b)],
                               2);
      }
      apart.push_back(variance / std::pow(light.sides[s].light.area, 2));
    }
    for (const std::size_t m : {0, 1}) {
      run.push_back(light.materials[m].illuminance);
      run.push_back(light.materials[m].luminous_exitance);
    }
  }
  // A quotient of variances of 1460 and 199 degrees of freedom: relative deviation 0.11; five of them.
  const Calibration found =
      calibrate(runs, [&](std::size_t r, std::size_t q) { return std::pow(runs[r][q].stderr_of_mean, 2); });
  EXPECT_GT(found.worst_low, 0.6);
  EXPECT_LT(found.worst_high, 1.6);
  EXPECT_NEAR(found.mean, 1, 0.2);

  // A sum over zones as if they were independent would not have passed.
  for (auto& run : runs) run.resize(6);
  const Calibration apart = calibrate(runs, [&](std::size_t r, std::size_t q) { return independent[r][q]; });
  EXPECT_GT(std::fabs(apart.mean - 1), 0.4) << "this room cannot tell the two";
}

TEST(MeanLight, OneBatchSaysNothingAboutItsErrorAndNoneIsExactDarkness) {
  const RoomLight one = mean_light(LitBox().run(1, {1}));
  EXPECT_TRUE(std::isinf(one.sides.front().light.illuminance.stderr_of_mean));
  EXPECT_EQ(one.degrees_of_freedom, 0);
  const RoomLight none = mean_light(LitBox().run(1, {}));
  EXPECT_EQ(none.sides.front().light.illuminance.mean, 0);
  EXPECT_EQ(none.sides.front().light.illuminance.stderr_of_mean, 0);
}

// What no packet met is not known to be dark: one packet might have come.
TEST(MeanLight, TheVarianceIsThatOfOneMorePacketThanCame) {
  Solution solution = LitBox().run(1, unequal_batches());
  const RoomLight spread = mean_light(solution);  // of batches alone: it knows of no packets
  solution.record.packets = 1000;
  solution.record.rays = 5000;
  double power = 0;
  for (std::size_t z = 0; z < solution.mesh.zone_count(); ++z)
    power += solution.mesh.zone_area(ZoneId(z)) * solution.irradiance(ZoneId(z), 1).mean;
  const RoomLight light = mean_light(solution);
  for (std::size_t s = 0; s < light.sides.size(); ++s) {
    const Estimate& of_batches = spread.sides[s].light.irradiance[1];
    const Estimate& e = light.sides[s].light.irradiance[1];
    const double of_one = power / 5000 / light.sides[s].light.area;
    EXPECT_EQ(e.mean, of_batches.mean);
    EXPECT_NEAR(e.stderr_of_mean, std::hypot(of_batches.stderr_of_mean, of_one), 1e-12 * e.stderr_of_mean);
  }
  // What was gathered has errors of its own.
  for (std::size_t z = 0; z < solution.mesh.zone_count(); ++z) solution.gathered.zones.emplace_back(z);
  const RoomLight gathered = mean_light(solution);
  for (std::size_t s = 0; s < gathered.sides.size(); ++s)
    EXPECT_EQ(gathered.sides[s].light.illuminance.stderr_of_mean,
              spread.sides[s].light.illuminance.stderr_of_mean);
}

TEST(MeanLight, DarkSidesCountOnlyWhereNothingIsLit) {
  const RoomLight light = mean_light(LitBox().run(1, {1, 1}));
  const std::span last_two = std::span(light.sides).last(2);
  EXPECT_TRUE(last_two[0].front && last_two[0].counts)
      << "in the dark on both sides: its front stands for it";
  EXPECT_FALSE(last_two[1].front || last_two[1].counts);
  EXPECT_NEAR(light.materials[3].area, 1, 1e-12);

  // Walls that reflect on both sides: light reaches the inside only.
  RoomBuilder room;
  const MaterialId wall = room.material("wall", 0.5, 0.0, true);
  room.box(Vec3::Zero(), {1, 1, 1}, {wall, wall, wall, wall, wall, wall}, 1);
  Solution solution = dark_solution(room);
  keep_surfaces(room.scene(), solution);
  for (std::size_t z = 0; z < solution.mesh.zone_count(); ++z)
    if (solution.mesh.zone_is_front(ZoneId(z))) solution.sums.direct[z] = 2;
  const RoomLight walls = mean_light(solution);
  ASSERT_EQ(walls.sides.size(), 12U);
  for (const SideLight& side : walls.sides) EXPECT_EQ(side.counts, side.front);
  EXPECT_NEAR(walls.materials[0].area, 6, 1e-12);
  EXPECT_NEAR(walls.materials[0].irradiance[0].mean, 2, 1e-12);
  EXPECT_NEAR(walls.materials[0].exitance[0].mean, 1, 1e-12);
}

}  // namespace
}  // namespace reemit::test

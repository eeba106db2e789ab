// Two lamps as two light groups: what each brings against a room with that lamp alone.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "scenes/model/bands.h"
#include "solver/gather/radiance_field.h"
#include "solver/progressive_solver.h"
#include "solver/reflect/lambert.h"
#include "solver/shoot/packet_batch.h"
#include "solver/tally/batch_statistics.h"
#include "tests/solver/shoot/methods.h"
#include "tests/support/mean_test.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using test::rgb;
using test::RoomBuilder;

constexpr std::size_t kBands = 3;
constexpr std::size_t kQuads = 6;
constexpr std::size_t kLamps[] = {0, 4};  // quads
constexpr std::uint32_t kDivisions = 4;
constexpr std::size_t kZonesPerQuad = std::size_t{2} * kDivisions * kDivisions;

/// A coloured box; the lamps that are off reflect all the same.
RoomBuilder box_with(bool first, bool second) {
  RoomBuilder room(BandSet::rgb());
  const Spectrum off = rgb(0, 0, 0);
  const MaterialId red = room.material("red lamp", rgb(0.2, 0.3, 0.4), first ? rgb(10, 5, 1) : off);
  const MaterialId blue = room.material("blue lamp", rgb(0.3, 0.2, 0.5), second ? rgb(0.5, 2, 6) : off);
  const MaterialId wall = room.material("wall", rgb(0.8, 0.5, 0.2), off);
  const MaterialId floor = room.material("floor", rgb(0.1, 0.6, 0.7), off);
  room.box(Vec3::Zero(), Vec3(1, 1, 1), {red, wall, wall, floor, blue, wall}, kDivisions);
  return room;
}

SolverSettings seeded_settings(SolveMethod method, std::uint64_t seed) {
  SolverSettings settings;
  settings.method = method;
  settings.packets = method == SolveMethod::kShooting ? 640'000 : 1'600'000;  // walks are noisier
  settings.batch_packets = settings.packets / 32;
  settings.seed = seed;
  settings.threads = 2;
  return settings;
}

/// What `solve` does, with the second lamp as a group of its own.
Solution solve_in_groups(const RoomBuilder& room, const SolverSettings& settings) {
  Solution solution = new_solution(room.scene(), room.mesh(), settings);
  const Room walls(room.scene(), solution.mesh);
  const PacketSources together = collect_packet_sources(PacketRoom(walls));
  std::vector<PacketSource> sources = together.sources;
  std::vector<double> watts;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    sources[s].group = solution.mesh.zone_surface(sources[s].zone) == SurfaceId(kLamps[1]) ? 1 : 0;
    for (std::size_t b = 0; b < kBands; ++b)
      watts.push_back(static_cast<double>(together.quanta_of(s)[b]) * together.watts_per_quantum[b]);
  }
  const Channels channels(kBands, 2);
  const PacketRoom transport(walls, channels);
  const PacketSources emission = make_packet_sources(sources, watts, channels);
  solution.sums.clear(solution.mesh.zone_count(), channels, false);
  solution.audit.bands.resize(channels.count(), solution.audit.bands[0]);
  BatchBooks books = transport.new_books();
  tbb::task_arena arena(settings.threads);
  arena.execute([&] {
    for (std::uint32_t k = 0; k < settings.packets / settings.batch_packets; ++k) {
      books.clear();
      const BatchTask task{transport, emission, settings, k,
                           static_cast<std::uint32_t>(settings.batch_packets)};
      settings.method == SolveMethod::kShooting ? shoot_batch(task, books) : walk_batch(task, books);
      add_batch(solution.mesh, books, emission.watts_per_quantum, 1, solution.sums);
      add_batch(books, 1, solution.audit);  // throws unless every channel balances
    }
  });
  return solution;
}

/// Mean irradiance of a quad in some channels together, by groups of batches.
test::MeanTest mean_of_quad(const ZoneSums& sums, std::size_t quad,
                            const std::vector<std::size_t>& channels) {
  test::MeanTest mean;
  for (std::size_t g = 0; g < ZoneSums::kGroups; ++g) {
    double sum = 0;
    for (std::size_t z = quad * kZonesPerQuad; z < (quad + 1) * kZonesPerQuad; ++z)
      for (const std::size_t c : channels)
        sum += static_cast<double>(sums.group_total[g * sums.direct.size() + z * sums.channels.count() + c]);
    mean.add(sum / static_cast<double>(kZonesPerQuad) / static_cast<double>(sums.group_weight[g]));
  }
  return mean;
}

void expect_same(const test::MeanTest& a, const test::MeanTest& b, const std::string& what) {
  const double error = std::hypot(a.standard_error(), b.standard_error());
  EXPECT_NEAR(a.mean(), b.mean(), 5 * error) << what;
  EXPECT_GT(0.02 * b.mean(), 5 * error) << "a bias of 2 % would go unseen: " << what;
}

// Five standard errors of 30 degrees of freedom are passed once in 40,000 comparisons, of which there are
// 108.
TEST(LightGroups, EachHoldsTheLightOfItsOwnLuminaires) {
  const std::atomic<bool> interrupt = false;
  for (const SolveMethod method : test::kMethods) {
    const Solution grouped = solve_in_groups(box_with(true, true), seeded_settings(method, 1));
    const auto alone = [&](bool first, std::uint64_t seed) {
      const RoomBuilder room = box_with(first, !first);
      return solve_zones(room.scene(), room.mesh(), seeded_settings(method, seed), nullptr, interrupt);
    };
    const Solution first = alone(true, 2);
    const Solution second = alone(false, 3);
    const RoomBuilder room = box_with(true, true);
    const Solution both =
        solve_zones(room.scene(), room.mesh(), seeded_settings(method, 4), nullptr, interrupt);
    for (std::size_t quad = 0; quad < kQuads; ++quad)
      for (std::size_t band = 0; band < kBands; ++band) {
        const std::string what =
            to_string(method) + ", quad " + std::to_string(quad) + ", band " + std::to_string(band);
        const Channels& channels = grouped.sums.channels;
        const std::size_t a = channels.channel(0, band);
        const std::size_t b = channels.channel(1, band);
        expect_same(mean_of_quad(grouped.sums, quad, {a}), mean_of_quad(first.sums, quad, {band}), what);
        expect_same(mean_of_quad(grouped.sums, quad, {b}), mean_of_quad(second.sums, quad, {band}), what);
        expect_same(mean_of_quad(grouped.sums, quad, {a, b}), mean_of_quad(both.sums, quad, {band}), what);
      }
    EXPECT_TRUE(grouped.audit.balanced());
    for (const BandAudit& books : grouped.audit.bands)
      EXPECT_EQ(books.emitted, grouped.audit.weight * kBatchQuanta);
  }
}

TEST(LightGroups, WhatReadsZonesReadsAllGroups) {
  const RoomBuilder room = box_with(true, true);
  const Solution grouped = solve_in_groups(room, seeded_settings(SolveMethod::kShooting, 1));
  const ZoneSums& sums = grouped.sums;
  const Room walls(room.scene(), grouped.mesh);
  const RadianceField field(walls, grouped);
  const auto weight = static_cast<double>(sums.weight());
  for (const std::size_t z : {std::size_t{0}, kZonesPerQuad, 6 * kZonesPerQuad - 1})
    for (std::size_t band = 0; band < kBands; ++band) {
      const ZoneId zone(z);
      const std::size_t i = z * sums.channels.count() + band;
      const double total = (sums.total(i) + sums.total(i + kBands)) / weight;
      const Estimate irradiance = grouped.irradiance(zone, band);
      EXPECT_NEAR(irradiance.mean, total, 1e-12 * total);
      EXPECT_NEAR(grouped.direct_irradiance(zone, band).mean + grouped.indirect_irradiance(zone, band).mean,
                  total, 1e-12 * total);
      EXPECT_GT(irradiance.stderr_of_mean, 0);
      const auto rho = static_cast<float>(grouped.zone_reflectance(zone, band));
      EXPECT_FLOAT_EQ(field.reflected(zone)[band],
                      lambert_reflected_radiance(rho, static_cast<float>(total)));
    }
}

}  // namespace
}  // namespace reemit

// Shooting scales every band to its exact sum, which makes a batch a ratio estimate: batches of a few packets
// would have wrong colours however many of them there are.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "solver/shoot/packet_batch.h"
#include "solver/tally/batch_plan.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

/// Strong colours round a bulb.
test::RoomBuilder colourful_box() {
  test::RoomBuilder room(BandSet::rgb());
  const auto rgb = [](double r, double g, double b) { return Spectrum(Eigen::Array3d(r, g, b)); };
  const Spectrum none = rgb(0, 0, 0);
  const MaterialId white = room.material("white", rgb(0.6, 0.6, 0.6), none);
  const MaterialId red = room.material("red", rgb(0.95, 0.02, 0.02), none);
  const MaterialId green = room.material("green", rgb(0.02, 0.95, 0.02), none);
  const MaterialId blue = room.material("blue", rgb(0.02, 0.02, 0.95), none);
  room.box(Vec3::Zero(), Vec3(1, 1, 1), {red, green, blue, white, red, green}, 6);
  room.scene().lights = {PointLight{"bulb", Vec3(0.4, 0.6, 0.5), rgb(1, 1, 1)}};
  return room;
}

/// Absorbed power over emitted, by surface and band, of batches of the whole room.
class Batches {
 public:
  explicit Batches(const test::RoomBuilder& room)
      : mesh_(room.mesh().mesh),
        room_(room.scene(), mesh_),
        transport_(room_),
        emission_(collect_packet_sources(transport_)),
        books_(transport_.zones(), transport_.surfaces(), transport_.channels()) {}

  std::size_t shares() const { return books_.absorbed.size(); }

  /// Adds the mean over `count` batches of `packets` to `sum`.
  void add(std::uint64_t seed, std::uint32_t packets, std::int64_t count, std::vector<double>& sum) {
    SolverSettings settings;
    settings.seed = seed;
    for (std::int64_t k = 0; k < count; ++k) {
      books_.clear();
      shoot_batch({transport_, emission_, settings, static_cast<std::uint32_t>(k), packets}, books_);
      for (std::size_t i = 0; i < sum.size(); ++i)
        sum[i] += static_cast<double>(books_.absorbed[i]) / static_cast<double>(kBatchQuanta) /
                  static_cast<double>(count);
    }
  }

 private:
  ZoneMesh mesh_;
  Room room_;
  PacketRoom transport_;
  PacketSources emission_;
  BatchBooks books_;
};

constexpr int kFewPacketRuns = 2000;

/// Largest deviation of the mean of kFewPacketRuns runs from the truth, over the standard deviation of one
/// run.
double largest_bias(std::uint32_t packets, std::int64_t count) {
  double largest = 0;
  tbb::task_arena arena(1);  // the work is small
  arena.execute([&] {
    Batches batches(colourful_box());
    std::vector<double> truth(batches.shares());
    batches.add(999, 500'000, 4, truth);
    std::vector<double> sum(truth.size());
    std::vector<double> squares(truth.size());
    for (std::uint64_t seed = 1; seed <= kFewPacketRuns; ++seed) {
      std::vector<double> shares(truth.size());
      batches.add(seed, packets, count, shares);
      for (std::size_t i = 0; i < shares.size(); ++i) {
        sum[i] += shares[i] - truth[i];
        squares[i] += std::pow(shares[i] - truth[i], 2);
      }
    }
    for (std::size_t i = 0; i < sum.size(); ++i) {
      const double mean = sum[i] / kFewPacketRuns;
      largest = std::max(largest, std::abs(mean) / std::sqrt(squares[i] / kFewPacketRuns - mean * mean));
    }
  });
  return largest;
}

// The noise of the mean is 1/sqrt(2000) = 0.022 of that of a run; 4 times that above the eighth that
// BatchPlan allows, on one of 18 values, would be by chance with odds of 1e-3, and of 1e-10 at the bias that
// there is. Sixteen batches of eight packets show a bias of 0.32.
TEST(FewPackets, HaveTheRightColours) {
  constexpr double kMost = 0.125 + 4 * 0.022;
  SolverSettings settings;
  settings.packets = 128;
  const BatchPlan plan(settings, 100);
  EXPECT_LT(largest_bias(plan.unit_packets(), plan.weight_of_packets()), kMost);
  EXPECT_GT(largest_bias(8, 16), kMost) << "a bias of colours went unseen";
}

}  // namespace
}  // namespace reemit

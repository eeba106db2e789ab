// Even light on small faces: with the gains of places that make up for what of a kernel lies beyond their
// ends, it stays even, and a place brings what it has.
#include "solver/gather/face_ends.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "solver/room/room.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

/// A face of the plane z = 0, which a longer one below it makes 2 long in normalised units.
class SmallFace {
 public:
  SmallFace(double length, double width) : length_(length), width_(width) {
    const MaterialId grey = builder_.material("grey", 0.5);
    const auto quad = [&](double l, double w, double z) {
      builder_.quad(grey, {Vec3(0, 0, z), Vec3(l, 0, z), Vec3(l, w, z), Vec3(0, w, z)}, 1);
    };
    quad(length, width, 0);
    quad(kLongest, width, -kLongest / 2);
    mesh_ = builder_.mesh().mesh;
    room_.emplace(builder_.scene(), mesh_);
  }

  FaceEnds::Kernel kernel_at(double x, double y, float turn) const {
    return FaceEnds(room_->rays(), mesh_.flat_count())
        .kernel(Vec3f(0, 0, 1), place(x, y), kRadius, turn, false);
  }

  /// Sum of K(x, y) g(x) g(y) over places y on the face, for each of the places x.
  std::vector<double> even_light_at(const std::vector<std::pair<double, double>>& points) const {
    constexpr int kPlaces = 30'000;
    std::vector<double> sums(points.size(), 0.0);
    for (int k = 0; k < kPlaces; ++k) {
      const double x = length_ * fraction(k * 0.7548776662466927);
      const double y = width_ * fraction(k * 0.5698402909980532);
      const auto gain = static_cast<double>(kernel_at(x, y, turn_of(k)).gain);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const double d2 = (std::pow(x - points[i].first, 2) + std::pow(y - points[i].second, 2)) / (kR * kR);
        if (d2 < 1) sums[i] += gain * 2 / (std::numbers::pi * kR * kR) * (1 - d2);
      }
    }
    constexpr int kTurns = 32;
    for (std::size_t i = 0; i < points.size(); ++i) {
      double gain = 0;
      for (int turn = 0; turn < kTurns; ++turn)
        gain += static_cast<double>(kernel_at(points[i].first, points[i].second, turn_of(turn)).gain);
      sums[i] *= gain / kTurns * length_ * width_ / kPlaces;
    }
    return sums;
  }

 private:
  static constexpr double kLongest = 2;
  static constexpr double kR = 0.1;
  static constexpr auto kRadius = static_cast<float>(kR);

  static double fraction(double x) { return x - std::floor(x); }
  static float turn_of(int k) { return static_cast<float>(fraction(k * (std::numbers::phi - 1))); }
  Vec3f place(double x, double y) const {
    return ((Vec3(x, y, 0) - room_->rays().centre()) / room_->rays().metres_per_unit()).cast<float>();
  }

  double length_, width_;
  test::RoomBuilder builder_;
  ZoneMesh mesh_{BaseMesh{}};
  std::optional<Room> room_;
};

constexpr double kWithin = 0.05;  // as exact as 64 places around each are

TEST(FaceEnds, KeepEvenLightAlongAnEndAndInACorner) {
  const std::vector<std::pair<double, double>> points{{0.3, 0.001},   {0.3, 0.03},  {0.3, 0.06}, {0.3, 0.1},
                                                      {0.002, 0.002}, {0.03, 0.03}, {0.1, 0.03}};
  for (const double light : SmallFace(0.6, 0.6).even_light_at(points)) EXPECT_NEAR(light, 1, kWithin);
}

TEST(FaceEnds, KeepEvenLightOnAStripNarrowerThanTheKernel) {
  for (const double width : {0.04, 0.1, 0.2})
    for (const double light :
         SmallFace(1, width).even_light_at({{0.5, 0.003}, {0.5, width / 3}, {0.5, width / 2}}))
      EXPECT_NEAR(light, 1, kWithin) << width;
}

TEST(FaceEnds, KeepEvenLightOnASquareSmallerThanTheKernel) {
  for (const double light : SmallFace(0.1, 0.1).even_light_at({{0.002, 0.002}, {0.03, 0.03}, {0.05, 0.05}}))
    EXPECT_NEAR(light, 1, kWithin);
}

TEST(FaceEnds, AskForNothingWhereTheWholeKernelLiesOnTheFace) {
  const SmallFace face(0.6, 0.6);
  const FaceEnds::Kernel kernel = face.kernel_at(0.3, 0.3, 0.25F);
  EXPECT_EQ(kernel.gain, 1);
  EXPECT_EQ(kernel.share, 1);
  EXPECT_NEAR(face.kernel_at(0.3, 0.0001, 0.25F).share, 0.5, 0.05);
}

}  // namespace
}  // namespace reemit

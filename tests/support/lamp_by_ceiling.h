#pragma once
#include <cstdint>

#include "solver/progressive_solver.h"
#include "tests/support/never.h"
#include "tests/support/test_rooms.h"

namespace reemit::test {

/// A room of 2 x 2 x 1 m, z up, with a lamp of 0.5 x 0.5 m 4 cm below its ceiling that shines both ways: what
/// it lights most on the ceiling it hides itself. Its edges run through the middle of zones.
class LampByCeiling {
 public:
  static constexpr double kHeight = 1;
  static constexpr double kLamp = 0.5;
  static constexpr double kZone = 0.25;  ///< Edge of the square that two zones of the ceiling make up [m].
  static Vec3 middle() { return {1.1, 0.9, kHeight - 0.04}; }

  /// `rho`: reflectance of all but the ceiling, which has 0.8.
  explicit LampByCeiling(double rho) {
    const MaterialId wall = room_.material("wall", rho);
    const MaterialId ceiling = room_.material("ceiling", 0.8);
    const MaterialId lamp = room_.material("lamp", 0, 30, true);
    room_.scene().materials[lamp.index()].emits_both_sides = true;
    room_.box(Vec3::Zero(), {2, 2, kHeight}, {wall, wall, wall, wall, wall, ceiling}, 8);
    const Vec3 corner = middle() - Vec3(kLamp / 2, kLamp / 2, 0);
    const Vec3 u(kLamp, 0, 0);
    const Vec3 v(0, kLamp, 0);
    room_.quad(lamp, {corner, corner + v, corner + u + v, corner + u}, 2);
  }

  const RoomBuilder& builder() const { return room_; }
  /// A base triangle of the floor.
  TriangleId floor() const { return TriangleId(8); }
  Solution solved(std::uint64_t packets, std::uint64_t seed,
                  Reemission reemission = Reemission::kFromHits) const {
    SolverSettings settings;
    settings.reemission = reemission;
    settings.packets = packets;
    settings.seed = seed;
    return solve(room_.scene(), room_.mesh(), settings, {}, kNever);
  }

 private:
  RoomBuilder room_;
};

}  // namespace reemit::test

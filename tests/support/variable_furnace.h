#pragma once
#include <string>

#include "scenes/model/camera.h"
#include "tests/support/test_rooms.h"

namespace reemit::test {

/// Furnace with a different reflectance on every surface: a surface of reflectance rho emits (1 - rho) B0, so
/// radiosity and irradiance are B0 everywhere, whatever the shape and the zones (Kirchhoff), while emission,
/// direct and indirect light differ from place to place.
class VariableFurnace {
 public:
  static constexpr double kRadiosity = 2.5;  ///< B0 [W/m2].

  /// A box of 2 x 1.5 x 1 m with a slanting screen inside; `divisions` of the walls' triangles.
  explicit VariableFurnace(std::uint32_t divisions) {
    room_.box(Vec3::Zero(), kSize,
              {material(0.2), material(0.9), material(0.5), material(0.7), material(0.3), material(0.8)},
              divisions);
    screen({0.8, 0.4, 0.2}, {0.4, 0, 0}, {0, 0.6, 0.3}, divisions);
  }

  /// Adds a two-sided parallelogram inside the room.
  void screen(const Vec3& corner, const Vec3& u, const Vec3& v, std::uint32_t divisions) {
    room_.quad(material(0.6, true), {corner, corner + u, corner + u + v, corner + v}, divisions);
  }

  const RoomBuilder& room() const { return room_; }
  static Camera camera() {
    Camera camera;
    camera.name = "inside";
    camera.eye = {1.9, 0.1, 0.9};
    camera.look_at = {0.6, 0.9, 0.2};
    camera.up = {0, 0, 1};
    camera.width = 32;
    camera.height = 24;
    return camera;
  }

 private:
  inline static const Vec3 kSize{2, 1.5, 1};

  MaterialId material(double rho, bool two_sided = false) {
    const MaterialId id =
        room_.material("rho " + std::to_string(rho), rho, (1 - rho) * kRadiosity, two_sided);
    room_.scene().materials[id.index()].emits_both_sides = two_sided;
    return id;
  }

  RoomBuilder room_;
};

}  // namespace reemit::test

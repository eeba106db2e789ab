#pragma once
#include <string>

#include "tests/support/test_rooms.h"

namespace reemit::test {

/// Furnace with mirrors, glass and an opal sheet: a surface of diffuse reflectance rho, mirror share s, clear
/// transmittance t and diffuse transmittance tau emits (1 - rho - s - t - tau) B0 from each side, so that
/// radiosity without the mirrored part is (1 - s - t) B0, irradiance B0 and radiance B0/pi in every direction
/// outside of glass, whatever the shape. As large as VariableFurnace, whose camera looks into it.
class SpecularFurnace {
 public:
  static constexpr double kIrradiance = 2;  ///< B0 [W/m2].

  SpecularFurnace() {
    const MaterialId plain = wall(0.6, 0);
    const MaterialId half = wall(0.3, 0.5);
    const MaterialId mirror = wall(0, 1);
    room_.box(Vec3::Zero(), {2, 1.5, 1}, {plain, mirror, half, plain, mirror, half}, 3);
    const MaterialId sheet = wall(0.2, 0.1, 0.6, true);
    room_.scene().materials[sheet.index()].emits_both_sides = true;
    screen({0.7, 0.4, 0.2}, {0.4, 0, 0}, {0, 0.6, 0.3}, sheet);
    NonDiffusePart pane;
    pane.angle_law = AngleLaw::kDielectric;
    pane.index_of_refraction = 1.5;
    pane.specular_transmittance = room_.flat(1);
    screen({1.4, 0.5, 0.3}, {0, 0.6, 0.1}, {0.2, 0, 0.5}, glass(pane));
    NonDiffusePart solid = pane;
    solid.is_solid = true;
    room_.solid({0.2, 0.9, 0.2}, {0.5, 1.3, 0.6}, glass(solid), 1);
    room_.shape(glass(solid), Sphere{{1.2, 1.1, 0.35}, 0.2}, 1);
    const MaterialId opal = wall(0.3, 0, 0.1, true, 0.4);
    room_.scene().materials[opal.index()].emits_both_sides = true;
    screen({1.1, 0.2, 0.3}, {0.2, 0.3, 0}, {0, 0, 0.4}, opal);
  }

  const RoomBuilder& room() const { return room_; }

 private:
  void screen(const Vec3& corner, const Vec3& u, const Vec3& v, MaterialId m) {
    room_.quad(m, {corner, corner + u, corner + u + v, corner + v}, 2);
  }
  MaterialId wall(double rho, double mirror, double clear = 0, bool two_sided = false, double opal = 0) {
    const MaterialId id = room_.material("surface " + std::to_string(room_.scene().materials.size()), rho,
                                         (1 - rho - mirror - clear - opal) * kIrradiance, two_sided);
    Material& m = room_.scene().materials[id.index()];
    m.non_diffuse.specular_reflectance = room_.flat(mirror);
    m.non_diffuse.specular_transmittance = room_.flat(clear);
    m.non_diffuse.diffuse_transmittance = room_.flat(opal);
    return id;
  }
  MaterialId glass(const NonDiffusePart& part) {
    const MaterialId id =
        room_.material("glass " + std::to_string(room_.scene().materials.size()), 0, 0, true);
    room_.scene().materials[id.index()].non_diffuse = part;
    return id;
  }

  RoomBuilder room_;
};

}  // namespace reemit::test

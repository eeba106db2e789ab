#pragma once
#include <array>
#include <string>

#include "tests/mesh/test_room.h"

namespace reemit::test {

/// A box of 3 x 2 x 2 m whose walls reflect a half, a lamp under its ceiling, and crates on its floor that
/// are one surface: of `parts` x `parts` quads on each of their sides.
class CrateRoom {
 public:
  CrateRoom(int crates, int parts) {
    walls_ = surface("walls", material(0.5, 0, true));
    box(walls_, {0, 0, 0}, {3, 2, 2}, 4);
    const SurfaceId lamp = surface("lamp", material(0, 20, false));
    quad(lamp, {1, 0.5, 1.9}, {0, 1, 0}, {1, 0, 0}, 2);
    crates_ = surface("crates", material(0.7, 0, true));
    for (int i = 0; i < crates; ++i) {
      const Vec3 low(0.2 + 0.5 * i, 0.4 + 0.2 * (i % 2), 0.3);
      box(crates_, low, low + Vec3(0.3, 0.3, 0.3), parts);
    }
  }

  Scene& scene() { return room_.scene(); }
  SurfaceId walls() const { return walls_; }
  SurfaceId crates() const { return crates_; }

  MaterialId material(double reflectance, double radiance, bool two_sided) {
    const MaterialId m = room_.material(two_sided, radiance);
    scene().materials[m.index()].reflectance = Spectrum::Constant(1, reflectance);
    return m;
  }
  SurfaceId surface(const std::string& name, MaterialId m) { return room_.surface(name, m); }
  void quad(SurfaceId id, const Vec3& corner, const Vec3& u, const Vec3& v, int parts) {
    Surface& s = scene().surfaces[id.index()];
    for (int i = 0; i < parts; ++i)
      for (int j = 0; j < parts; ++j) {
        const auto at = [&](int a, int b) { return Vec3(corner + a * u / parts + b * v / parts); };
        const auto first = static_cast<std::uint32_t>(s.positions.size());
        s.positions.insert(s.positions.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        s.faces.emplace_back().outer = {first, first + 1, first + 2, first + 3};
      }
  }
  void box(SurfaceId id, const Vec3& low, const Vec3& high, int parts) {
    const Vec3 d = high - low;
    const Vec3 x(d.x(), 0, 0);
    const Vec3 y(0, d.y(), 0);
    const Vec3 z(0, 0, d.z());
    for (const auto& [u, v, w] : {std::array{x, y, z}, std::array{y, z, x}, std::array{z, x, y}}) {
      quad(id, low, v, u, parts);
      quad(id, low + w, u, v, parts);
    }
  }

 private:
  TestRoom room_;
  SurfaceId walls_, crates_;
};

}  // namespace reemit::test

#include "bench/hit_paths/touching_lamps.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace reemit::hit_paths {
namespace {

class RoomMaker {
 public:
  explicit RoomMaker(std::uint32_t number) : random_(number) {
    scene_.name = "touching lamps " + std::to_string(number);
    scene_.bands = BandSet::grey();
    size_ = Vec3(uniform(3, 7), uniform(3, 7), uniform(2.4, 3.5));
    // Half of the rooms stand straight and have the coordinates of a printed file, half are turned.
    turn_ = Eigen::Quaterniond::Identity();
    shift_ = Vec3::Zero();
    if (number % 2 == 1) return;
    grid_ = 0;
    turn_ =
        Eigen::AngleAxisd(uniform(0, 3), Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized());
    shift_ = Vec3(uniform(-5, 5), uniform(-5, 5), uniform(-5, 5));
  }

  Scene make() {
    wall_ = material("wall", uniform(0.3, 0.7), 0);
    thing_ = material("thing", uniform(0.2, 0.8), 0);
    lamp_ = material("lamp", uniform(0, 0.5), uniform(5, 20));
    shell();
    ceiling_panel();
    if (chance()) abutting_panels();
    fins_beside_lamp();
    if (chance()) cornice_lamp();
    if (chance()) notched_lamp();
    if (chance()) glowing_box();
    camera();
    finish_scene(scene_);
    return std::move(scene_);
  }

 private:
  double uniform(double a, double b) { return a + (b - a) * static_cast<double>(random_() >> 11) * 0x1p-53; }
  bool chance() { return random_() % 2 == 0; }
  /// 0 or a length over four decades, about the tolerances of any mesher.
  double hair() { return random_() % 3 == 0 ? 0.0 : std::pow(10.0, uniform(-7, -3)) * size_.norm(); }

  MaterialId material(const std::string& name, double reflectance, double radiance) {
    Material m;
    m.name = name;
    m.reflectance = Spectrum::Constant(1, reflectance);
    m.emitted_radiance = Spectrum::Constant(1, radiance);
    scene_.materials.push_back(m);
    return MaterialId(scene_.materials.size() - 1);
  }

  void polygon(const std::string& name, MaterialId material, const std::vector<Vec3>& corners) {
    Surface s;
    s.name = name;
    s.material = material;
    Face face;
    for (const Vec3& c : corners) {
      face.outer.push_back(static_cast<std::uint32_t>(s.positions.size()));
      Vec3 p = turn_ * c + shift_;
      if (grid_ > 0) p = (p / grid_).array().round().matrix() * grid_;
      s.positions.push_back(p);
    }
    s.faces.push_back(std::move(face));
    scene_.surfaces.push_back(std::move(s));
  }

  /// Corners counter-clockwise about u x v.
  void quad(const std::string& name, MaterialId material, const Vec3& corner, const Vec3& u, const Vec3& v) {
    polygon(name, material, {corner, corner + u, corner + u + v, corner + v});
  }

  void box(const std::string& name, MaterialId material, const Vec3& low, const Vec3& size, bool inward) {
    const Vec3 x(size.x(), 0, 0);
    const Vec3 y(0, size.y(), 0);
    const Vec3 z(0, 0, size.z());
    const auto side = [&](const Vec3& corner, const Vec3& u, const Vec3& v) {
      inward ? quad(name, material, corner, v, u) : quad(name, material, corner, u, v);
    };
    side(low, y, x);
    side(low + z, x, y);
    side(low, x, z);
    side(low + y, z, x);
    side(low, z, y);
    side(low + x, y, z);
  }

  void shell() { box("shell", wall_, Vec3::Zero(), size_, true); }

  /// A panel that shines down, in the plane of the ceiling or a hair below it, perhaps tilted by a millionth.
  void ceiling_panel() {
    const double a = uniform(0.5, 1.5);
    const double b = uniform(0.3, 1.0);
    const double gap = hair();
    const double tilt = gap > 0 && chance() ? 1e-6 : 0;
    quad("panel", lamp_,
         {uniform(0.2, size_.x() - a - 0.2), uniform(0.2, size_.y() - b - 0.2), size_.z() - gap},
         {0, b, -tilt}, {a, 0, 0});
  }

  void abutting_panels() {
    const double a = uniform(0.3, 0.6);
    const double gap = hair();
    const double z = size_.z() - uniform(0.05, 0.4);
    for (int i = 0; i < 3; ++i)
      quad("row " + std::to_string(i), lamp_, {0.3 + i * (a + gap), 0.1, z}, {0, 0.4, 0}, {a, 0, 0});
  }

  /// A hanging lamp with fins that stand on it from below: each runs from edge to edge, its ends a hair
  /// inside or outside, which leaves slivers of the lamp beside them.
  void fins_beside_lamp() {
    const double a = uniform(0.8, 2);
    const double b = uniform(0.5, 1.2);
    const Vec3 corner(uniform(0.3, size_.x() - a - 0.3), uniform(0.3, size_.y() - b - 0.3),
                      size_.z() - uniform(0.2, 0.6));
    const double tilt = chance() ? 2e-6 : 0;
    quad("hanging lamp", lamp_, corner, {0, b, -tilt}, {a, 0, 0});
    const auto sliver = [&] {
      return (chance() ? 1 : -1) * std::pow(10.0, uniform(-7.3, -5)) * size_.norm();
    };
    for (int i = 0; i < 5; ++i) {
      const double along = i < 2 ? uniform(0.002, 0.03) : uniform(0.03, 0.98);
      const double left = sliver();
      const double top = random_() % 3 == 0 ? -hair() : 0.0;
      const Vec3 foot = corner + Vec3(left, along * b, -along * tilt + top - 0.3);
      quad("fin " + std::to_string(i), thing_, foot, {0, 0, 0.3}, {a + sliver() - left, 0, 0});
    }
  }

  /// A strip of light along the edge of wall and ceiling.
  void cornice_lamp() {
    const double length = uniform(1, size_.x() - 0.5);
    const double gap = hair();
    quad("cornice", lamp_, {0.2, size_.y() - gap, size_.z() - 0.15 - gap}, {length, 0, 0}, {0, 0, 0.15});
  }

  /// An L: no convex polygon, with an edge on the wall.
  void notched_lamp() {
    const double x = hair();
    const double z = uniform(0.5, 1.5);
    const Vec3 o(x, uniform(0.3, size_.y() - 1.3), z);
    polygon("notched lamp", lamp_,
            {o, o + Vec3(0, 0.8, 0), o + Vec3(0, 0.8, 0.3), o + Vec3(0, 0.3, 0.3), o + Vec3(0, 0.3, 0.7),
             o + Vec3(0, 0, 0.7)});
  }

  void glowing_box() {
    const double a = uniform(0.2, 0.5);
    box("glowing box", lamp_, {size_.x() - a - uniform(0, 0.5), uniform(0.2, 1), hair()}, {a, a, a}, false);
  }

  void camera() {
    Camera c;
    c.name = "from the corner";
    c.eye = turn_ * Vec3(0.15 * size_.x(), 0.12 * size_.y(), 0.6 * size_.z()) + shift_;
    c.look_at = turn_ * Vec3(0.7 * size_.x(), 0.75 * size_.y(), 0.4 * size_.z()) + shift_;
    c.up = turn_ * Vec3::UnitZ();
    c.vertical_fov_deg = 80;
    scene_.cameras.push_back(c);
  }

  std::mt19937_64 random_;
  Scene scene_;
  Vec3 size_, shift_;
  double grid_ = 1e-6;  // coordinates are multiples of it [m]; 0: as they come
  Eigen::Quaterniond turn_;
  MaterialId wall_, thing_, lamp_;
};

}  // namespace

Scene touching_lamps_room(std::uint32_t number) {
  return RoomMaker(number).make();
}

}  // namespace reemit::hit_paths

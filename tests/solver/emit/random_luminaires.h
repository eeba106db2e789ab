#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "solver/emit/luminaire_bounds.h"

namespace reemit::test {

/// A luminaire with its exact shape: enough to tell in double precision whether it can light a point.
struct ShapedLuminaire {
  enum class Kind { kTriangle, kSphere, kPoint, kSpot };
  Kind kind = Kind::kPoint;
  std::array<Vec3f, 3> corner{};  ///< Of a triangle; else the middle is corner[0].
  Vec3f axis{0, 0, 1};            ///< Normal or direction.
  float radius = 0;
  float cos_outer = 0;
  float intensity = 1;

  LuminaireBounds bounds() const {
    if (kind == Kind::kTriangle) return flat_bounds(corner, axis, intensity);
    if (kind == Kind::kSpot) return spot_bounds(corner[0], axis, cos_outer, intensity);
    return sphere_bounds(corner[0], radius, intensity);
  }
  Vec3 middle() const {
    if (kind != Kind::kTriangle) return corner[0].cast<double>();
    return (corner[0] + corner[1] + corner[2]).cast<double>() / 3;
  }

  /// Is there a point of the luminaire that sends light to x and lies above the horizon of x? Spheres shine
  /// outwards: what of a sphere is above the horizon is seen, as the nearest point of its ray is above too.
  bool can_light(const Vec3& x, const Vec3& n) const {
    const auto height = [&](const Vec3f& p) { return n.dot(p.cast<double>() - x); };
    const Vec3 to_x = x - corner[0].cast<double>();
    switch (kind) {
      case Kind::kTriangle:
        return axis.cast<double>().dot(to_x) > 0 &&
               (height(corner[0]) > 0 || height(corner[1]) > 0 || height(corner[2]) > 0);
      case Kind::kSphere:
        return to_x.norm() > static_cast<double>(radius) &&
               height(corner[0]) + static_cast<double>(radius) > 0;
      case Kind::kSpot:
        return height(corner[0]) > 0 &&
               axis.cast<double>().dot(to_x) > static_cast<double>(cos_outer) * to_x.norm();
      case Kind::kPoint:
        break;
    }
    return height(corner[0]) > 0;
  }
};

class RandomLuminaires {
 public:
  explicit RandomLuminaires(unsigned seed) : random_(seed) {}

  float uniform(float from, float to) { return std::uniform_real_distribution<float>(from, to)(random_); }
  double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  Vec3f in_cube(float half) {
    const float x = uniform(-half, half), y = uniform(-half, half), z = uniform(-half, half);
    return {x, y, z};
  }
  Vec3f direction() {
    std::normal_distribution<float> normal;
    const float x = normal(random_), y = normal(random_), z = normal(random_);
    return Vec3f(x, y, z).normalized();
  }

  ShapedLuminaire any(float size) { return of_kind(static_cast<ShapedLuminaire::Kind>(random_() % 4), size); }
  ShapedLuminaire of_kind(ShapedLuminaire::Kind kind, float size) {
    ShapedLuminaire l;
    l.kind = kind;
    l.corner.fill(in_cube(1));
    l.axis = direction();
    l.intensity = std::exp(uniform(-3, 3));
    l.cos_outer = uniform(0, 0.99F);
    if (kind == ShapedLuminaire::Kind::kSphere) l.radius = size * uniform(0.01F, 1);
    if (kind == ShapedLuminaire::Kind::kTriangle) {
      l.corner[1] += in_cube(size);
      l.corner[2] += in_cube(size);
      l.axis = (l.corner[1] - l.corner[0]).cross(l.corner[2] - l.corner[0]).normalized();
    }
    return l;
  }
  std::vector<ShapedLuminaire> scene(std::size_t count, float size) {
    std::vector<ShapedLuminaire> all;
    for (std::size_t i = 0; i < count; ++i) all.push_back(any(size));
    return all;
  }
  std::vector<ShapedLuminaire> scene_of(ShapedLuminaire::Kind kind, std::size_t count, float size) {
    std::vector<ShapedLuminaire> all;
    for (std::size_t i = 0; i < count; ++i) all.push_back(of_kind(kind, size));
    return all;
  }

 private:
  std::mt19937 random_;
};

inline std::vector<LuminaireBounds> bounds_of(const std::vector<ShapedLuminaire>& luminaires) {
  std::vector<LuminaireBounds> all;
  for (const ShapedLuminaire& l : luminaires) all.push_back(l.bounds());
  return all;
}

/// Arrangements of luminaires that trees find hard.
struct Arrangement {
  std::string name;
  std::vector<LuminaireBounds> luminaires;
};

inline std::vector<Arrangement> arrangements(unsigned seed) {
  RandomLuminaires random(seed);
  std::vector<Arrangement> all;
  for (const std::size_t count : {1, 2, 3, 100, 5000})
    all.push_back({"random " + std::to_string(count), bounds_of(random.scene(count, 0.2F))});
  Arrangement same{"coincident", {}}, plane{"in a plane", {}}, row{"in a row", {}},
      chain{"geometric chain", {}}, points{"points", {}}, powers{"powers from 1e-37 to 1e37", {}};
  for (int i = 0; i < 300; ++i) {
    same.luminaires.push_back(sphere_bounds({0.1F, 0.2F, 0.3F}, 0, 1));
    const Vec3f corner(random.uniform(-1, 1), 1, random.uniform(-1, 1));
    plane.luminaires.push_back(flat_bounds(
        std::array{corner, Vec3f(corner + Vec3f(0.02F, 0, 0)), Vec3f(corner + Vec3f(0.02F, 0, 0.05F))},
        -Vec3f::UnitY(), 1));
    row.luminaires.push_back(sphere_bounds({static_cast<float>(i) / 300, 0.5F, 0}, 0.001F, 1));
    chain.luminaires.push_back(sphere_bounds({std::ldexp(1.0F, -i / 3), 0.5F, 0}, 0, 1));
    points.luminaires.push_back(sphere_bounds(random.in_cube(1), 0, random.uniform(0.1F, 1)));
    powers.luminaires.push_back(
        sphere_bounds(random.in_cube(1), 0, std::pow(10.0F, random.uniform(-37, 37))));
  }
  for (Arrangement* a : {&same, &plane, &row, &chain, &points, &powers}) all.push_back(*a);
  return all;
}

}  // namespace reemit::test

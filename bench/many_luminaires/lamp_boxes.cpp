#include "bench/many_luminaires/lamp_boxes.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "solver/sampling/counter_rng.h"
#include "solver/sampling/warp.h"

namespace reemit::bench {
namespace {

constexpr std::size_t kBrightnesses = 9;  // materials of the lamps, from 0.1 to 10 times the radiance
const Vec3 kBox{4, 3, 4};                 // [m]

Spectrum grey_value(double value) {
  return Spectrum::Constant(1, value);
}

void add_wall(Surface& box, const Vec3& corner, const Vec3& u, const Vec3& v) {
  const auto first = static_cast<std::uint32_t>(box.positions.size());
  for (const Vec3& p : {corner, Vec3(corner + u), Vec3(corner + u + v), Vec3(corner + v)})
    box.positions.push_back(p);
  box.faces.push_back({.outer = {first, first + 1, first + 2, first + 3}, .holes = {}, .normals = {}});
}

/// The box, its fronts inside.
Scene empty_box(std::string name) {
  Scene scene;
  scene.name = std::move(name);
  Material grey;
  grey.name = "grey";
  grey.reflectance = grey_value(0.5);
  grey.emitted_radiance = grey_value(0);
  scene.materials.push_back(grey);
  Surface box;
  box.name = "box";
  box.material = MaterialId(0);
  const Vec3 x(kBox.x(), 0, 0), y(0, kBox.y(), 0), z(0, 0, kBox.z()), o = Vec3::Zero();
  add_wall(box, o, z, x);
  add_wall(box, y, x, z);
  add_wall(box, o, x, y);
  add_wall(box, z, y, x);
  add_wall(box, o, y, z);
  add_wall(box, x, z, y);
  scene.surfaces.push_back(std::move(box));
  return scene;
}

/// One surface for each radiance of lamps.
void add_lamp_surfaces(Scene& scene) {
  for (std::size_t i = 0; i < kBrightnesses; ++i) {
    Material lamp;
    lamp.name = fmt::format("lamp {}", i + 1);
    lamp.reflectance = grey_value(0.5);
    const double exponent = -1 + 2.0 * static_cast<double>(i) / (kBrightnesses - 1);
    lamp.emitted_radiance = grey_value(std::pow(10.0, exponent));
    Surface surface;
    surface.name = lamp.name;
    surface.material = MaterialId(scene.materials.size());
    scene.materials.push_back(lamp);
    scene.surfaces.push_back(std::move(surface));
  }
}

/// The middle of lamp `i`, and two more uniform numbers.
struct Place {
  Vec3 middle;
  std::array<float, 2> u;
};

Place place_of(std::size_t i, std::size_t count) {
  const CounterRng rng(count, RngPurpose::kProbe);
  const std::array<float, 4> a = rng.uniform4(i, 0, 0);
  const std::array<float, 4> b = rng.uniform4(i, 0, 1);
  constexpr double kMargin = 0.1;  // of the box, that lamps keep to floor, walls and ceiling
  const Eigen::Array3d share =
      kMargin + (1 - 2 * kMargin) * Eigen::Array3d(static_cast<double>(a[0]), static_cast<double>(a[1]),
                                                   static_cast<double>(a[2]));
  return {(share * kBox.array()).matrix(), {b[0], b[1]}};
}

/// Radius [m] that keeps the share of the box that lamps fill.
double lamp_radius(std::size_t count) {
  return 0.06 / std::cbrt(static_cast<double>(count));
}

}  // namespace

Scene box_with_spheres(std::size_t count) {
  Scene scene = empty_box("spheres");
  add_lamp_surfaces(scene);
  for (std::size_t i = 0; i < count; ++i)
    scene.surfaces[1 + i % kBrightnesses].shapes.push_back(
        Sphere{.centre = place_of(i, count).middle, .radius = lamp_radius(count)});
  std::erase_if(scene.surfaces, [](const Surface& s) { return s.empty(); });
  finish_scene(scene);
  return scene;
}

Scene box_with_triangles(std::size_t count) {
  Scene scene = empty_box("triangles");
  add_lamp_surfaces(scene);
  for (std::size_t i = 0; i < count; ++i) {
    const Place place = place_of(i, count);
    const Frame frame(sample_sphere(place.u[0], place.u[1]));
    Surface& surface = scene.surfaces[1 + i % kBrightnesses];
    Face face;
    for (int k = 0; k < 3; ++k) {
      const double angle = 2 * std::numbers::pi * k / 3;
      face.outer.push_back(static_cast<std::uint32_t>(surface.positions.size()));
      surface.positions.push_back(place.middle + 2 * lamp_radius(count) *
                                                     (std::cos(angle) * frame.tangent.cast<double>() +
                                                      std::sin(angle) * frame.bitangent.cast<double>()));
    }
    surface.faces.push_back(std::move(face));
  }
  std::erase_if(scene.surfaces, [](const Surface& s) { return s.empty(); });
  finish_scene(scene);
  return scene;
}

Scene box_with_sheet(std::size_t side) {
  Scene scene = empty_box("sheet");
  Material lamp;
  lamp.name = "lamp";
  lamp.reflectance = grey_value(0.5);
  lamp.emitted_radiance = grey_value(1);
  scene.materials.push_back(lamp);
  Surface sheet;
  sheet.name = "sheet";
  sheet.material = MaterialId(1);
  for (std::size_t i = 0; i <= side; ++i)
    for (std::size_t j = 0; j <= side; ++j) {
      const double u = static_cast<double>(i) / static_cast<double>(side);
      const double v = static_cast<double>(j) / static_cast<double>(side);
      constexpr double kWaves = 4;
      const double wave =
          std::sin(2 * std::numbers::pi * kWaves * u) * std::sin(2 * std::numbers::pi * kWaves * v);
      sheet.positions.emplace_back(kBox.x() * (0.1 + 0.8 * u), kBox.y() * (0.85 + 0.04 * wave),
                                   kBox.z() * (0.1 + 0.8 * v));
    }
  const auto vertex = [side](std::size_t i, std::size_t j) {
    return static_cast<std::uint32_t>(i * (side + 1) + j);
  };
  for (std::size_t i = 0; i < side; ++i)
    for (std::size_t j = 0; j < side; ++j) {
      sheet.faces.push_back(
          {.outer = {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)}, .holes = {}, .normals = {}});
      sheet.faces.push_back(
          {.outer = {vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)}, .holes = {}, .normals = {}});
    }
  scene.surfaces.push_back(std::move(sheet));
  finish_scene(scene);
  return scene;
}

}  // namespace reemit::bench

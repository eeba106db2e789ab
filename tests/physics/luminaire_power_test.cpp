// Every kind of luminaire gives out the power that is stated: as packets, and as direct light summed over a
// closed sphere around it.

#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "mesh/build_mesh.h"
#include "solver/gather/direct_light.h"
#include "solver/progressive_solver.h"
#include "solver/room/room.h"
#include "solver/sampling/warp.h"
#include "tests/solver/emit/luminaire_tables.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::RoomBuilder;

constexpr double kRadius = 3;  // of the black sphere around [m]

/// A room with one luminaire in a black sphere and the power [W] per band that is stated for it.
struct Kind {
  std::string name;
  std::function<Spectrum(RoomBuilder&)> add;
};

Spectrum red_green_blue(double scale) {
  return Spectrum(Eigen::Array3d(1, 2.5, 0.2) * scale);
}

/// A material of the exitance red_green_blue(1), whatever the exponent.
MaterialId lamp(RoomBuilder& room, double exponent = 0, bool both_sides = false) {
  const MaterialId m = room.material("lamp", room.flat(0), room.flat(0), both_sides);
  Material& material = room.scene().materials[m.index()];
  material.emission_exponent = exponent;
  material.emits_both_sides = both_sides;
  material.emitted_radiance = red_green_blue((exponent + 2) / (2 * pi));
  return m;
}

Kind shape_kind(const std::string& name, const std::vector<CurvedShape>& shapes, double area,
                double exponent = 0, bool both_sides = false) {
  return {name, [=](RoomBuilder& room) {
            const MaterialId m = lamp(room, exponent, both_sides);
            for (const CurvedShape& shape : shapes) room.shape(m, shape, 1);
            return red_green_blue(area);
          }};
}

Kind polygon_kind(const std::string& name, const std::vector<Vec3>& positions, const Face& face, double area,
                  double exponent = 0) {
  return {name, [=](RoomBuilder& room) {
            Surface s;
            s.name = "lamp";
            s.material = lamp(room, exponent);
            s.positions = positions;
            s.faces.push_back(face);
            room.scene().surfaces.push_back(s);
            return red_green_blue(area);
          }};
}

Kind light_kind(const std::string& name, const PunctualLight& light, const Spectrum& power) {
  return {name, [=](RoomBuilder& room) {
            room.scene().lights.push_back(light);
            return power;
          }};
}

/// Shares of KHR_lights_punctual: the square of a ramp linear in the cosine.
double spot_solid_angle(double inner, double outer) {
  const double a = std::cos(inner);
  const double b = std::cos(outer);
  return 2 * pi * (1 - a + (a - b) / 3);
}

PhotometricLight measured_light(std::shared_ptr<const IntensityTable> table, const LuminousOpening& o) {
  PhotometricLight l;
  l.position = Vec3(0.1, -0.2, 0.3);
  l.orientation = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  l.table = std::move(table);
  l.intensity_per_candela = red_green_blue(0.01);
  l.opening = o;
  return l;
}

std::vector<Kind> kinds() {
  const std::vector<Vec3> rectangle{{0.2, 0, 0}, {1.1, 0, 0.3}, {1.1, 0.6, 0.3}, {0.2, 0.6, 0}};
  const std::vector<Vec3> triangle{{0, 0.1, 0}, {1, 0, 0}, {0.2, 0.5, 0.4}};
  const std::vector<Vec3> notched{{0, 0, 0},     {1, 0, 0},     {1, 0.8, 0},   {0.5, 0.3, 0}, {0, 0.8, 0},
                                  {0.1, 0.1, 0}, {0.3, 0.1, 0}, {0.3, 0.3, 0}, {0.1, 0.3, 0}};
  const Vec3 tilted = Vec3(0.3, -0.4, 0.5).normalized();
  const Vec3 base(0.3, 0.2, -0.1);
  const Vec3 top(0.6, -0.1, 0.5);
  const Vec3 axis = (top - base).normalized();
  const double height = (top - base).norm();
  const double slant = std::hypot(height, 0.2);
  using Opening = LuminousOpening::Shape;
  const auto planes = test::lobed_table();
  const auto axial = test::lambertian_table();
  const Spectrum of_planes = red_green_blue(0.01 * planes->total_flux());
  const Spectrum of_axial = red_green_blue(0.01 * axial->total_flux());
  const double rectangle_area = std::hypot(0.9, 0.3) * 0.6;
  return {
      polygon_kind("rectangle", rectangle, {{0, 1, 2, 3}, {}, {}, 0}, rectangle_area),
      polygon_kind("rectangle, cos^4", rectangle, {{0, 1, 2, 3}, {}, {}, 0}, rectangle_area, 4),
      polygon_kind("triangle", triangle, {{0, 1, 2}, {}, {}, 0},
                   0.5 * (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).norm()),
      polygon_kind("polygon with a notch and a hole", notched, {{0, 1, 2, 3, 4}, {{5, 6, 7, 8}}, {}, 0},
                   0.8 - 0.25 - 0.04),
      shape_kind("disk", {Disk{base, tilted, 0.5, 0}}, pi * 0.25),
      shape_kind("disk, cos^20", {Disk{base, tilted, 0.5, 0}}, pi * 0.25, 20),
      shape_kind("disk of two sides", {Disk{base, tilted, 0.5, 0}}, 2 * pi * 0.25, 0, true),
      shape_kind("ring", {Disk{base, tilted, 0.5, 0.2}}, pi * 0.21),
      shape_kind("sphere", {Sphere{base, 0.4, false}}, 4 * pi * 0.16),
      shape_kind("sphere, cos^2", {Sphere{base, 0.4, false}}, 4 * pi * 0.16, 2),
      shape_kind("cylinder", {Cylinder{base, top, 0.3, false}}, 2 * pi * 0.3 * height),
      shape_kind("cylinder with ends",
                 {Cylinder{base, top, 0.3, false}, Disk{base, -axis, 0.3, 0}, Disk{top, axis, 0.3, 0}},
                 2 * pi * 0.3 * (height + 0.3)),
      shape_kind("cone", {Cone{base, top, 0.3, 0.1, false}}, pi * 0.4 * slant),
      light_kind("point", PointLight{"p", base, red_green_blue(2)}, red_green_blue(8 * pi)),
      light_kind("spot", SpotLight{"s", base, tilted, red_green_blue(3), 0.3, 0.9},
                 red_green_blue(3 * spot_solid_angle(0.3, 0.9))),
      light_kind("planes, point", measured_light(planes, {}), of_planes),
      light_kind("planes, box", measured_light(planes, test::opening(Opening::kBox, 1.2, 0.6, 0)), of_planes),
      light_kind("planes, cylinder", measured_light(planes, test::opening(Opening::kCylinder, 0.5, 0.5, 0.2)),
                 of_planes),
      light_kind("axial, point", measured_light(axial, {}), of_axial),
      light_kind("axial, disk", measured_light(axial, test::opening(Opening::kCylinder, 0.5, 0.5, 0)),
                 of_axial)};
}

/// The room of one kind; its first shape is the black sphere.
RoomBuilder room_of(const Kind& kind, Spectrum& power) {
  RoomBuilder room(BandSet::rgb());
  room.shape(room.material("black", 0), Sphere{{0, 0, 0}, kRadius, true}, 8);
  power = kind.add(room);
  return room;
}

/// Power of all packets that the black sphere absorbs [W] per band.
Spectrum absorbed(const Scene& scene, MeshResult mesh) {
  SolverSettings settings;
  settings.packets = 1 << 16;
  settings.batch_packets = 1 << 12;
  settings.gather_small_zones = false;
  settings.seed = 3;
  settings.threads = 2;
  const std::atomic<bool> interrupt = false;
  const Solution s = solve_zones(scene, std::move(mesh), settings, nullptr, interrupt);
  Spectrum sum = Spectrum::Zero(3);
  for (std::size_t z = 0; z < s.mesh.zone_count(); ++z)
    if (s.mesh.zone_surface(ZoneId(z)).index() == 0)
      for (Eigen::Index b = 0; b < 3; ++b)
        sum[b] += s.mesh.zone_area(ZoneId(z)) * s.irradiance(ZoneId(z), static_cast<std::size_t>(b)).mean;
  return sum;
}

/// Direct light on the black sphere, at a quasi-random point for every sample [W] per band.
Spectrum collected(const Scene& scene, const ZoneMesh& mesh) {
  const Room walls(scene, mesh);
  const DirectLight direct(walls);
  const SobolSequence numbers(17);
  constexpr std::uint32_t kSamples = 1 << 17;
  const std::array<float, 3> weight{1, 1, 1};
  Spectrum sum = Spectrum::Zero(3);
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const float place = 8 * numbers.sample(i, 3);  // the eight patches of a sphere are equally large
    const auto patch = static_cast<std::size_t>(place);
    const auto [u, v] = sample_triangle(place - static_cast<float>(patch), numbers.sample(i, 4));
    const SurfacePoint x =
        surface_point(walls.rays(), TriangleId(mesh.first_patch(0).index() + patch), u, v, true);
    std::array<float, 3> e{0, 0, 0};
    direct.add_sample(x, {numbers.sample(i, 0), numbers.sample(i, 1), numbers.sample(i, 2)}, weight.data(),
                      e.data());
    for (std::size_t b = 0; b < 3; ++b) sum[static_cast<Eigen::Index>(b)] += static_cast<double>(e[b]);
  }
  return 4 * pi * kRadius * kRadius / kSamples * sum;
}

constexpr double kTolerance = 1e-3;

TEST(LuminairePower, PacketsCarryWhatIsStated) {
  for (const Kind& kind : kinds()) {
    Spectrum power;
    const RoomBuilder room = room_of(kind, power);
    const Spectrum off = absorbed(room.scene(), build_mesh(room.scene())) / power - 1;
    EXPECT_LT(off.abs().maxCoeff(), kTolerance) << kind.name << ": " << off.transpose();
  }
}

TEST(LuminairePower, DirectLightOnAClosedSphereIsWhatIsStated) {
  for (const Kind& kind : kinds()) {
    Spectrum power;
    const RoomBuilder room = room_of(kind, power);
    const Spectrum off = collected(room.scene(), build_mesh(room.scene()).mesh) / power - 1;
    EXPECT_LT(off.abs().maxCoeff(), kTolerance) << kind.name << ": " << off.transpose();
  }
}

TEST(LuminairePower, ABiasOfTwoPerMilleIsNoticed) {
  const Kind kind = shape_kind("disk", {Disk{{0.3, 0.2, -0.1}, {0, 0, 1}, 0.5, 0}}, pi * 0.25 * 1.002);
  Spectrum power;
  const RoomBuilder room = room_of(kind, power);
  const MeshResult mesh = build_mesh(room.scene());
  EXPECT_GT((collected(room.scene(), mesh.mesh) / power - 1).abs().maxCoeff(), kTolerance);
  EXPECT_GT((absorbed(room.scene(), mesh) / power - 1).abs().maxCoeff(), kTolerance);
}

}  // namespace
}  // namespace reemit

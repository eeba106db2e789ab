#include "solver/sky/sky_table.h"

#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "solver/sampling/sobol.h"
#include "solver/sky/sky_entry.h"
#include "solver/sky/sun_beam.h"
#include "tests/support/mean_test.h"
#include "tests/support/skies.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::cie_sky_over_z;
using test::sky_over_z;

/// Irradiance of a plane by midpoints of half a degree, of the formula itself.
template <class Radiance>
double irradiance_by_quadrature(const Vec3& normal, Radiance&& radiance) {
  constexpr int kSteps = 180;
  const double step = 0.5 * pi / kSteps;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < 4 * kSteps; ++j) {
      const double altitude = (i + 0.5) * step;
      const double azimuth = (j + 0.5) * step;
      const Vec3 d(std::cos(altitude) * std::sin(azimuth), std::cos(altitude) * std::cos(azimuth),
                   std::sin(altitude));
      sum += std::max(0.0, normal.dot(d)) * radiance(d) * std::cos(altitude) * step * step;
    }
  return sum;
}

/// The same of the table.
double irradiance_of_table(const SkyTable& table, const Vec3& normal) {
  return irradiance_by_quadrature(normal, [&](const Vec3& d) {
    return static_cast<double>(table.brightness(table.cell_of(table.to_local() * d)));
  });
}

TEST(SkyTable, overcast_sky_on_level_and_upright_planes) {
  // L = Lz (1 + 2 sin) / 3: E = 7 pi/9 Lz on a level plane, (8 + 3 pi)/(14 pi) of it on an upright one.
  const SkyTable table(sky_over_z(SkyKind::kOvercast, 7 * pi / 9), BandSet::grey());
  EXPECT_NEAR(irradiance_of_table(table, Vec3::UnitZ()), 7 * pi / 9, 1e-4 * 7 * pi / 9);
  EXPECT_NEAR(irradiance_of_table(table, Vec3::UnitX()), 7 * pi / 9 * (8 + 3 * pi) / (14 * pi), 1e-4);
  EXPECT_NEAR(table.brightness(table.cell_of(Vec3(0, 0.01, 1).normalized())), 1, 1e-3);
  EXPECT_EQ(table.brightness(table.cell_of(Vec3(0, 1, -1e-6))), 0) << "black ground";
}

TEST(SkyTable, all_cie_skies_have_the_relations_of_their_formula) {
  const Vec3 normals[] = {Vec3::UnitX(), -Vec3::UnitX(), Vec3::UnitY(), Vec3(1, -2, 1.5).normalized()};
  for (int type = 1; type <= 15; ++type) {
    const Sky sky = cie_sky_over_z(type, 100);
    const SkyTable table(sky, BandSet::grey());
    const auto formula = [&](const Vec3& d) {
      return sky.gradation.relative_luminance(d.z(),
                                              std::acos(std::clamp(d.dot(sky.towards_sun()), -1.0, 1.0)));
    };
    const double level = irradiance_by_quadrature(Vec3::UnitZ(), formula);
    EXPECT_NEAR(irradiance_of_table(table, Vec3::UnitZ()), 100, 0.02) << type;
    for (const Vec3& normal : normals) {
      const double expected = 100 * irradiance_by_quadrature(normal, formula) / level;
      EXPECT_NEAR(irradiance_of_table(table, normal), expected, 2e-3 * expected) << type;
    }
  }
}

TEST(SkyTable, standard_skies_have_their_published_zenith_luminance) {
  // Lz over horizontal illuminance of the overcast standard sky, type 1, within 2 % of Moon and Spencer's
  // 9/(7 pi).
  const SkyTable table(cie_sky_over_z(1, 1), BandSet::grey());
  EXPECT_NEAR(table.brightness(table.cell_of(Vec3(0, 0.001, 1).normalized())), 9 / (7 * pi),
              0.02 * 9 / (7 * pi));
}

TEST(SkyTable, perez_skies_are_clear_or_overcast_by_their_irradiances) {
  // No beam: the darkest bin, brighter at the zenith than at the horizon. Much of it: bright around the sun.
  const SkyGradation grey = SkyGradation::of_weather(0, 100, 0.7);
  EXPECT_GT(grey.relative_luminance(1, 0.87), 1.5 * grey.relative_luminance(0.1, 1.5));
  const SkyGradation clear = SkyGradation::of_weather(850, 90, 0.7);
  EXPECT_GT(clear.relative_luminance(std::sin(0.7), 0.05), 4 * clear.relative_luminance(1, 0.87));
}

// Computed from tables and equations of [PER93] by a program of its own.
TEST(SkyTable, perez_skies_are_those_of_the_paper) {
  struct Weather {
    double direct_normal, diffuse_horizontal, sun_altitude_deg;  // [W/m2]
    std::array<double, 3>
        over_zenith;  // at altitude 30 degrees, opposite to the sun, beside and below or above it
  };
  constexpr double kDegree = std::numbers::pi / 180;
  for (const Weather& weather :
       {Weather{50, 250, 40, {0.78085, 1.01149, 4.95154}}, Weather{600, 120, 45, {1.00056, 1.18236, 6.25708}},
        Weather{850, 90, 60, {0.59681, 0.75993, 1.76528}}}) {
    const double sun = weather.sun_altitude_deg * kDegree;
    const SkyGradation sky = SkyGradation::of_weather(weather.direct_normal, weather.diffuse_horizontal, sun);
    const double zenith = sky.relative_luminance(1, std::numbers::pi / 2 - sun);
    for (std::size_t i = 0; i < 3; ++i) {
      const double altitude = 30 * kDegree;
      const double azimuth = std::numbers::pi - static_cast<double>(i) * std::numbers::pi / 2;
      const double to_sun = std::acos(std::sin(altitude) * std::sin(sun) +
                                      std::cos(altitude) * std::cos(sun) * std::cos(azimuth));
      EXPECT_NEAR(sky.relative_luminance(std::sin(altitude), to_sun) / zenith, weather.over_zenith[i],
                  1e-4 * weather.over_zenith[i])
          << weather.direct_normal << " W/m2, direction " << i;
    }
  }
}

TEST(SkyTable, directions_are_drawn_by_brightness) {
  for (const int type : {1, 12}) {
    const SkyTable table(cie_sky_over_z(type, 100), BandSet::grey());
    const Vec3 normal = Vec3(1, -2, 1.5).normalized();
    test::MeanTest drawn;
    for (std::uint64_t replicate = 0; replicate < 32; ++replicate) {
      const SobolSequence numbers(900 + replicate);
      double sum = 0;
      constexpr std::uint32_t kDirections = 1024;
      for (std::uint32_t i = 0; i < kDirections; ++i) {
        const Vec3 d = table.sample(static_cast<double>(numbers.sample(i, 0)),
                                    static_cast<double>(numbers.sample(i, 1)));
        const SkyTable::Cell cell = table.cell_of(d);
        const double cosine = std::max(0.0, d.dot(table.to_local() * normal));
        sum += cosine * static_cast<double>(table.brightness(cell)) / table.pdf_per_sr(cell);
      }
      drawn.add(sum / kDirections);
    }
    const double expected = irradiance_of_table(table, normal);
    EXPECT_TRUE(drawn.agrees_with(expected)) << type;
    EXPECT_TRUE(drawn.would_notice(0.02, expected));
    EXPECT_NEAR(table.irradiance(table.to_local() * normal), expected, 0.15 * expected) << "harmonics";
  }
}

/// Packets through all faces of a box onto a plane, over what the sky sends there.
TEST(SkyEntry, packets_bring_every_plane_what_the_sky_sends) {
  for (const Vec3& up : {Vec3(Vec3::UnitZ()), Vec3(0.3, 0.5, 0.9)}) {
    Sky sky = cie_sky_over_z(12, 100);
    sky.up = up.normalized();
    sky.north = (Vec3(0.2, 1, 0) - Vec3(0.2, 1, 0).dot(sky.up) * sky.up).normalized();
    sky.ground_reflectance = Spectrum::Constant(1, 0.4);
    const SkyTable table(sky, BandSet::grey());
    const SkyBox box = SkyBox::around(Vec3(1, 0.7, 0.4), sky.up);
    const SkyEntry entry(table, box, std::nullopt);
    for (const Vec3& normal : {Vec3(Vec3::UnitZ()), Vec3(1, -2, -1.5).normalized()}) {
      // A disk of area pi r^2 in the middle of the box: the power on it is E pi r^2.
      constexpr double kRadius = 0.38;
      test::MeanTest caught;
      for (std::uint64_t replicate = 0; replicate < 32; ++replicate) {
        const SobolSequence numbers(40 + replicate);
        double sum = 0;
        constexpr std::uint32_t kPackets = 16384;
        for (std::size_t face = 0; face < SkyEntry::kFaces; ++face)
          for (std::uint32_t i = 0; i < kPackets; ++i) {
            SkyEntry::Numbers u;
            for (int k = 0; k < 4; ++k)
              u[static_cast<std::size_t>(k)] = static_cast<double>(numbers.sample(i, k));
            const SkyRay ray = entry.start(face, u);
            const Vec3 d = ray.direction.cast<double>();
            if (!(d.dot(normal) < 0)) continue;
            const Vec3 origin = ray.origin.cast<double>();
            const Vec3 at = origin - origin.dot(normal) / d.dot(normal) * d;
            if (at.norm() < kRadius) sum += entry.irradiance(face) * box.face_area(face) / kPackets;
          }
        caught.add(sum / (pi * kRadius * kRadius));
      }
      double expected = 0;  // of sky and ground: rows of the table by quadrature over the whole sphere
      constexpr int kSteps = 720;
      for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < 2 * kSteps; ++j) {
          const double altitude = ((i + 0.5) / kSteps - 0.5) * pi;
          const double azimuth = (j + 0.5) * pi / kSteps;
          const Vec3 d(std::cos(altitude) * std::cos(azimuth), std::cos(altitude) * std::sin(azimuth),
                       std::sin(altitude));
          const double cosine = d.dot(table.to_local() * normal);
          if (cosine > 0)
            expected += cosine * static_cast<double>(table.brightness(table.cell_of(d))) *
                        std::cos(altitude) * pi * pi / (kSteps * kSteps);
        }
      EXPECT_TRUE(caught.agrees_with(expected)) << up.transpose() << " on " << normal.transpose();
      EXPECT_TRUE(caught.would_notice(0.02, expected));
    }
  }
}

TEST(SkyEntry, numbers_come_back_from_packets) {
  Sky sky = cie_sky_over_z(12, 100);
  sky.ground_reflectance = Spectrum::Constant(1, 0.4);
  const SkyTable table(sky, BandSet::grey());
  const SkyBox box = SkyBox::around(Vec3(1, 0.7, 0.4), sky.up);
  const SkyEntry entry(table, box, std::nullopt);
  const SobolSequence numbers(7);
  std::size_t off = 0;
  std::size_t tried = 0;
  for (std::size_t face = 0; face < SkyEntry::kFaces; ++face)
    for (std::uint32_t i = 0; i < 512; ++i, ++tried) {
      SkyEntry::Numbers u;
      for (int k = 0; k < 4; ++k) u[static_cast<std::size_t>(k)] = static_cast<double>(numbers.sample(i, k));
      const SkyRay ray = entry.start(face, u);
      SkyEntry::Numbers back;
      const Vec3 inside = ray.origin.cast<double>() + 1e-3 * ray.direction.cast<double>();
      const std::size_t through = entry.invert(inside, -ray.direction.cast<double>(), back);
      double worst = through == face ? 0 : 1;
      for (std::size_t k = 0; k < 4; ++k) worst = std::max(worst, std::abs(back[k] - u[k]));
      if (worst > 1e-3) ++off;  // a way along an edge of the box, or rounding over the rim of a cell
    }
  EXPECT_LT(off, tried / 50);
}

TEST(SunBeam, fills_the_box_with_its_irradiance) {
  const Vec3 towards = Vec3(0.5, -0.3, 0.4).normalized();
  const SkyBox box = SkyBox::around(Vec3(1, 0.7, 0.4), Vec3::UnitZ());
  const SunBeam beam(towards, Sun::kHalfAngle, box);
  const Vec3 normal = Vec3::UnitZ();
  test::MeanTest caught;
  constexpr double kRadius = 0.3;
  for (std::uint64_t replicate = 0; replicate < 32; ++replicate) {
    const SobolSequence numbers(70 + replicate);
    double sum = 0;
    constexpr std::uint32_t kPackets = 8192;
    for (std::uint32_t i = 0; i < kPackets; ++i) {
      SkyEntry::Numbers u;
      for (int k = 0; k < 4; ++k) u[static_cast<std::size_t>(k)] = static_cast<double>(numbers.sample(i, k));
      const SkyRay ray = beam.start(u);
      const Vec3 d = ray.direction.cast<double>();
      const Vec3 origin = ray.origin.cast<double>();
      EXPECT_TRUE(beam.sees((-d).normalized() * (1 - 1e-6) + 1e-6 * towards));
      const Vec3 at = origin - origin.dot(normal) / d.dot(normal) * d;
      if (at.norm() < kRadius) sum += beam.area() / kPackets;
      SkyEntry::Numbers back;
      beam.invert(origin + 0.5 * d, -d, back);
      for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(back[k], u[k], 2e-3);
    }
    caught.add(sum / (pi * kRadius * kRadius));
  }
  EXPECT_TRUE(caught.agrees_with(towards.z()));
  EXPECT_TRUE(caught.would_notice(0.02, towards.z()));
}

}  // namespace
}  // namespace reemit

#include "scenes/model/photometry.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/scenes/type_c.h"

namespace reemit {
namespace {

using std::numbers::pi;
using test::type_c;

TEST(Photometry, integral_of_linear_times_sine) {
  // Antiderivative of (p + q t) sin t: -(p + q t) cos t + q sin t.
  const auto direct = [](double a, double b, double fa, double fb) {
    const double q = (fb - fa) / (b - a);
    return fa * std::cos(a) - fb * std::cos(b) + q * (std::sin(b) - std::sin(a));
  };
  EXPECT_NEAR(integral_of_linear_times_sine(0, pi, 1, 1), 2, 1e-15);
  for (const double width : {2.0, 0.5, 0.11, 0.09, 0.03})
    EXPECT_NEAR(integral_of_linear_times_sine(0.4, 0.4 + width, 3, 7), direct(0.4, 0.4 + width, 3, 7), 1e-13);
  // Where the difference of cosines would keep no digit: the middle value times the width.
  const double a = 1.2;
  const double w = 1e-9;
  EXPECT_NEAR(integral_of_linear_times_sine(a, a + w, 2, 4) / (3 * std::sin(a) * ((a + w) - a)), 1, 1e-8);
  EXPECT_EQ(integral_of_linear_times_sine(1, 1, 2, 2), 0);
}

TEST(Photometry, uniform_light_has_four_pi_candela) {
  const IntensityTable c(PhotometricType::kC, {0, 30, 90, 180}, {0, 120, 360}, std::vector<double>(12, 5.0));
  EXPECT_NEAR(c.total_flux(), 20 * pi, 1e-12);
  // The front half of the sphere, where type A and B tables end.
  for (const PhotometricType type : {PhotometricType::kA, PhotometricType::kB}) {
    const IntensityTable half(type, {0, 45, 180}, {-90, 0, 90}, std::vector<double>(9, 5.0));
    EXPECT_NEAR(half.total_flux(), 10 * pi, 1e-12);
  }
}

TEST(Photometry, lambertian_flux_converges_to_pi_with_the_square_of_the_step) {
  double previous = 0;
  for (const int steps : {9, 18, 36}) {
    std::vector<double> gamma;
    std::vector<double> candela;
    for (int i = 0; i <= steps; ++i) gamma.push_back(90.0 * i / steps);
    for (int plane = 0; plane < 2; ++plane)
      for (const double g : gamma) candela.push_back(std::max(0.0, std::cos(g * pi / 180)));
    const IntensityTable table(PhotometricType::kC, gamma, {0, 360}, candela);
    const double error = pi - table.total_flux();
    EXPECT_GT(error, 0);
    if (previous > 0) {
      EXPECT_NEAR(previous / error, 4, 0.1);
    }
    previous = error;
  }
  EXPECT_LT(previous, 1e-3);
}

TEST(Photometry, is_linear_in_both_angles) {
  const IntensityTable table(PhotometricType::kC, {0, 20, 50}, {0, 90, 360}, {1, 2, 8, 1, 6, 4, 1, 2, 8});
  EXPECT_NEAR(table.intensity(type_c(10, 0)), 1.5, 1e-12);
  EXPECT_NEAR(table.intensity(type_c(35, 0)), 5, 1e-12);
  EXPECT_NEAR(table.intensity(type_c(20, 45)), 4, 1e-12);
  EXPECT_NEAR(table.intensity(3 * type_c(35, 45)), 5, 1e-12);
  EXPECT_NEAR(table.intensity(type_c(20, 225)), 4, 1e-12);
  EXPECT_NEAR(table.intensity(type_c(0, 77)), 1, 1e-12);
  EXPECT_NEAR(table.intensity(type_c(50, 90)), 4, 1e-12);
  EXPECT_EQ(table.intensity(type_c(50.01, 90)), 0);
  EXPECT_EQ(table.greatest_intensity(), 8);
}

TEST(Photometry, rough_intensity_is_that_of_directions_nearby) {
  std::vector<double> polar, azimuth, candela;
  for (double g = 0; g <= 180; g += 15) polar.push_back(g);
  for (double c = 0; c <= 360; c += 15) azimuth.push_back(c);
  for (const double c : azimuth)
    for (const double g : polar) candela.push_back(10 + Vec3(2, 1, 3).dot(type_c(g, c)));
  const IntensityTable table(PhotometricType::kC, polar, azimuth, candela);
  const double slope = Vec3(2, 1, 3).norm();  // [cd/rad] at most
  double sum = 0;
  constexpr int kDirections = 2000;
  for (int i = 0; i < kDirections; ++i) {
    const double gamma = 180 / pi * std::acos(1 - 2 * (i + 0.5) / kDirections);
    const Vec3 direction = std::exp(0.01 * (i % 700) - 3) * type_c(gamma, 222.4922 * i);
    const double off = table.rough_intensity(direction) - table.intensity(direction);
    EXPECT_LT(std::fabs(off), slope * 8 * pi / 180) << gamma;
    sum += off;
  }
  EXPECT_NEAR(sum / kDirections, 0, 0.02);

  const IntensityTable spot(PhotometricType::kC, {0, 3, 180}, {0, 360}, {1e6, 0, 0, 1e6, 0, 0});
  EXPECT_GT(spot.rough_intensity(type_c(2, 10)), 0);
  EXPECT_EQ(spot.rough_intensity(type_c(20, 10)), 0);
}

TEST(Photometry, goniometers_differ_by_their_pole) {
  const auto near = [](const Vec3& a, const Vec3& b) { return (a - b).norm() < 1e-12; };
  const double d = pi / 180;
  const auto of = [](PhotometricType type) {
    return IntensityTable(type, {0, 180}, {-90, 90}, {1, 1, 1, 1});
  };
  // Type C: gamma 0 is the nadir, C = 90 is y.
  EXPECT_TRUE(near(of(PhotometricType::kC).direction(0, 0), {0, 0, -1}));
  EXPECT_TRUE(near(of(PhotometricType::kC).direction(90 * d, 90 * d), {0, 1, 0}));
  // Type A: (0,0) is the photometric horizontal x, vertical -90 the nadir, horizontal 90 clockwise: -y.
  EXPECT_TRUE(near(of(PhotometricType::kA).direction(90 * d, 0), {1, 0, 0}));
  EXPECT_TRUE(near(of(PhotometricType::kA).direction(0, 0), {0, 0, -1}));
  EXPECT_TRUE(near(of(PhotometricType::kA).direction(90 * d, 90 * d), {0, -1, 0}));
  // Type B: (0,0) is the nadir, vertical 90 is x, horizontal 90 is -y.
  EXPECT_TRUE(near(of(PhotometricType::kB).direction(90 * d, 0), {0, 0, -1}));
  EXPECT_TRUE(near(of(PhotometricType::kB).direction(90 * d, 90 * d), {1, 0, 0}));
  EXPECT_TRUE(near(of(PhotometricType::kB).direction(180 * d, 0), {0, -1, 0}));
}

TEST(Photometry, angles_and_directions_are_inverse) {
  for (const PhotometricType type : {PhotometricType::kA, PhotometricType::kB, PhotometricType::kC}) {
    const IntensityTable table(type, {0, 180}, {-90, 270}, {1, 1, 1, 1});
    for (const double polar : {0.1, 1.0, 3.0})
      for (const double azimuth : {-1.5, 0.3, 4.6}) {
        double p = 0;
        double a = 0;
        table.angles(2 * table.direction(polar, azimuth), p, a);
        EXPECT_NEAR(p, polar, 1e-13);
        EXPECT_NEAR(a, azimuth, 1e-13);
      }
  }
}

TEST(Photometry, refuses_tables_that_mean_nothing) {
  const std::vector<double> ones(4, 1.0);
  const auto refused = [](const std::vector<double>& polar, const std::vector<double>& azimuth,
                          const std::vector<double>& candela) {
    EXPECT_THROW(IntensityTable(PhotometricType::kC, polar, azimuth, candela), std::invalid_argument);
  };
  refused({0}, {0, 360}, {1, 1});
  refused({0, 0}, {0, 360}, ones);
  refused({0, 181}, {0, 360}, ones);
  refused({0, 90}, {0, 361}, ones);
  refused({0, 90}, {0, 360}, {1, 1, 1});
  refused({0, 90}, {0, 360}, {1, -1, 1, 1});
  refused({0, 90}, {0, 360}, {1, NAN, 1, 1});
  refused({0, 90}, {0, 360}, {0, 0, 0, 0});
}

}  // namespace
}  // namespace reemit

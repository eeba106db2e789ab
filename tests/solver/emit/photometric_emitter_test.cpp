#include "solver/emit/photometric_emitter.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/emit/punctual_emitter.h"
#include "solver/sampling/sobol.h"
#include "solver/sampling/warp.h"
#include "tests/solver/emit/luminaire_tables.h"
#include "tests/support/test_rooms.h"

namespace reemit {
namespace {

using std::numbers::pi;
using Shape = LuminousOpening::Shape;
using Axis = LuminousOpening::Axis;
using test::opening;

/// A box of 8 m with one light at its middle.
class Emitters : public ::testing::Test {
 protected:
  Emitters() {
    const MaterialId grey = room_.material("grey", 0.5);
    room_.box(Vec3(-4, -4, -4), Vec3(4, 4, 4), {grey, grey, grey, grey, grey, grey}, 1);
    mesh_ = std::make_unique<ZoneMesh>(room_.mesh().mesh);
    rays_ = std::make_unique<RayTracer>(*mesh_);
  }

  PhotometricLight light(std::shared_ptr<const IntensityTable> table, const LuminousOpening& o) const {
    PhotometricLight l;
    l.position = Vec3(0.1, -0.2, 0.3);
    l.orientation = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
    l.table = std::move(table);
    l.intensity_per_candela = room_.flat(1);
    l.opening = o;
    return l;
  }

  /// Irradiance at a point by many samples [1/m2 per unit of strength].
  double irradiance(const PunctualLight& l, const Vec3& x, const Vec3& n) const {
    const PunctualEmitter e = make_punctual_emitter(l, *rays_);
    const SobolSequence numbers(3);
    constexpr std::uint32_t kSamples = 1 << 16;
    double sum = 0;
    for (std::uint32_t k = 0; k < kSamples; ++k)
      sum += static_cast<double>(
          sample_light(e, rays_->normalised(x), n.cast<float>(), numbers.sample(k, 0), numbers.sample(k, 1))
              .factor);
    return sum / kSamples;
  }

  /// Irradiance integrated over a sphere around the light by quasi-random points.
  double flux_through_sphere(const PunctualLight& l, const Vec3& centre, double radius) const {
    const PunctualEmitter e = make_punctual_emitter(l, *rays_);
    const SobolSequence numbers(9);
    constexpr std::uint32_t kSamples = 1 << 18;
    double sum = 0;
    for (std::uint32_t k = 0; k < kSamples; ++k) {
      const Vec3f d = sample_sphere(numbers.sample(k, 2), numbers.sample(k, 3));
      const Vec3f x = rays_->normalised(centre + radius * d.cast<double>());
      sum += static_cast<double>(sample_light(e, x, -d, numbers.sample(k, 0), numbers.sample(k, 1)).factor);
    }
    return 4 * pi * radius * radius * sum / kSamples;
  }

  test::RoomBuilder room_;
  std::unique_ptr<ZoneMesh> mesh_;
  std::unique_ptr<RayTracer> rays_;
};

TEST_F(Emitters, flux_through_a_closed_surface_is_the_power_of_the_packets) {
  const LuminousOpening openings[] = {opening(Shape::kPoint, 0, 0, 0),
                                      opening(Shape::kBox, 1.2, 0.6, 0),
                                      opening(Shape::kBox, 0.6, 0.6, 0.2),
                                      opening(Shape::kCylinder, 0.5, 0.5, 0),
                                      opening(Shape::kCylinder, 1.4, 0.1, 0.1, Axis::kLength),
                                      opening(Shape::kEllipsoid, 0.4, 0.4, 0.8)};
  for (const LuminousOpening& o : openings)
    for (const PhotometricType type : {PhotometricType::kA, PhotometricType::kB, PhotometricType::kC}) {
      const PhotometricLight l = light(test::lobed_table(type), o);
      EXPECT_EQ(light_power(l, rays_->metres_per_unit())[0], l.table->total_flux());
      EXPECT_NEAR(flux_through_sphere(l, l.position, 1.0) / l.table->total_flux(), 1, 1e-3)
          << static_cast<int>(o.shape);
    }
}

TEST_F(Emitters, the_same_for_points_and_spots) {
  const PointLight point{"p", {0.1, 0.2, 0.3}, room_.flat(2)};
  EXPECT_NEAR(
      flux_through_sphere(point, point.position, 1.5) * 2 / light_power(point, rays_->metres_per_unit())[0],
      1, 1e-3);
  const double cones[][2] = {{0, 0.3}, {0.2, 0.8}, {0.7, 1.5}, {0.5, 0.50005}};
  for (const auto& [inner, outer] : cones) {
    const SpotLight spot{"s", {0.1, 0.2, 0.3}, Vec3(0.6, 0, -0.8), room_.flat(3), inner, outer};
    EXPECT_NEAR(
        flux_through_sphere(spot, spot.position, 1.5) * 3 / light_power(spot, rays_->metres_per_unit())[0], 1,
        1e-3)
        << inner << " " << outer;
  }
}

TEST_F(Emitters, packets_start_on_the_opening_and_follow_the_intensities) {
  const PhotometricLight l = light(test::lobed_table(), opening(Shape::kBox, 0.8, 0.4, 0));
  const SobolSequence numbers(4);
  constexpr std::uint32_t kSamples = 1 << 14;
  // The power that packets carry into directions with luminaire x > 0, and the mean of their starts.
  double share = 0;
  Vec3 middle = Vec3::Zero();
  const PunctualEmitter emitter = make_punctual_emitter(l, *rays_);
  for (std::uint32_t k = 0; k < kSamples; ++k) {
    const LightRay ray = start_light_ray(emitter, numbers.sample(k, 0), numbers.sample(k, 1),
                                         numbers.sample(k, 2), numbers.sample(k, 3));
    const Vec3 d = l.orientation.transpose() * ray.direction.cast<double>();
    const Vec3 p = l.orientation.transpose() * (rays_->in_room(ray.origin) - l.position);
    EXPECT_GT(l.table->intensity(d), 0);
    EXPECT_LT(std::fabs(p.z()), 1e-4);
    EXPECT_LT(std::fabs(p.x()), 0.4 + 1e-4);
    EXPECT_LT(std::fabs(p.y()), 0.2 + 1e-4);
    share += d.x() > 0 ? 1.0 / kSamples : 0.0;
    middle += p / kSamples;
  }
  double expected = 0;
  double total = 0;
  constexpr int kSteps = 900;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double theta = pi * (i + 0.5) / kSteps;
      const Vec3 d = l.table->direction(theta, 2 * pi * (j + 0.5) / kSteps);
      const double part = l.table->intensity(d) * std::sin(theta);
      total += part;
      expected += d.x() > 0 ? part : 0;
    }
  EXPECT_NEAR(share, expected / total, 2e-3);
  EXPECT_LT(middle.norm(), 1e-3);
}

TEST_F(Emitters, point_luminaire_is_intensity_over_distance_squared) {
  const PhotometricLight l = light(test::lobed_table(), {});
  const Vec3 x(1.5, 2, -1);
  const Vec3 n = Vec3(-0.5, -1, 0.4).normalized();
  const Vec3 away = x - l.position;
  const double expected =
      l.table->intensity(l.orientation.transpose() * away) * -n.dot(away) / std::pow(away.norm(), 3);
  ASSERT_GT(expected, 0);
  EXPECT_NEAR(irradiance(l, x, n) / expected, 1, 1e-5);
}

TEST_F(Emitters, weight_is_about_the_irradiance) {
  PhotometricLight l = light(test::lambertian_table(), {});
  l.orientation.setIdentity();
  const Vec3 n = Vec3(0.2, -0.1, 1).normalized();
  for (const Vec3& to_light : {Vec3(0, 0, 2), Vec3(1, -0.5, 1), Vec3(-2, 1, 3)})
    for (const double size : {0.0, 0.3}) {
      l.opening = opening(Shape::kBox, size, size, 0);
      const double weight = static_cast<double>(PhotometricEmitter(l, *rays_).expected_irradiance(
          rays_->normalised(l.position - to_light), n.cast<float>()));
      EXPECT_NEAR(weight / irradiance(l, l.position - to_light, n), 1, 0.12) << to_light.transpose();
    }
}

TEST_F(Emitters, a_lambertian_opening_is_a_lambertian_panel_at_every_distance) {
  PhotometricLight l = light(test::lambertian_table(), opening(Shape::kBox, 1, 1, 0));
  l.orientation.setIdentity();
  l.position = Vec3(0, 0, 0);
  // Square of side 1 seen from its axis at height h, radiance 1: Lambert's polygon formula.
  for (const double h : {0.1, 0.5, 1.0, 3.0}) {
    const double s = std::hypot(h, 0.5);
    const double expected = 4 / s * 0.5 * std::atan(0.5 / s);
    EXPECT_NEAR(irradiance(l, Vec3(0, 0, -h), Vec3::UnitZ()) / expected, 1, h < 0.2 ? 5e-3 : 1e-3) << h;
  }
}

TEST_F(Emitters, at_five_times_the_size_a_point_is_off_by_about_one_percent) {
  // On the axis of a Lambertian opening of size s at distance h: 2 <rho^2> / h^2, <rho^2> its mean square
  // radius: s^2/6 for a square, s^2/12 for a line, s^2/8 for a disk; to first order in (s/h)^2.
  const struct {
    LuminousOpening opening;
    double off;
  } cases[] = {{opening(Shape::kBox, 0.5, 0.5, 0), 2.0 / 6 / 25},
               {opening(Shape::kBox, 0.5, 0, 0), 2.0 / 12 / 25},
               {opening(Shape::kCylinder, 0.5, 0.5, 0), 2.0 / 8 / 25}};
  for (const auto& c : cases) {
    PhotometricLight l = light(test::lambertian_table(), c.opening);
    l.orientation.setIdentity();
    l.position = Vec3(0, 0, 1);
    const Vec3 x(0, 0, 1 - 5 * 0.5);
    const double area = irradiance(l, x, Vec3::UnitZ());
    l.opening = {};
    EXPECT_NEAR(irradiance(l, x, Vec3::UnitZ()) / area - 1, c.off, 3e-4);
  }
}

TEST_F(Emitters, weight_is_above_zero_wherever_a_point_of_the_opening_is) {
  const PhotometricLight l = light(test::lobed_table(), opening(Shape::kBox, 1, 0.5, 0.2));
  const PhotometricEmitter e(l, *rays_);
  const SobolSequence numbers(6);
  int below = 0;
  for (std::uint32_t k = 0; k < 4096; ++k) {
    // Points within a metre with normals that put the centre about the horizon.
    const Vec3f d = sample_sphere(numbers.sample(k, 0), numbers.sample(k, 1));
    const Vec3 x = l.position + static_cast<double>(0.6F + 0.4F * numbers.sample(k, 2)) * d.cast<double>();
    const Vec3f n = (Frame(d).tangent + 0.5F * (numbers.sample(k, 3) - 0.5F) * d).normalized();
    const Vec3f at = rays_->normalised(x);
    bool lit = false;
    for (std::uint32_t i = 0; i < 64 && !lit; ++i)
      lit = e.sample(at, n, numbers.sample(i, 4), numbers.sample(i, 5)).factor > 0;
    if (!lit) continue;
    EXPECT_GT(e.expected_irradiance(at, n), 0);
    below += n.dot(d) > 0 ? 1 : 0;
  }
  EXPECT_GT(below, 100) << "of these, the centre was below the horizon";
}

TEST_F(Emitters, irradiance_stays_finite_at_the_opening) {
  const PhotometricLight l = light(test::lobed_table(), opening(Shape::kBox, 1, 1, 0));
  const PhotometricEmitter e(l, *rays_);
  const Vec3f at = rays_->normalised(l.position);
  const double most = l.table->greatest_intensity() / std::pow(PhotometricEmitter::kNearest, 2);
  for (float u = 0.499F; u < 0.501F; u += 1e-5F) {
    const LuminaireSample s = e.sample(at, Vec3f(0.6F, 0, -0.8F), u, 0.5F);
    EXPECT_LE(static_cast<double>(s.factor), most * 1.001);
  }
  EXPECT_TRUE(std::isfinite(e.expected_irradiance(at, Vec3f(0, 0, 1))));
}

TEST_F(Emitters, an_opening_in_the_plane_of_a_surface_shines_out_of_it) {
  PhotometricLight l = light(test::lambertian_table(), opening(Shape::kBox, 1, 1, 0));
  l.orientation.setIdentity();
  l.position = Vec3(0, 0, 4);  // the ceiling
  const PhotometricEmitter e(l, *rays_);
  const SobolSequence numbers(8);
  int seen = 0;
  int lost = 0;
  const PunctualEmitter emitter = make_punctual_emitter(l, *rays_);
  for (std::uint32_t k = 0; k < 1024; ++k) {
    const Vec3f x = rays_->normalised(Vec3(3 * static_cast<double>(numbers.sample(k, 2)) - 1, 1, -3.9));
    const LuminaireSample s = e.sample(x, Vec3f::UnitZ(), numbers.sample(k, 0), numbers.sample(k, 1));
    seen += s.factor > 0 && rays_->visible(x, s.target) ? 1 : 0;
    const LightRay ray = start_light_ray(emitter, numbers.sample(k, 0), numbers.sample(k, 1),
                                         numbers.sample(k, 2), numbers.sample(k, 3));
    Hit hit;
    if (!rays_->closest(ray.origin, ray.direction, hit) || !hit.front || hit.distance < 1e-3F) ++lost;
  }
  EXPECT_EQ(seen, 1024);
  EXPECT_EQ(lost, 0);
}

}  // namespace
}  // namespace reemit

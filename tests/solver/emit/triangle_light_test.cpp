#include "solver/emit/triangle_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "solver/sampling/sobol.h"
#include "tests/support/mean_test.h"

namespace reemit {
namespace {

using test::MeanTest;

/// Irradiance at the origin or another point from a polygon luminaire of the given radiance: Lambert's
/// polygon formula in 30-digit arithmetic.
struct PolygonCase {
  std::string name;
  std::vector<Vec3> corners;  // three or four
  double radiance;
  Vec3 point, normal;
  double irradiance;
};

std::vector<Vec3> rectangle(const Vec3& corner, const Vec3& u, const Vec3& v) {
  return {corner, corner + u, corner + u + v, corner + v};
}

std::vector<PolygonCase> polygon_cases() {
  const Vec3 x(1, 0, 0);
  const Vec3 y(0, 1, 0);
  return {
      {"corner", rectangle({0, 0, 1.5}, 2 * x, y), 1, {0, 0, 0}, {0, 0, 1}, 0.3844042141112864},
      {"center", rectangle({-0.5, -0.5, 1}, x, y), 1, {0, 0, 0}, {0, 0, 1}, 0.7522746884541075},
      {"tilted", rectangle({0, 0, 1.5}, 2 * x, y), 1, {0, 0, 0}, {1, 2, 3}, 0.41793037083087725},
      {"horizon", rectangle({-1, -0.5, 1}, 2 * x, y), 1, {0, 0, 0}, {1, 0, 0.2}, 0.3468685796954099},
      {"near", rectangle({-0.5, -0.5, 0.05}, x, y), 1, {0.3, 0.2, 0}, {0, 0, 1}, 3.075026604442819},
      {"far", rectangle({-0.5, -0.5, 20}, x, y), 1, {0, 0, 0}, {0, 0, 1}, 0.002497918487910833},
      {"wall", rectangle({1.5, 1.5, 3}, x, y), 100, {0, 2, 1}, {1, 0, 0}, 6.113724190096505},
      {"triangle", {{0, 0, 1}, {1, 0, 1.5}, {0, 1, 1.2}}, 1, {0.2, 0.1, 0}, {0, 0, 1}, 0.2590535231143838},
      {"triangle_horizon",
       {{2, -1, -0.5}, {2, 1, -0.5}, {2, 0, 1.5}},
       1,
       {0, 0, 0},
       {0, 0, 1},
       0.051732020620618616},
  };
}

/// The triangles of a polygon, turned towards the receiver.
std::vector<TriangleLight> lights_of(const PolygonCase& c) {
  std::vector<TriangleLight> lights;
  for (std::size_t i = 1; i + 1 < c.corners.size(); ++i) {
    TriangleLight light;
    light.a = c.corners[0].cast<float>();
    light.b = c.corners[i].cast<float>();
    light.c = c.corners[i + 1].cast<float>();
    const Vec3f cross = (light.b - light.a).cross(light.c - light.a);
    light.area = 0.5F * cross.norm();
    light.normal = cross.normalized();
    if (light.normal.dot(c.point.cast<float>() - light.a) < 0) light.normal = -light.normal;
    light.longest_edge2 = std::max({(light.b - light.a).squaredNorm(), (light.c - light.b).squaredNorm(),
                                    (light.a - light.c).squaredNorm()});
    lights.push_back(light);
  }
  return lights;
}

class PolygonIrradiance : public testing::TestWithParam<PolygonCase> {};
void PrintTo(const PolygonCase& c, std::ostream* os) {
  *os << c.name;
}

TEST_P(PolygonIrradiance, unoccluded_value_is_lamberts) {
  const PolygonCase& c = GetParam();
  double sum = 0;
  for (const TriangleLight& light : lights_of(c))
    sum += c.radiance * static_cast<double>(unoccluded_irradiance(light, c.point.cast<float>(),
                                                                  c.normal.normalized().cast<float>()));
  // Beyond two edge lengths the far-field limit stands in: 10 % is close enough for a choice.
  EXPECT_NEAR(sum, c.irradiance, (c.name == "far" || c.name == "wall" ? 0.1 : 1e-4) * c.irradiance);
}

TEST_P(PolygonIrradiance, samples_have_the_right_mean) {
  const PolygonCase& c = GetParam();
  const Vec3f x = c.point.cast<float>();
  const Vec3f n = c.normal.normalized().cast<float>();
  MeanTest total;
  for (std::uint64_t replicate = 0; replicate < 64; ++replicate) {
    const SobolSequence sequence(1000 + replicate);
    double sum = 0;
    for (const TriangleLight& light : lights_of(c))
      for (std::uint32_t i = 0; i < 256; ++i) {
        TriangleLightSample sample;
        const float u0 = sequence.sample(i, 0);
        const float u1 = sequence.sample(i, 1);
        if (sample_triangle_light(light, x, n, u0, u1, sample))
          sum += c.radiance * static_cast<double>(sample.factor) / 256;
      }
    total.add(sum);
  }
  EXPECT_TRUE(total.agrees_with(c.irradiance));
  EXPECT_TRUE(total.would_notice(0.02, c.irradiance));
  EXPECT_FALSE(total.agrees_with(1.02 * c.irradiance)) << "a bias of 2 % must not pass";
}

INSTANTIATE_TEST_SUITE_P(closed_forms, PolygonIrradiance, testing::ValuesIn(polygon_cases()),
                         [](const auto& test_case) { return test_case.param.name; });

TEST(TriangleLight, solid_angle_sampling_tames_the_near_field) {
  // Uniform-area samples of this case have a relative deviation of 6.6; solid-angle samples are bounded by
  // the cosine.
  const PolygonCase c = polygon_cases()[4];
  MeanTest single;
  const SobolSequence sequence(7);
  for (std::uint32_t i = 0; i < 4096; ++i) {
    double sum = 0;
    for (const TriangleLight& light : lights_of(c)) {
      TriangleLightSample sample;
      if (sample_triangle_light(light, c.point.cast<float>(), c.normal.cast<float>(), sequence.sample(i, 0),
                                sequence.sample(i, 1), sample))
        sum += static_cast<double>(sample.factor);
    }
    single.add(sum);
  }
  EXPECT_LT(single.standard_error() * 64 / c.irradiance, 0.8);
}

TEST(TriangleLight, gives_nothing_behind_itself_or_below_the_horizon) {
  TriangleLight light;
  light.a = {0, 0, 1};
  light.b = {0, 1, 1};
  light.c = {1, 0, 1};
  light.normal = {0, 0, -1};
  light.area = 0.5F;
  light.longest_edge2 = 2;
  TriangleLightSample sample;
  const Vec3f up(0, 0, 1);
  EXPECT_GT(unoccluded_irradiance(light, {0, 0, 0}, up), 0);
  EXPECT_EQ(unoccluded_irradiance(light, {0, 0, 2}, -up), 0);
  EXPECT_FALSE(sample_triangle_light(light, {0, 0, 2}, -up, 0.5F, 0.5F, sample));
  EXPECT_EQ(unoccluded_irradiance(light, {0, 0, 0}, -up), 0);
  EXPECT_FALSE(sample_triangle_light(light, {0, 0, 0}, -up, 0.5F, 0.5F, sample));
}

TEST(TriangleLight, needles_and_points_give_finite_numbers) {
  TriangleLight needle;
  needle.a = {0, 0, 1};
  needle.b = {1, 0, 1};
  needle.c = {0.5F, 1e-7F, 1};
  needle.normal = {0, 0, -1};
  needle.area = 0.5e-7F;
  needle.longest_edge2 = 1;
  const Vec3f up(0, 0, 1);
  for (const Vec3f& x : {Vec3f(0, 0, 0), Vec3f(0.5F, 0, 1), Vec3f(0.5F, 0, 0.999999F), needle.a}) {
    EXPECT_TRUE(std::isfinite(unoccluded_irradiance(needle, x, up)));
    for (const float u : {0.0F, 0.5F, 0x1.fffffep-1F}) {
      TriangleLightSample sample;
      if (sample_triangle_light(needle, x, up, u, u, sample)) {
        EXPECT_TRUE(std::isfinite(sample.factor));
        EXPECT_GE(sample.u, 0);
        EXPECT_LE(sample.u + sample.v, 1 + 1e-6F);
      }
    }
  }
}

}  // namespace
}  // namespace reemit

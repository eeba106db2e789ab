#include "solver/sampling/shapes/polygon_sampler.h"

#include <cmath>
#include <numbers>

#include "solver/sampling/shapes/rectangle_sampler.h"
#include "tests/solver/sampling/shapes/shape_cases.h"

namespace reemit {
namespace {

using test::ShapeCase;

struct Rectangle {
  Vec3 corner, u, v;
  Vec3 front{0, 0, -1};
};
using Triangle = std::array<Vec3, 3>;
using Polygon = std::vector<Vec3>;

RectangleSampler make_rectangle(const Rectangle& r, const Vec3& x, const Vec3& n, Density d) {
  return {r.corner, r.u, r.v, r.front, x, n, d};
}
Vec3 facing(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& x) {
  const Vec3 normal = (b - a).cross(c - a).normalized();
  return normal.dot(x - a) > 0 ? normal : Vec3(-normal);
}
TriangleSampler make_triangle(const Triangle& t, const Vec3& x, const Vec3& n, Density d) {
  return {t, facing(t[0], t[1], t[2], x), x, n, d};
}
ConvexPolygonSampler make_polygon(const Polygon& p, const Vec3& x, const Vec3& n, Density d) {
  return {p, facing(p[0], p[1], p[2], x), x, n, d};
}

/// Lambert's polygon formula with 30 digits, cut at the horizon where it crosses.
const std::vector<ShapeCase<Rectangle>>& rectangles() {
  static const std::vector<ShapeCase<Rectangle>> all{
      {"corner", {{0, 0, 1.5}, {2, 0, 0}, {0, 1, 0}}, {0, 0, 0}, {0, 0, 1}, 0.3844042141112864},
      {"centre", {{-0.5, -0.5, 1}, {1, 0, 0}, {0, 1, 0}}, {0, 0, 0}, {0, 0, 1}, 0.7522746884541075},
      {"tilted", {{0, 0, 1.5}, {2, 0, 0}, {0, 1, 0}}, {0, 0, 0}, {1, 2, 3}, 0.41793037083087725},
      {"horizon", {{-1, -0.5, 1}, {2, 0, 0}, {0, 1, 0}}, {0, 0, 0}, {1, 0, 0.2}, 0.3468685796954099},
      {"wall", {{1.5, 1.5, 3}, {1, 0, 0}, {0, 1, 0}}, {0, 2, 1}, {1, 0, 0}, 0.06113724190096505},
      {"far", {{-0.5, -0.5, 20}, {1, 0, 0}, {0, 1, 0}}, {0, 0, 0}, {0, 0, 1}, 0.002497918487910833},
      {"near", {{-0.5, -0.5, 0.05}, {1, 0, 0}, {0, 1, 0}}, {0.3, 0.2, 0}, {0, 0, 1}, 3.075026604442819},
  };
  return all;
}
const std::vector<ShapeCase<Triangle>>& triangles() {
  static const std::vector<ShapeCase<Triangle>> all{
      {"general", {{{0, 0, 1}, {1, 0, 1.5}, {0, 1, 1.2}}}, {0.2, 0.1, 0}, {0, 0, 1}, 0.2590535231143838},
      {"horizon", {{{2, -1, -0.5}, {2, 1, -0.5}, {2, 0, 1.5}}}, {0, 0, 0}, {0, 0, 1}, 0.051732020620618616},
  };
  return all;
}

/// Regular polygon about the axis at height h: Lambert's formula has the same term for every edge.
double regular_irradiance(int corners, double radius, double h) {
  const double half = std::numbers::pi / corners;
  const double inner = radius * std::cos(half);
  const double angle = 2 * std::atan(radius * std::sin(half) / std::hypot(inner, h));
  return 0.5 * corners * angle * inner / std::hypot(inner, h);
}
Polygon regular(int corners, double radius, double h) {
  Polygon p;
  for (int i = 0; i < corners; ++i) {
    const double phi = 2 * std::numbers::pi * i / corners + 0.1;
    p.push_back({radius * std::cos(phi), radius * std::sin(phi), h});
  }
  return p;
}
const std::vector<ShapeCase<Polygon>>& polygons() {
  static const std::vector<ShapeCase<Polygon>> all{
      {"pentagon", regular(5, 1, 0.7), {0, 0, 0}, {0, 0, 1}, regular_irradiance(5, 1, 0.7)},
      {"16 corners", regular(16, 2, 1), {0, 0, 0}, {0, 0, 1}, regular_irradiance(16, 2, 1)},
      {"hexagon beside", regular(6, 1, 1), {2, 0.5, 0}, {0, 0.1, 1}, -1},
      {"16 corners on the horizon", regular(16, 1, 1), {0.5, 0, 0}, {1, 0.2, 0}, -1},
  };
  return all;
}

double area(const Rectangle& r) {
  return r.u.norm() * r.v.norm();
}
double area(const Polygon& p) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < p.size(); ++i) sum += 0.5 * (p[i] - p[0]).cross(p[i + 1] - p[0]).norm();
  return sum;
}
bool no_variance(Density d) {
  return d == Density::kCosine;
}

TEST(PolygonSampler, MeansOfRectanglesAreLambertsFormula) {
  test::expect_means(rectangles(), make_rectangle, no_variance);
}
TEST(PolygonSampler, MeansOfTrianglesAreLambertsFormula) {
  test::expect_means(triangles(), make_triangle, no_variance);
}
TEST(PolygonSampler, MeansOfPolygonsAreLambertsFormula) {
  test::expect_means(polygons(), make_polygon, no_variance);
}

TEST(PolygonSampler, SamplesAndInverseOfRectanglesFollowTheDensity) {
  const std::vector<ShapeCase<Rectangle>> some(rectangles().begin(), rectangles().begin() + 5);
  test::expect_densities(some, make_rectangle, [](const Rectangle& r) { return area(r); });
}
TEST(PolygonSampler, SamplesAndInverseOfTrianglesFollowTheDensity) {
  test::expect_densities(triangles(), make_triangle,
                         [](const Triangle& t) { return area(Polygon(t.begin(), t.end())); });
}
TEST(PolygonSampler, SamplesAndInverseOfPolygonsFollowTheDensity) {
  test::expect_densities(polygons(), make_polygon, [](const Polygon& p) { return area(p); });
}

TEST(PolygonSampler, BothFitsRejectAPlantedBias) {
  const ShapeCase<Triangle>& c = triangles()[1];
  const double size = area(Polygon(c.shape.begin(), c.shape.end()));
  const TriangleSampler by_area = make_triangle(c.shape, c.x, c.n, Density::kArea);
  for (const Density d : {Density::kSolidAngle, Density::kCosine}) {
    const TriangleSampler sampler = make_triangle(c.shape, c.x, c.n, d);
    EXPECT_LT(test::fit_of_samples(sampler, by_area, size, c.x, test::kManyDraws, 0.02).odds,
              test::kFalseAlarm);
    EXPECT_LT(test::fit_of_inverse(sampler, by_area, size, c.x, test::kManyDraws, 0.04), test::kFalseAlarm);
  }
}

TEST(PolygonSampler, ClosedFormIsTheSameForAllDensities) {
  for (const Density d : test::kDensities) {
    for (const auto& c : rectangles())
      EXPECT_NEAR(make_rectangle(c.shape, c.x, c.n.normalized(), d).irradiance() / c.irradiance, 1, 1e-12)
          << c.name;
    for (const auto& c : triangles())
      EXPECT_NEAR(make_triangle(c.shape, c.x, c.n, d).irradiance() / c.irradiance, 1, 1e-12) << c.name;
  }
}

TEST(PolygonSampler, DensitiesOfPolygonsAgree) {
  for (const auto& c : polygons()) {
    const Vec3 n = c.n.normalized();
    const double truth = make_polygon(c.shape, c.x, n, Density::kCosine).irradiance();
    for (const Density d : test::kDensities) {
      const auto s = test::statistics(make_polygon(c.shape, c.x, n, d), c.x, n, 100'000, 6);
      EXPECT_LT(std::fabs(s.mean - truth), 4 * s.error + 1e-9 * truth) << c.name << ", " << test::name_of(d);
    }
  }
}

TEST(PolygonSampler, FrontAndBackRotationsOfTheCornersAreTheSame) {
  Polygon p = regular(7, 1, 1);
  const Vec3 x(1.8, -0.3, 0);
  const Vec3 n = Vec3(-0.3, 0.1, 1).normalized();
  for (const Density d : test::kDensities) {
    const double forward = make_polygon(p, x, n, d).irradiance();
    Polygon reversed(p.rbegin(), p.rend());
    EXPECT_NEAR(make_polygon(reversed, x, n, d).irradiance(), forward, 1e-14);
  }
}

}  // namespace
}  // namespace reemit

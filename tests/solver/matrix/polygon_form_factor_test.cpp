// Exact form factors against closed forms and against quadrature of Lambert's polygon formula.
#include "solver/matrix/polygon_form_factor.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace reemit {
namespace {

ConvexPolygon polygon(const std::vector<Vec3>& corners) {
  ConvexPolygon p;
  for (const Vec3& c : corners) p.add(c);
  p.normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  return p;
}

double exchange_area(const ConvexPolygon& a, const ConvexPolygon& b) {
  return unoccluded_exchange_area(facing_parts(a, b));
}

/// Irradiance over radiosity at x with normal n from the part of a polygon above the horizon: Lambert's
/// formula. The polygon is seen from its front.
double point_form_factor(const Vec3& x, const Vec3& n, const ConvexPolygon& p) {
  if (p.normal.dot(x - p.corner[0]) <= 0) return 0;
  const ConvexPolygon part = part_in_front(p, x, n, 0);
  double sum = 0;
  for (std::size_t k = 0; k < part.count; ++k) {
    const Vec3 a = part.corner[k] - x;
    const Vec3 b = part.corner[(k + 1) % part.count] - x;
    const Vec3 cross = a.cross(b);
    const double sine = cross.norm();
    if (sine > 0) sum += n.dot(cross) / sine * std::atan2(sine, a.dot(b));
  }
  return std::fabs(sum) / (2 * std::numbers::pi);
}

/// Integral of the point form factor over a triangle by `n`^2 tensor midpoints under a map that crowds them
/// at all sides.
double quadrature(const ConvexPolygon& a, const ConvexPolygon& b, int n) {
  const auto crowded = [](double t) { return t * t * t * (10 + t * (-15 + 6 * t)); };
  const auto density = [](double t) { return 30 * t * t * (1 - t) * (1 - t); };
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double s = (i + 0.5) / n;
      const double t = (j + 0.5) / n;
      const double u = crowded(s);
      const double v = crowded(t);
      const Vec3 x =
          a.corner[0] + u * ((1 - v) * (a.corner[1] - a.corner[0]) + v * (a.corner[2] - a.corner[0]));
      sum += density(s) * density(t) * u * point_form_factor(x, a.normal, b);
    }
  return 2 * a.area() * sum / (n * n);
}

ConvexPolygon rectangle(const Vec3& corner, const Vec3& u, const Vec3& v) {
  return polygon({corner, corner + u, corner + u + v, corner + v});
}

constexpr double kTight = 2e-13;

TEST(PolygonFormFactor, ParallelSquaresHaveTheirClosedForm) {
  const ConvexPolygon floor = rectangle(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY());
  const auto facing_down = [](double z) { return rectangle(Vec3(0, 0, z), Vec3::UnitY(), Vec3::UnitX()); };
  EXPECT_NEAR(exchange_area(floor, facing_down(1)), 0.19982489569838738, kTight);
  EXPECT_NEAR(exchange_area(floor, facing_down(0.1)), 0.8269945223972566, kTight);
  EXPECT_NEAR(exchange_area(floor, facing_down(5)), 0.012403977313245102, kTight);
  EXPECT_NEAR(exchange_area(rectangle(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()),
                            rectangle(Vec3(0.5, 1, 0.7), Vec3(0, 2, 0), Vec3(1.5, 0, 0))),
              0.09671804195305503, kTight);
}

TEST(PolygonFormFactor, PerpendicularRectanglesHaveTheirClosedForm) {
  const ConvexPolygon floor = rectangle(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY());
  const ConvexPolygon wall = rectangle(Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX());
  EXPECT_NEAR(exchange_area(floor, wall), 0.20004377607540316, kTight);
  EXPECT_NEAR(exchange_area(wall, floor), 0.20004377607540316, kTight);
  // Common edge of length 1, 2 on the floor, 3 on the wall.
  EXPECT_NEAR(exchange_area(rectangle(Vec3::Zero(), Vec3::UnitX(), Vec3(0, 2, 0)),
                            rectangle(Vec3::Zero(), Vec3(0, 0, 3), Vec3::UnitX())),
              2 * 0.16169401433302757, kTight);
  // With gaps: [0.5,1]x[0,1] on the floor, [0.2,2] along the edge at heights [0.5,3].
  EXPECT_NEAR(exchange_area(rectangle(Vec3(0, 0.5, 0), Vec3::UnitX(), Vec3(0, 0.5, 0)),
                            rectangle(Vec3(0.5, 0, 0.2), Vec3(0, 0, 1.8), Vec3(2.5, 0, 0))),
              0.5 * 0.14633711664838023, kTight);
}

TEST(PolygonFormFactor, RowsOfACubeOfTwelveTrianglesSumToOne) {
  const auto p = [](int i) { return Vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1); };
  std::vector<ConvexPolygon> zones;
  for (const auto& q :
       {std::array{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}}) {
    zones.push_back(polygon({p(q[0]), p(q[1]), p(q[2])}));
    zones.push_back(polygon({p(q[0]), p(q[2]), p(q[3])}));
  }
  for (const ConvexPolygon& a : zones) {
    double sum = 0;
    for (const ConvexPolygon& b : zones)
      if (&a != &b) sum += exchange_area(a, b);
    EXPECT_NEAR(sum / a.area(), 1, 1e-12);
  }
}

TEST(PolygonFormFactor, CoplanarHiddenAndTurnedPairsAreExactlyZero) {
  const ConvexPolygon a = polygon({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)});
  EXPECT_EQ(exchange_area(a, polygon({Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)})), 0);
  EXPECT_EQ(exchange_area(a, polygon({Vec3(0, 0, -1), Vec3(1, 0, -1), Vec3(0, 1, -1)})), 0) << "behind";
  EXPECT_EQ(exchange_area(a, polygon({Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(0, 1, 1)})), 0) << "faces away";
  EXPECT_GT(exchange_area(a, polygon({Vec3(0, 0, 1), Vec3(0, 1, 1), Vec3(1, 0, 1)})), 0);
}

TEST(PolygonFormFactor, AnyPlaceAndSizeGivesTheSame) {
  for (const double scale : {1e-3, 1.0, 1e6})
    for (const double shift : {0.0, 1e3}) {
      const Vec3 o = scale * shift * Vec3(1, -2, 0.5);
      const double f = exchange_area(rectangle(o, scale * Vec3::UnitX(), scale * Vec3::UnitY()),
                                     rectangle(o, scale * Vec3::UnitZ(), scale * Vec3::UnitX())) /
                       (scale * scale);
      EXPECT_NEAR(f, 0.20004377607540316, shift > 0 ? 1e-11 : kTight) << scale << " " << shift;
    }
}

TEST(PolygonFormFactor, TrianglesInAnyPositionMatchQuadratureOfLambertsFormula) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto point = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  int clipped = 0;
  int seen = 0;
  for (int k = 0; k < 60; ++k) {
    const ConvexPolygon a = polygon({point(), point(), point()});
    const ConvexPolygon b =
        polygon({point() + Vec3(0, 0, 1), point() + Vec3(0, 0, 1), point() + Vec3(0, 0, 1)});
    const FacingPair pair = facing_parts(a, b);
    const double exact = unoccluded_exchange_area(pair);
    EXPECT_NEAR(exact, exchange_area(b, a), 1e-13) << "reciprocity";
    if (pair.empty()) continue;
    // Quadrature over the clipped part, triangle by triangle: the integrand is smooth there.
    double expected = 0;
    for (std::size_t c = 2; c < pair.a.count; ++c)
      expected +=
          quadrature(polygon({pair.a.corner[0], pair.a.corner[c - 1], pair.a.corner[c]}), pair.b, 400);
    EXPECT_NEAR(exact, expected, 5e-7) << k;  // what the quadrature leaves where parts touch
    ++seen;
    if (pair.a.count > 3 || pair.b.count > 3) ++clipped;
  }
  EXPECT_GT(seen, 20);
  EXPECT_GT(clipped, 10);
}

TEST(PolygonFormFactor, PartsAddUpToTheWhole) {
  // Parts differ from the whole in every edge integral, so this measures the accuracy far below quadrature.
  std::mt19937 random(17);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto point = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  double worst = 0;
  for (int k = 0; k < 400; ++k) {
    std::array<Vec3, 3> b{point(), point(), point()};
    // Apart, crossing each other's planes, with a common corner, with a common edge.
    const std::array<Vec3, 3> a{k % 4 >= 2 ? b[0] : point(), k % 4 >= 3 ? b[1] : point(), point()};
    if (k % 4 == 0)
      for (Vec3& p : b) p += Vec3(0, 0, 2);
    if (k % 4 == 3) std::swap(b[0], b[1]);
    const ConvexPolygon whole = polygon({b[0], b[1], b[2]});
    const ConvexPolygon other = polygon({a[0], a[1], a[2]});
    const Vec3 inside = 0.2 * b[0] + 0.5 * b[1] + 0.3 * b[2];
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) sum += exchange_area(other, polygon({b[c], b[(c + 1) % 3], inside}));
    worst = std::max(worst, std::fabs(sum - exchange_area(other, whole)));
  }
  EXPECT_LT(worst, 2e-12) << worst;
}

TEST(PolygonFormFactor, SharedCornersAndSliversMatchQuadrature) {
  const ConvexPolygon a = polygon({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)});
  const std::vector<ConvexPolygon> others{
      polygon({Vec3(0, 0, 0), Vec3(-0.5, 0.2, 0.8), Vec3(-0.4, -0.6, 0.3)}),           // a corner
      polygon({Vec3(0, 0, 0), Vec3(0.3, -0.2, 1), Vec3(1, 0, 0)}),                     // an edge
      polygon({Vec3(0.2, 0, 0), Vec3(0.3, -0.1, 1), Vec3(0.7, 0, 0)}),                 // part of an edge
      polygon({Vec3(0, 0, 0), Vec3(0.5, -1e-3, 0.2), Vec3(1, 1e-4, 1e-4)}),            // almost an edge
      polygon({Vec3(0.3, 0.2, 0), Vec3(0.5, 0.8, 0.4), Vec3(0.31, 0.21, 0.9)}),        // stands on it
      polygon({Vec3(0, 0, 1e-4), Vec3(0, 1, 1e-4), Vec3(1, 0, 1e-4)}),                 // just above it
      polygon({Vec3(0.1, 0.1, 1e-3), Vec3(0.1, 0.100001, 2), Vec3(0.10001, 0.1, 1)}),  // sliver
  };
  for (std::size_t k = 0; k < others.size(); ++k) {
    const FacingPair pair = facing_parts(a, others[k]);
    const double exact = unoccluded_exchange_area(pair);
    double expected = 0;
    for (std::size_t c = 2; c < pair.a.count; ++c)
      expected +=
          quadrature(polygon({pair.a.corner[0], pair.a.corner[c - 1], pair.a.corner[c]}), pair.b, 1500);
    EXPECT_NEAR(exact, expected, 5e-8) << k;
  }
}

}  // namespace
}  // namespace reemit

#include "solver/matrix/edge_integral.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace reemit {
namespace {

constexpr std::size_t kHighestOrder = 18;
/// Pieces whose integrand is analytic within a Bernstein ellipse of this parameter are not halved: a rule of
/// kHighestOrder points then leaves kTolerance.
constexpr double kSmallestEllipse = 2.4;
constexpr double kLogTolerance = 30;  // -ln of the relative error of a rule
/// Below this fraction of the edge a piece that still touches a singularity is not halved any more. The
/// integrand is continuous there, so what is left is of the order of the square of this.
constexpr double kShortestPiece = 0x1p-24;
/// Edges whose directions differ by less than this are parallel: the integral changes by less than it times
/// the product of the lengths.
constexpr double kParallel = 1e-11;
/// Parallel edges closer than the ellipse of this parameter are integrated in closed form; beyond, the closed
/// form cancels and a rule of few points is as quick.
constexpr double kNearParallel = 8;

struct GaussRule {
  std::size_t order = 0;
  std::array<double, kHighestOrder> node{};  // in [-1,1]
  std::array<double, kHighestOrder> weight{};
};

/// Legendre polynomial of the given order and its derivative.
std::pair<double, double> legendre(std::size_t order, double x) {
  double previous = 1;
  double value = x;
  for (std::size_t k = 2; k <= order; ++k) {
    const auto n = static_cast<double>(k);
    previous = std::exchange(value, ((2 * n - 1) * x * value - (n - 1) * previous) / n);
  }
  return {value, static_cast<double>(order) * (x * value - previous) / (x * x - 1)};
}

GaussRule make_rule(std::size_t order) {
  GaussRule rule;
  rule.order = order;
  for (std::size_t i = 0; i < order; ++i) {
    double x =
        std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (static_cast<double>(order) + 0.5));
    for (int step = 0; step < 20; ++step) {
      const auto [value, slope] = legendre(order, x);
      const double change = value / slope;
      x -= change;
      if (std::fabs(change) < 1e-16) break;
    }
    const double slope = legendre(order, x).second;
    rule.node[i] = x;
    rule.weight[i] = 2 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

const GaussRule& rule_of_order(std::size_t order) {
  static const auto rules = [] {
    std::array<GaussRule, kHighestOrder + 1> all;
    for (std::size_t n = 2; n <= kHighestOrder; ++n) all[n] = make_rule(n);
    return all;
  }();
  return rules[order];
}

/// u/2 ln(u^2 + h^2), 0 in the limit.
double weighted_log(double u, double h2) {
  const double r2 = u * u + h2;
  return r2 > 0 ? 0.5 * u * std::log(r2) : 0;
}

/// Integral of ln r along the edge q seen from the point x.
double log_potential(const Vec3& x, const Edge& q) {
  const Vec3 from_start = x - q.start;
  const double foot = from_start.dot(q.direction);
  const double h2 = (from_start - foot * q.direction).squaredNorm();
  const double u0 = -foot;
  const double u1 = q.length - foot;
  const double h = std::sqrt(h2);
  // atan(u1/h) - atan(u0/h) without the cancellation.
  const double angle = std::atan2(h * q.length, h2 + u0 * u1);
  return weighted_log(u1, h2) - weighted_log(u0, h2) - q.length + h * angle;
}

/// Twice integrated ln sqrt(u^2 + h^2), up to terms that differences cancel.
double twice_integrated_log(double u, double h) {
  const double r2 = u * u + h * h;
  if (!(r2 > 0)) return 0;
  const double across = h > 0 ? h * u * std::atan(u / h) : 0;
  return 0.25 * (u * u - h * h) * std::log(r2) - 0.75 * u * u + across;
}

double parallel_integral(const Edge& p, const Edge& q) {
  const Vec3 offset = p.start + 0.5 * p.length * p.direction - q.start;
  const double middle = offset.dot(q.direction);
  const double h = (offset - middle * q.direction).norm();
  const double a = middle - 0.5 * p.length;
  const double b = middle + 0.5 * p.length;
  return twice_integrated_log(q.length - a, h) - twice_integrated_log(q.length - b, h) -
         twice_integrated_log(-a, h) + twice_integrated_log(-b, h);
}

/// Where along the line of p the potential of q is singular: as complex arc lengths, (position, height).
/// There is one singularity per end of q, and one where the lines pass each other if that is beside q.
struct Singularities {
  std::array<std::pair<double, double>, 3> at;
  std::size_t count = 0;
  bool parallel = false;

  Singularities(const Edge& p, const Edge& q) {
    for (const Vec3& end : {q.start, q.end()}) {
      const Vec3 offset = end - p.start;
      const double along = offset.dot(p.direction);
      at[count++] = {along, (offset - along * p.direction).norm()};
    }
    const Vec3 cross = p.direction.cross(q.direction);
    const double sine = cross.norm();
    parallel = sine < kParallel;
    if (parallel) return;
    const Vec3 offset = q.start - p.start;
    const double along_q = offset.cross(p.direction).dot(cross) / (sine * sine);
    if (along_q < -kShortestPiece * q.length || along_q > (1 + kShortestPiece) * q.length) return;
    const double along_p = offset.cross(q.direction).dot(cross) / (sine * sine);
    at[count++] = {along_p, std::fabs(offset.dot(cross)) / (sine * sine)};
  }

  /// Parameter of the largest Bernstein ellipse about the piece [s0, s1] without a singularity inside, >= 1.
  double ellipse(double s0, double s1) const {
    double nearest = 1e300;
    for (std::size_t k = 0; k < count; ++k) {
      const auto [position, height] = at[k];
      nearest = std::min(nearest, std::hypot(position - s0, height) + std::hypot(position - s1, height));
    }
    const double a = std::max(1.0, nearest / (s1 - s0));
    return a + std::sqrt(a * a - 1);
  }
};

double piecewise_integral(const Edge& p, const Edge& q, const Singularities& singularities, double s0,
                          double s1) {
  const double ellipse = singularities.ellipse(s0, s1);
  const double middle = 0.5 * (s0 + s1);
  const bool smooth = ellipse >= kSmallestEllipse;
  if (!smooth && s1 - s0 > kShortestPiece * p.length)
    return piecewise_integral(p, q, singularities, s0, middle) +
           piecewise_integral(p, q, singularities, middle, s1);
  const auto order =
      smooth ? static_cast<std::size_t>(std::ceil(0.5 * kLogTolerance / std::log(ellipse))) : std::size_t{4};
  const GaussRule& rule = rule_of_order(std::clamp<std::size_t>(order, 2, kHighestOrder));
  const double half = 0.5 * (s1 - s0);
  double sum = 0;
  for (std::size_t i = 0; i < rule.order; ++i)
    sum += rule.weight[i] * log_potential(p.start + (middle + half * rule.node[i]) * p.direction, q);
  return half * sum;
}

}  // namespace

double integral_of_log_distance(const Edge& p, const Edge& q) {
  const bool p_is_shorter = p.length <= q.length;
  const Edge& outer = p_is_shorter ? p : q;
  const Edge& inner = p_is_shorter ? q : p;
  const Singularities singularities(outer, inner);
  if (singularities.parallel && singularities.ellipse(0, outer.length) < kNearParallel) {
    // The closed form wants edges that run the same way.
    const bool same_way = outer.direction.dot(inner.direction) > 0;
    const Edge turned = same_way ? outer : Edge{outer.end(), -outer.direction, outer.length};
    return parallel_integral(turned, inner);
  }
  return piecewise_integral(outer, inner, singularities, 0, outer.length);
}

}  // namespace reemit

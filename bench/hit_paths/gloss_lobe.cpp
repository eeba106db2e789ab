#include "bench/hit_paths/gloss_lobe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace reemit::hit_paths {
namespace {

constexpr double kCosineShare = 0.25;

/// Facets of GGX by the angle of their normal to that of the surface [WAL07, eq. 33].
double ggx_facets(double alpha, double cosine) {
  if (!(cosine > 0)) return 0;
  const double tangent2 = (1 - cosine * cosine) / (cosine * cosine);
  const double a2 = alpha * alpha;
  return a2 / (std::numbers::pi * std::pow(cosine, 4) * std::pow(a2 + tangent2, 2));
}

/// Smith's hidden over seen area.
double ggx_hidden(double alpha, double cosine) {
  const double tangent2 = (1 - cosine * cosine) / (cosine * cosine);
  return (std::sqrt(1 + alpha * alpha * std::max(0.0, tangent2)) - 1) / 2;
}

double ggx(double alpha, const Vec3& n, const Vec3& i, const Vec3& o) {
  const double ci = n.dot(i);
  const double co = n.dot(o);
  const double seen = 1 / (1 + ggx_hidden(alpha, ci) + ggx_hidden(alpha, co));
  return ggx_facets(alpha, n.dot((i + o).normalized())) * seen / (4 * ci * co);
}

double ward(double alpha, const Vec3& n, const Vec3& i, const Vec3& o) {
  const Vec3 h = i + o;
  const double hz = n.dot(h);
  const double across2 = n.cross(h).squaredNorm();
  const double a2 = alpha * alpha;
  return std::exp(-across2 / (a2 * hz * hz)) / (std::numbers::pi * a2) * h.squaredNorm() / std::pow(hz, 4);
}

Vec3 mirrored_at(const Vec3& n, const Vec3& i) {
  return (2 * n.dot(i) * n - i).normalized();
}

double phong(double alpha, const Vec3& n, const Vec3& i, const Vec3& o) {
  const double exponent = std::max(0.0, 2 / (alpha * alpha) - 2);
  const double cosine = mirrored_at(n, i).dot(o);
  return cosine > 0 ? (exponent + 2) / (2 * std::numbers::pi) * std::pow(cosine, exponent) : 0;
}

/// Phong's lobe is round about the mirror direction, as that of facets is only where they are seen head-on;
/// there the angle to the mirror direction is twice that of the facet.
bool is_about_mirror(GlossLobe lobe) {
  return lobe == GlossLobe::kPhong;
}
constexpr double kHeadOn = 0.6;  ///< Times alpha: a little wider than cos^n.

}  // namespace

double lobe_value(GlossLobe lobe, double alpha, const Vec3& normal, const Vec3& from, const Vec3& to) {
  if (!(normal.dot(from) > 0 && normal.dot(to) > 0)) return 0;
  switch (lobe) {
    case GlossLobe::kGgx:
      return ggx(alpha, normal, from, to);
    case GlossLobe::kWard:
      return ward(alpha, normal, from, to);
    case GlossLobe::kPhong:
      return phong(alpha, normal, from, to);
  }
  return 0;
}

double facet_angle(const Vec3& from, const Vec3& to) {
  return std::atan2(from.cross(to).norm(), from.dot(to)) / 2;
}

LobeDraw draw_about_lobe(GlossLobe lobe, double alpha, const Vec3& normal, const Vec3& from,
                         PathRandom& random) {
  const bool about_mirror = is_about_mirror(lobe);
  const double width = about_mirror ? kHeadOn * alpha : alpha;
  const Vec3 mirror = mirrored_at(normal, from);
  LobeDraw draw;
  if (uniform(random) < kCosineShare)
    draw.direction = cosine_direction(normal, random);
  else
    draw.direction = about_mirror ? mirrored_at(draw_facet(width, mirror, random), mirror)
                                  : mirrored_at(draw_facet(width, normal, random), from);
  // Of facets over the solid angle of what they mirror.
  const Vec3 half = ((about_mirror ? mirror : from) + draw.direction).normalized();
  const double cosine = half.dot(about_mirror ? mirror : normal);
  const double mirrored = std::abs(half.dot(draw.direction));
  const double bell = mirrored > 0 ? ggx_facets(width, cosine) * cosine / (4 * mirrored) : 0;
  draw.pdf =
      kCosineShare * std::max(0.0, normal.dot(draw.direction)) / std::numbers::pi + (1 - kCosineShare) * bell;
  return draw;
}

Vec3 draw_facet(double alpha, const Vec3& normal, PathRandom& random) {
  const double u = uniform(random);
  return direction_about(normal, std::sqrt((1 - u) / (1 - u + alpha * alpha * u)), random);
}

double unhidden(double alpha, const Vec3& normal, const Vec3& from) {
  return 1 / (1 + ggx_hidden(alpha, std::abs(normal.dot(from))));
}

}  // namespace reemit::hit_paths

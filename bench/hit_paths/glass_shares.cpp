#include "bench/hit_paths/glass_shares.h"

#include <cmath>
#include <numbers>

namespace reemit::hit_paths {
namespace {

/// Reflected power across (s) and in (p) the plane of incidence.
struct Polarised {
  double s, p;
};

Polarised reflected(double ratio, double angle, double behind) {
  // Both laws are 0/0 along the normal, and have this limit there.
  constexpr double kNormal = 1e-6;
  if (angle < kNormal) {
    const double r = (ratio - 1) / (ratio + 1);
    return {r * r, r * r};
  }
  const double s = std::sin(angle - behind) / std::sin(angle + behind);
  const double p = std::tan(angle - behind) / std::tan(angle + behind);
  return {s * s, p * p};
}

/// What goes inwards behind the first surface is what came through it and what it reflects of that which
/// comes back from the second: inwards = (1 - r) + r (r once^2 inwards).
GlassShares between_two(double r, double once) {
  if (!(r < 1)) return {};
  const double inwards = (1 - r) / (1 - r * r * once * once);
  const double back = r * once * once * inwards;
  return {r + (1 - r) * back, (1 - r) * once * inwards};
}

}  // namespace

double refracted_angle(double ratio, double angle) {
  const double sine = std::sin(angle) / ratio;
  return sine < 1 ? std::asin(sine) : -1;
}

GlassShares at_surface(double ratio, double angle) {
  const double behind = refracted_angle(ratio, angle);
  if (behind < 0 || angle >= std::numbers::pi / 2) return {};
  if (ratio == 1) return {0, 1};
  const Polarised r = reflected(ratio, angle, behind);
  const double mean = (r.s + r.p) / 2;
  return {mean, 1 - mean};
}

GlassShares at_pane(double ior, double clear, double angle) {
  if (angle >= std::numbers::pi / 2) return {};
  const double behind = refracted_angle(ior, angle);
  const double once = std::pow(clear, 1 / std::cos(behind));
  if (ior == 1) return {0, once};
  const Polarised r = reflected(ior, angle, behind);
  const GlassShares s = between_two(r.s, once);
  const GlassShares p = between_two(r.p, once);
  return {(s.reflected + p.reflected) / 2, (s.transmitted + p.transmitted) / 2};
}

}  // namespace reemit::hit_paths

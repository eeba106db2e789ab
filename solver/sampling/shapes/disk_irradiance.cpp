#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "solver/sampling/shapes/disk_sampler.h"
#include "solver/sampling/shapes/plane_maps.h"

namespace reemit {
namespace {

using std::numbers::pi;

/// Integrals over phi in [from, to] of 1, cos phi and sin phi over (a + b cos phi); 0 <= b < a, -2 pi <=
/// from, to - from < 2 pi.
std::array<double, 3> rational_integrals(double a, double b, double from, double to) {
  const double s = std::sqrt((a - b) * (a + b));
  // Half angle form of the antiderivative of 1/(a + b cos): phi/s plus a periodic part.
  const auto periodic = [&](double phi) {
    // atan(k tan(phi/2)) - phi/2 with k = (a-b)/s, without its jumps; (k-1)/(k+1) = -(b/(a+s)).
    const double q = b / (a + s);
    return -std::atan2(q * std::sin(phi), 1 + q * std::cos(phi));
  };
  const double angle = to - from;
  const double swing = periodic(to) - periodic(from);
  const double one = (angle + 2 * swing) / s;
  const double ratio = b / a;
  double cosine = 0;
  double sine = 0;
  const double da = std::cos(from) - std::cos(to);
  if (ratio > 1e-4) {
    // (angle - a one) / b with angle - a angle / s = -b^2 angle / (s (a + s)).
    cosine = (-b * angle / (a + s) - 2 * a / b * swing) / s;
    sine = -std::log1p(-b * da / (a + b * std::cos(from))) / b;
  } else {
    // Powers of b/a up to the third; the next is below rounding.
    const auto power = [&](double phi) {
      const double c = std::cos(phi);
      const double si = std::sin(phi);
      const double c2 = 0.5 * (phi + si * c);
      const double c3 = si - si * si * si / 3;
      const double c4 = 0.25 * c * c * c * si + 0.75 * c2;
      return si - ratio * (c2 - ratio * (c3 - ratio * c4));
    };
    const auto power_sine = [&](double phi) {
      const double c = std::cos(phi);
      return -c * (1 - ratio * c * (0.5 - ratio * c * (1.0 / 3 - ratio * c / 4)));
    };
    cosine = (power(to) - power(from)) / a;
    sine = (power_sine(to) - power_sine(from)) / a;
  }
  return {one, cosine, sine};
}

}  // namespace

double DiskSampler::irradiance() const {
  if (!lights_) return 0;
  const Vec3 c = disk_.centre - x_;
  const double r = disk_.radius;
  const AlignedFrame frame(disk_.normal, c);
  const Vec3& u = frame.e1;
  const Vec3& v = frame.e2;
  // Height of the rim above the horizon: level + swing cos(phi - top).
  const double level = n_.dot(c);
  const double nu = n_.dot(u);
  const double nv = n_.dot(v);
  const double swing = r * std::hypot(nu, nv);
  if (level >= swing) {
    // The light vector of the whole disk, along its axis and across, without differences.
    const double h2 = height_ * height_;
    const double l = frame.across;
    const double s = std::sqrt((h2 + (l + r) * (l + r)) * (h2 + (l - r) * (l - r)));
    const double k = h2 + (l - r) * (l + r);
    const double axial = k > 0 ? 2 * pi * r * r * h2 / (s * (s + k)) : 0.5 * pi * (1 - k / s);
    const double lateral = 2 * pi * height_ * l * r * r / (s * (h2 + l * l + r * r + s));
    return std::max(0.0, lateral * nu - axial * n_.dot(disk_.normal));
  }
  double chord = 0;
  const double half = std::acos(std::clamp(-level / swing, -1.0, 1.0));
  const double top = std::atan2(nv, nu);
  const double from = top - half;
  const double to = top + half;
  const Vec3 p = c + r * (std::cos(to) * u + std::sin(to) * v);
  const Vec3 q = c + r * (std::cos(from) * u + std::sin(from) * v);
  const Vec3 cross = p.cross(q - p);
  const double length = cross.norm();
  if (length > 0) chord = n_.dot(cross) / length * std::atan2(length, p.dot(q));
  // p x dp = r [cos (c x v) - sin (c x u) + r (u x v)] d phi and |p|^2 = a + b cos phi.
  const double a = height_ * height_ + frame.across * frame.across + r * r;
  const double b = 2 * frame.across * r;
  const auto integral = rational_integrals(a, b, from, to);
  const double sum = r * (n_.dot(c.cross(v)) * integral[1] - n_.dot(c.cross(u)) * integral[2] +
                          r * n_.dot(disk_.normal) * integral[0]);
  return 0.5 * std::fabs(sum + chord);
}

}  // namespace reemit

#pragma once
#include <algorithm>
#include <cmath>

namespace reemit {

/// Share of the light that is reflected where it meets a clear medium, for the two polarisations.
struct FresnelShares {
  double s = 1;
  double p = 1;
  double mean() const { return 0.5 * (s + p); }
};

/// Cosine of the refracted ray to the normal by Snell's law, for a relative index eta = n_beyond / n_before
/// and cosine in [0,1]; 0 where all light is reflected.
inline double refracted_cosine(double eta, double cosine) {
  const double sine2 = (1 - cosine * cosine) / (eta * eta);
  return sine2 < 1 ? std::sqrt(1 - sine2) : 0;
}

/// Fresnel's equations [BW99, sec. 1.5.2] for clear media; all is reflected beyond the critical angle.
inline FresnelShares fresnel(double eta, double cosine) {
  const double beyond = refracted_cosine(eta, cosine);
  if (!(beyond > 0)) return {};
  const double s = (cosine - eta * beyond) / (cosine + eta * beyond);
  const double p = (eta * cosine - beyond) / (eta * cosine + beyond);
  return {s * s, p * p};
}

/// Share of the light that a metal of index of refraction eta - i k reflects, seen from air, at a cosine in
/// [0,1] [BW99, sec. 14.2].
inline FresnelShares fresnel_of_metal(double eta, double k, double cosine) {
  const double c2 = cosine * cosine;
  const double s2 = 1 - c2;
  const double real = eta * eta - k * k - s2;
  const double both = std::sqrt(real * real + 4 * eta * eta * k * k);  // a^2 + b^2 of the refracted wave
  const double a = std::sqrt(std::max(0.0, 0.5 * (both + real)));
  const double s = (both + c2 - 2 * a * cosine) / (both + c2 + 2 * a * cosine);
  const double beyond = c2 * both + s2 * s2;
  const double turned = 2 * a * cosine * s2;
  return {s, s * (beyond - turned) / (beyond + turned)};
}

/// What a pane reflects and lets through, all reflections between its two surfaces added up as power: for one
/// polarisation, r at a surface and `once` the share that a pass across the glass leaves [BW99, sec. 1.6.4].
struct PaneShares {
  double reflected;
  double transmitted;
};
/// Pre: r and once in [0,1].
inline PaneShares pane_shares(double r, double once) {
  const double open = (1 - r) * (1 - r) / std::max(1 - r * r * once * once, 1e-12);
  // At grazing incidence both surfaces reflect everything, and what is between them does not matter.
  return {r < 1 ? r + open * r * once * once : 1.0, r < 1 ? open * once : 0.0};
}

/// Reflectance at an angle for r at normal incidence and `most` at grazing [SCH94, eq. 15].
inline float schlick(float r, float most, float cosine) {
  const float m = 1 - std::clamp(cosine, 0.0F, 1.0F);
  const float m2 = m * m;
  return r + (most - r) * m2 * m2 * m;
}

}  // namespace reemit

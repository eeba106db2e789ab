#include "bench/hit_paths/surface_ways.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "bench/hit_paths/glass_shares.h"

namespace reemit::hit_paths {
namespace {

bool reflects(const NonDiffusePart& part) {
  return part.angle_law == AngleLaw::kDielectric || NonDiffusePart::is_given(part.specular_reflectance);
}

bool transmits(const NonDiffusePart& part) {
  return NonDiffusePart::is_given(part.specular_transmittance);
}

double in_band(const Spectrum& share, bool given, Eigen::Index band) {
  return given && share.size() > 0 ? share[band] : 0.0;
}

}  // namespace

SpecularShares specular_shares(const Material& material, double angle, bool front) {
  const NonDiffusePart& part = material.non_diffuse;
  const Eigen::Index bands = material.reflectance.size();
  SpecularShares shares{Spectrum::Zero(bands), Spectrum::Zero(bands)};
  const bool mirrors = reflects(part);
  const bool clear = transmits(part);
  if (!mirrors && !clear) return shares;
  const double ratio = index_ratio(material, front);
  const Spectrum opal = let_through(material);
  const bool totally = part.is_solid && clear && refracted_angle(ratio, angle) < 0;
  for (Eigen::Index b = 0; b < bands; ++b) {
    // By the Lambertian parts; of the two sides the one that takes more.
    const double taken =
        std::max(reflected_diffusely(material, true)[b], reflected_diffusely(material, false)[b]);
    const double left = 1 - taken - opal[b];
    double r = in_band(part.specular_reflectance, mirrors, b);
    double t = in_band(part.specular_transmittance, clear, b);
    switch (part.angle_law) {
      case AngleLaw::kConstant:
        break;
      case AngleLaw::kSchlick: {
        // What the mirror takes towards grazing angles is missing in what crosses.
        const double steep = r;
        r += std::max(0.0, left - r) * std::pow(1 - std::cos(angle), 5);
        if (left > steep) t *= (left - r) / (left - steep);
        break;
      }
      case AngleLaw::kConductor: {
        // Amplitudes of both polarisations with a complex refracted wave.
        const std::complex<double> n(part.metal_eta[b], -part.metal_k[b]);
        const double c = std::cos(angle);
        const std::complex<double> wave = std::sqrt(n * n - std::pow(std::sin(angle), 2));
        const auto across = (c - wave) / (c + wave);
        const auto within = (n * n * c - wave) / (n * n * c + wave);
        r *= left * 0.5 * (std::norm(across) + std::norm(within));
        break;
      }
      case AngleLaw::kDielectric: {
        const GlassShares glass =
            part.is_solid ? at_surface(ratio, angle) : at_pane(part.index_of_refraction, t, angle);
        r = left * glass.reflected;
        t = left * glass.transmitted * (part.is_solid ? t : 1);
        break;
      }
    }
    if (totally) {
      r = part.angle_law == AngleLaw::kDielectric ? left : r + t;
      t = 0;
    }
    if (mirrors || totally) shares.mirrored[b] = r;
    if (clear) shares.crossing[b] = t;
  }
  return shares;
}

Spectrum reflected_diffusely(const Material& material, bool front) {
  return !front && material.back_reflectance.size() > 0 ? material.back_reflectance : material.reflectance;
}

Spectrum let_through(const Material& material) {
  const Spectrum& through = material.non_diffuse.diffuse_transmittance;
  return through.size() > 0 ? through : Spectrum::Zero(material.reflectance.size());
}

bool is_rough_mirror(const Material& material) {
  return reflects(material.non_diffuse) && material.non_diffuse.roughness > NonDiffusePart::kSmooth;
}

bool is_rough_across(const Material& material) {
  return transmits(material.non_diffuse) &&
         material.non_diffuse.transmission_roughness > NonDiffusePart::kSmooth;
}

double index_ratio(const Material& material, bool front) {
  const NonDiffusePart& part = material.non_diffuse;
  return part.is_solid && !front ? 1 / part.index_of_refraction : part.index_of_refraction;
}

double arrival_angle(const RoomHit& hit, const Vec3& direction) {
  // Well conditioned along the normal, where the arc cosine is not.
  return std::atan2(hit.normal.cross(direction).norm(), -hit.normal.dot(direction));
}

Vec3 mirrored(const RoomHit& hit, const Vec3& direction) {
  return (direction - 2 * hit.normal.dot(direction) * hit.normal).normalized();
}

Vec3 crossing(const RoomHit& hit, const Vec3& direction) {
  if (!hit.material->non_diffuse.is_solid) return direction;
  // Snell's law for the part along the surface.
  const Vec3 along = direction - hit.normal.dot(direction) * hit.normal;
  const Vec3 bent = along / index_ratio(*hit.material, hit.front);
  return (bent - std::sqrt(std::max(0.0, 1 - bent.squaredNorm())) * hit.normal).normalized();
}

bool is_body(const Material& material) {
  return material.non_diffuse.is_solid && transmits(material.non_diffuse);
}

Spectrum left_inside(const Material& body, double way) {
  const Spectrum& absorption = body.non_diffuse.absorption_per_m;
  if (absorption.size() == 0) return Spectrum::Ones(body.reflectance.size());
  return (-way * absorption).exp();
}

}  // namespace reemit::hit_paths

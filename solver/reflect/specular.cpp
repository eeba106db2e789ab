#include "solver/reflect/specular.h"

#include <algorithm>
#include <cmath>

#include "solver/reflect/fresnel.h"

namespace reemit {
namespace {

std::vector<float> by_band(const Spectrum& s, bool used, std::size_t bands) {
  std::vector<float> values(bands, 0.0F);
  if (used && s.size() > 0)
    for (std::size_t b = 0; b < bands; ++b) values[b] = static_cast<float>(s[static_cast<Eigen::Index>(b)]);
  return values;
}

float largest(const std::vector<float>& values) {
  return *std::max_element(values.begin(), values.end());
}

}  // namespace

SpecularSurface::SpecularSurface(const Material& material, double metres_per_unit)
    : reflects_(material.non_diffuse.reflects_specularly()),
      transmits_(material.non_diffuse.transmits_specularly()),
      solid_(material.non_diffuse.is_solid),
      law_(material.non_diffuse.angle_law),
      ior_(material.non_diffuse.index_of_refraction) {
  const NonDiffusePart& part = material.non_diffuse;
  const auto bands = static_cast<std::size_t>(material.reflectance.size());
  most_ = by_band(1 - material.reflectance, true, bands);
  reflectance_ = by_band(part.specular_reflectance, reflects_, bands);
  transmittance_ = by_band(part.specular_transmittance, transmits_, bands);
  if (transmits_ && solid_ && part.absorption_per_m.size() > 0 && (part.absorption_per_m > 0).any()) {
    absorption_ = by_band(part.absorption_per_m, true, bands);
    for (float& a : absorption_) a *= static_cast<float>(metres_per_unit);
  }
}

float SpecularSurface::shares(float cosine, bool front, SpecularStep& step) const {
  const std::size_t bands = reflectance_.size();
  const double c = std::clamp(static_cast<double>(cosine), 0.0, 1.0);
  const double eta = solid_ && !front ? 1 / ior_ : ior_;
  const double beyond = refracted_cosine(eta, c);
  const FresnelShares surface = law_ == AngleLaw::kDielectric ? fresnel(eta, c) : FresnelShares{};
  for (std::size_t b = 0; b < bands; ++b) {
    float& reflected = step.reflected[b];
    float& transmitted = step.transmitted[b];
    reflected = reflectance_[b];
    transmitted = transmittance_[b];
    if (law_ == AngleLaw::kSchlick) {
      const float most = std::max(most_[b], reflectance_[b]);
      reflected = schlick(reflectance_[b], most, cosine);
      if (reflectance_[b] < most) transmitted *= (most - reflected) / (most - reflectance_[b]);
    } else if (law_ == AngleLaw::kDielectric && solid_) {
      reflected = most_[b] * static_cast<float>(surface.mean());
      transmitted *= most_[b] - reflected;
    } else if (law_ == AngleLaw::kDielectric) {
      const double once = transmits_ ? std::pow(static_cast<double>(transmittance_[b]), 1 / beyond) : 0;
      const PaneShares s = pane_shares(surface.s, once);
      const PaneShares p = pane_shares(surface.p, once);
      reflected = most_[b] * static_cast<float>(0.5 * (s.reflected + p.reflected));
      transmitted = most_[b] * static_cast<float>(0.5 * (s.transmitted + p.transmitted));
    }
    if (solid_ && !(beyond > 0)) {  // total reflection
      if (law_ != AngleLaw::kDielectric) reflected += transmitted;
      transmitted = 0;
    }
    if (!reflects_) reflected = solid_ && !(beyond > 0) ? reflected : 0;
    if (!transmits_) transmitted = 0;
  }
  return largest(step.reflected) + largest(step.transmitted);
}

bool SpecularSurface::choose(const SurfacePoint& x, float u, Survival survival, SpecularStep& step,
                             float most) const {
  const float cosine = x.normal.dot(x.towards);
  if (!(cosine > 0 && most > 0)) return false;
  const float sum = shares(cosine, x.front, step);
  if (!(sum > 0)) return false;
  const bool certain = survival == Survival::kCertain || sum > most;
  const float scale = certain ? most / sum : 1;
  if (!certain && u >= sum) return false;
  const float mirror = largest(step.reflected);
  const float across = largest(step.transmitted);
  step.crosses = across > 0 && u >= scale * mirror;
  step.chance = scale * (step.crosses ? across : mirror);
  if (!(step.chance > 0)) return false;
  turn(x, step);
  return true;
}

bool SpecularSurface::take(const SurfacePoint& x, bool crosses, SpecularStep& step) const {
  const float cosine = x.normal.dot(x.towards);
  if (!(cosine > 0)) return false;
  shares(cosine, x.front, step);
  step.crosses = crosses;
  step.chance = 1;
  if (!(largest(step.share()) > 0)) return false;
  turn(x, step);
  return true;
}

void SpecularSurface::turn(const SurfacePoint& x, SpecularStep& step) const {
  const float cosine = x.normal.dot(x.towards);
  step.bends = !step.crosses || solid_;
  step.front = step.crosses != x.front;
  if (!step.crosses)
    step.direction = (2 * cosine * x.normal - x.towards).normalized();
  else if (!solid_)
    step.direction = -x.towards;
  else {
    const double eta = x.front ? ior_ : 1 / ior_;
    const double beyond = refracted_cosine(eta, std::min(1.0, static_cast<double>(cosine)));
    const Vec3 n = x.normal.cast<double>();
    const Vec3 d = -x.towards.cast<double>() / eta + (static_cast<double>(cosine) / eta - beyond) * n;
    step.direction = d.normalized().cast<float>();
  }
}

float SpecularSurface::left_inside(std::size_t band, float way) const {
  return std::exp(-absorption_[band] * way);
}

}  // namespace reemit

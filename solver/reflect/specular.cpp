#include "solver/reflect/specular.h"

#include <algorithm>
#include <cmath>

#include "solver/reflect/fresnel.h"
#include "solver/reflect/lambert.h"

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
      diffuses_(material.non_diffuse.transmits_diffusely()),
      solid_(material.non_diffuse.is_solid),
      rough_mirror_(material.non_diffuse.has_gloss()),
      rough_across_(material.non_diffuse.has_glossy_transmission()),
      law_(material.non_diffuse.angle_law),
      ior_(material.non_diffuse.index_of_refraction),
      eta_(material.non_diffuse.metal_eta.begin(), material.non_diffuse.metal_eta.end()),
      k_(material.non_diffuse.metal_k.begin(), material.non_diffuse.metal_k.end()) {
  const NonDiffusePart& part = material.non_diffuse;
  const auto bands = static_cast<std::size_t>(material.reflectance.size());
  double roughness = part.roughness;
  double across = part.transmission_roughness;
  GlossLobe lobe = part.lobe;
  if (solid_ && transmits_ && is_rough()) {  // light is reflected and refracted at the same facets
    roughness = across = std::max(roughness, across);
    lobe = GlossLobe::kGgx;
    rough_mirror_ = rough_across_ = true;
  }
  wide_mirror_ = rough_mirror_ && roughness > kWide;
  wide_across_ = rough_across_ && across > kWide;
  if (rough_mirror_) mirror_lobe_ = GlossModel(lobe, roughness);
  if (rough_across_) across_lobe_ = GlossModel(lobe, across);
  most_ = by_band(1 - material.lambertian_share(), true, bands);
  reflectance_ = by_band(part.specular_reflectance, reflects_, bands);
  transmittance_ = by_band(part.specular_transmittance, transmits_, bands);
  diffuse_ = by_band(part.diffuse_transmittance, diffuses_, bands);
  if (transmits_ && solid_ && part.absorption_per_m.size() > 0 && (part.absorption_per_m > 0).any()) {
    absorption_ = by_band(part.absorption_per_m, true, bands);
    for (float& a : absorption_) a *= static_cast<float>(metres_per_unit);
  }
  constexpr float kRounding = 3e-5F;  // also of the cosine
  if (bands > 0)
    most_shares_ = kRounding + largest(reflectance_) + largest(transmittance_) + largest(diffuse_);
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
    } else if (law_ == AngleLaw::kConductor) {
      reflected *= most_[b] * static_cast<float>(fresnel_of_metal(eta_[b], k_[b], c).mean());
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
  if (step.diffuse_way == DiffuseWay::kFollowed)
    step.diffuse = diffuse_;
  else
    std::fill(step.diffuse.begin(), step.diffuse.end(), 0.0F);
  return largest(step.reflected) + largest(step.transmitted) + largest(step.diffuse);
}

bool SpecularSurface::choose(const SurfacePoint& x, float u, const std::array<float, 2>& spread,
                             Survival survival, SpecularStep& step, float most) const {
  const float cosine = x.normal.dot(x.towards);
  if (!(cosine > 0 && most > 0)) return false;
  // What a facet of rough glass does depends on the angle to the facet: it may let light through where the
  // whole surface would reflect everything.
  const float facing =
      is_rough_body() ? facet_of(x, spread).dot(Frame(x.normal).to_local(x.towards)) : cosine;
  if (!(facing > 0)) return false;
  const float sum = shares(facing, x.front, step);
  if (!(sum > 0)) return false;
  const bool certain = survival == Survival::kCertain || sum > most;
  const float scale = certain ? most / sum : 1;
  if (!certain && u >= sum) return false;
  const float mirror = largest(step.reflected);
  const float across = largest(step.transmitted);
  const float diffuse = largest(step.diffuse);
  step.way = SpecularWayOn::kMirror;
  if (u >= scale * mirror && across + diffuse > 0)
    step.way = diffuse > 0 && (u >= scale * (mirror + across) || !(across > 0)) ? SpecularWayOn::kDiffuse
                                                                                : SpecularWayOn::kAcross;
  step.chance = scale * largest(step.share());
  return step.chance > 0 && turn(x, spread, step);
}

bool SpecularSurface::take(const SurfacePoint& x, SpecularWayOn way, const std::array<float, 2>& spread,
                           SpecularStep& step) const {
  const float cosine = x.normal.dot(x.towards);
  if (!(cosine > 0)) return false;
  shares(cosine, x.front, step);
  step.way = way;
  step.chance = 1;
  return (is_rough_body() || largest(step.share()) > 0) && turn(x, spread, step);
}

bool SpecularSurface::turn(const SurfacePoint& x, const std::array<float, 2>& spread,
                           SpecularStep& step) const {
  step.pdf_per_sr = 0;
  const bool crosses = step.crosses();
  if (step.way == SpecularWayOn::kDiffuse) {
    turn_anywhere_across(x, spread, step);
    return true;
  }
  step.is_wide = crosses ? wide_across_ : wide_mirror_;
  if (crosses ? rough_across_ : rough_mirror_)
    return is_rough_body() ? turn_at_facet(x, spread, step) : turn_by_lobe(x, spread, step);
  const float cosine = x.normal.dot(x.towards);
  step.bends = !crosses || solid_;
  step.front = crosses != x.front;
  if (!crosses)
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
  return true;
}

void SpecularSurface::turn_anywhere_across(const SurfacePoint& x, const std::array<float, 2>& spread,
                                           SpecularStep& step) const {
  step.direction = sample_lambert(-x.normal, spread[0], spread[1]);
  step.pdf_per_sr = cosine_hemisphere_pdf_per_sr(-step.direction.dot(x.normal));
  step.is_wide = step.bends = true;
  step.front = !x.front;
}

bool SpecularSurface::turn_by_lobe(const SurfacePoint& x, const std::array<float, 2>& spread,
                                   SpecularStep& step) const {
  const bool crosses = step.crosses();
  const GlossModel& lobe = crosses ? across_lobe_ : mirror_lobe_;
  const Frame frame(x.normal);
  const Vec3f from = frame.to_local(x.towards);
  Vec3f to;
  if (!lobe.sample(from, spread[0], spread[1], to)) return false;
  const GlossValue v = lobe.value(from, to);
  if (!(v.brdf_per_sr > 0 && v.pdf_per_sr > 0)) return false;
  shares(v.half_cosine, x.front, step);
  for (float& share : step.share()) share *= v.brdf_per_sr * to.z() / v.pdf_per_sr;
  step.pdf_per_sr = v.pdf_per_sr;
  step.bends = true;
  step.front = crosses != x.front;
  step.direction = frame.to_world(crosses ? Vec3f(to.x(), to.y(), -to.z()) : to);
  return true;
}

Vec3f SpecularSurface::facet_of(const SurfacePoint& x, const std::array<float, 2>& spread) const {
  return mirror_lobe_.sample_facet(Frame(x.normal).to_local(x.towards), spread[0], spread[1]);
}

bool SpecularSurface::turn_at_facet(const SurfacePoint& x, const std::array<float, 2>& spread,
                                    SpecularStep& step) const {
  const bool crosses = step.crosses();
  const Frame frame(x.normal);
  const Vec3f from = frame.to_local(x.towards);
  const Vec3f facet = facet_of(x, spread);
  const float cosine = from.dot(facet);
  if (!(cosine > 0)) return false;
  shares(cosine, x.front, step);
  Vec3f to = 2 * cosine * facet - from;
  if (crosses) {
    const float eta = static_cast<float>(x.front ? ior_ : 1 / ior_);
    const auto beyond =
        static_cast<float>(refracted_cosine(static_cast<double>(eta), static_cast<double>(cosine)));
    to = (cosine / eta - beyond) * facet - from / eta;
  }
  to.normalize();
  if (crosses ? !(to.z() < 0) : !(to.z() > 0)) return false;
  // Reflected light leaves over the heights that it came by; refracted light finds others [WAL07, eq. 41].
  float unmasked = mirror_lobe_.unmasked(to);
  if (!crosses) {
    const GlossValue v = mirror_lobe_.value(from, to);
    unmasked = v.brdf_per_sr * to.z() / v.pdf_per_sr;
  }
  for (float& share : step.share()) share *= unmasked;
  step.bends = true;
  step.front = crosses != x.front;
  step.direction = frame.to_world(to);
  return true;
}

bool SpecularSurface::value(const SurfacePoint& x, SpecularWayOn way, const Vec3f& from,
                            SpecularStep& step) const {
  step.way = way;
  const Frame frame(x.normal);
  Vec3f light = frame.to_local(from);
  if (!spreads(way) || step.crosses() != (light.z() < 0)) return false;
  light.z() = std::fabs(light.z());
  if (way == SpecularWayOn::kDiffuse) {
    for (std::size_t b = 0; b < diffuse_.size(); ++b) step.diffuse[b] = lambert_brdf_per_sr(diffuse_[b]);
    step.pdf_per_sr = cosine_hemisphere_pdf_per_sr(light.z());
    step.is_wide = true;
    return true;
  }
  const GlossValue v = (step.crosses() ? across_lobe_ : mirror_lobe_).value(frame.to_local(x.towards), light);
  if (!(v.brdf_per_sr > 0)) return false;
  shares(v.half_cosine, x.front, step);
  for (float& share : step.share()) share *= v.brdf_per_sr;
  step.pdf_per_sr = v.pdf_per_sr;
  step.is_wide = step.crosses() ? wide_across_ : wide_mirror_;
  return true;
}

float SpecularSurface::left_inside(std::size_t band, float way) const {
  return std::exp(-absorption_[band] * way);
}

}  // namespace reemit

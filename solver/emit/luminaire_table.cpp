#include "solver/emit/luminaire_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/shoot/emission.h"

namespace reemit {
namespace {

double band_sum(const Spectrum& s) {
  return s.sum();
}

}  // namespace

LuminaireTable::LuminaireTable(const Scene& scene, const RayScene& rays)
    : rays_(&rays), bands_(scene.bands.count()) {
  add_triangles(scene);
  add_punctual(scene);
}

void LuminaireTable::add_emission(const Spectrum& emission, double power) {
  for (std::size_t b = 0; b < bands_; ++b)
    emission_.push_back(static_cast<float>(emission[static_cast<Eigen::Index>(b)]));
  brightness_.push_back(static_cast<float>(band_sum(emission)));
  cumulative_power_.push_back((cumulative_power_.empty() ? 0.0 : cumulative_power_.back()) + power);
}

void LuminaireTable::add_triangles(const Scene& scene) {
  const ZoneMesh& mesh = rays_->mesh();
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const TriangleId t(i);
    const Material& material = scene.material_of(scene.surfaces[mesh.triangle(t).surface.index()]);
    if (!material.emits() || !(mesh.triangle_area(t) > 0)) continue;
    const double metres = rays_->metres_per_unit();
    const double power = std::numbers::pi * mesh.triangle_area(t) * band_sum(material.emitted_radiance);
    for (const bool front : {true, false}) {
      if (!front && !(material.emits_both_sides && mesh.triangle(t).two_sided)) continue;
      TriangleLight light;
      light.a = rays_->corner(t, 0);
      light.b = rays_->corner(t, 1);
      light.c = rays_->corner(t, 2);
      light.normal = front ? rays_->normal(t) : Vec3f(-rays_->normal(t));
      light.area = static_cast<float>(mesh.triangle_area(t) / (metres * metres));
      light.longest_edge2 = std::max({(light.b - light.a).squaredNorm(), (light.c - light.b).squaredNorm(),
                                      (light.a - light.c).squaredNorm()});
      triangles_.push_back({light, t, front});
      add_emission(material.emitted_radiance, power);
    }
  }
}

void LuminaireTable::add_punctual(const Scene& scene) {
  for (const PunctualLight& light : scene.lights) {
    const double power = band_sum(light_power(light, *rays_));
    if (!(power > 0)) continue;
    punctual_.push_back(make_punctual_emitter(light, *rays_));
    add_emission(emission_of(light), power);
  }
}

float LuminaireTable::unoccluded(std::size_t entry, const Vec3f& x, const Vec3f& n) const {
  if (entry < triangles_.size()) return unoccluded_irradiance(triangles_[entry].light, x, n);
  return punctual_[entry - triangles_.size()].unoccluded_irradiance(
      x, n, static_cast<float>(rays_->metres_per_unit()));
}

bool LuminaireTable::sample(std::size_t entry, const Vec3f& x, const Vec3f& n, float u0, float u1,
                            LuminaireSample& result) const {
  if (entry < triangles_.size()) {
    const TriangleEntry& e = triangles_[entry];
    TriangleLightSample point;
    if (!sample_triangle_light(e.light, x, n, u0, u1, point)) return false;
    result.factor = point.factor;
    result.at_infinity = false;
    result.target = rays_->ray_origin(e.triangle, point.u, point.v, e.front);
    return true;
  }
  const PunctualEmitter& e = punctual_[entry - triangles_.size()];
  const PunctualSample point = e.sample(x, n, u0, u1, static_cast<float>(rays_->metres_per_unit()));
  result.factor = point.factor;
  result.at_infinity = point.at_infinity;
  result.target = point.target;
  return result.factor > 0;
}

std::size_t LuminaireTable::entry_at_power(float u, float& share) const {
  const double total = cumulative_power_.back();
  const auto found =
      std::upper_bound(cumulative_power_.begin(), cumulative_power_.end(), static_cast<double>(u) * total);
  const auto entry = std::min(static_cast<std::size_t>(found - cumulative_power_.begin()), size() - 1);
  const double before = entry > 0 ? cumulative_power_[entry - 1] : 0.0;
  share = static_cast<float>((cumulative_power_[entry] - before) / total);
  return entry;
}

LuminaireChoice::LuminaireChoice(const LuminaireTable& table, const Vec3f& x, const Vec3f& n, float u) {
  const bool all = table.size() <= kMost;
  const std::size_t tried = all ? table.size() : kMost;
  float total = 0;
  for (std::size_t i = 0; i < tried; ++i) {
    std::size_t entry = i;
    float draw_weight = 1;
    if (!all) {
      constexpr auto kDraws = static_cast<float>(kMost);
      float share = 0;
      entry = table.entry_at_power((static_cast<float>(i) + u) / kDraws, share);
      if (!(share > 0)) continue;
      draw_weight = 1 / (kDraws * share);
    }
    const float weight = draw_weight * table.brightness(entry) * table.unoccluded(entry, x, n);
    if (!(weight > 0) || !std::isfinite(weight)) continue;
    entry_[count_] = static_cast<std::uint32_t>(entry);
    draw_weight_[count_] = draw_weight;
    total += weight;
    cumulative_[count_++] = weight;
  }
  const float even = kEvenShare / static_cast<float>(std::max<std::size_t>(count_, 1));
  float sum = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    sum += (1 - kEvenShare) * cumulative_[i] / total + even;
    cumulative_[i] = sum;
  }
  if (count_ > 0) cumulative_[count_ - 1] = 1;
}

std::size_t LuminaireChoice::pick(float& u, float& inverse_probability) const {
  std::size_t i = 0;
  while (i + 1 < count_ && u >= cumulative_[i]) ++i;
  const float low = i > 0 ? cumulative_[i - 1] : 0.0F;
  const float probability = cumulative_[i] - low;
  u = std::clamp((u - low) / probability, 0.0F, 0x1.fffffep-1F);
  inverse_probability = draw_weight_[i] / probability;
  return entry_[i];
}

}  // namespace reemit

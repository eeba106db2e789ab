#include "solver/gather/direct_light.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "solver/sampling/warp.h"

namespace reemit {
namespace {

/// Shadow rays end after so many panes.
constexpr int kMostPanes = 256;
/// Of so many luminaires each gets a ray of its own from a point in the air. A ray that chooses one knows
/// nothing of what hides them: a dim lamp beside bright ones behind a wall would be asked too seldom.
constexpr std::size_t kMostAskedOneByOne = 64;

/// pdf / (pdf + way^2 / area), without a division by 0.
float share_of_lobe(float area, float way, float pdf_per_sr) {
  return pdf_per_sr * area / (pdf_per_sr * area + way * way);
}

}  // namespace

DirectLight::DirectLight(const Room& room, const DirectLightSettings& settings)
    : rays_(&room.rays()),
      surfaces_(&room.surfaces()),
      sky_(room.sky()),
      table_(room),
      selection_(settings.selection.value_or(LuminaireChoice::default_for(table_.size()))) {}

std::size_t DirectLight::luminaires_weighed() const {
  // A walk down the tree costs about as much as weighing two luminaires.
  if (selection_ == Selection::kSpatial) return 3 * LuminaireChoice::kCandidates;
  return selection_ == Selection::kConstant ? 0 : table_.size();
}

DirectLight::Arrival DirectLight::estimate(const SurfacePoint& x, const Vec3f& origin,
                                           const std::array<float, kDimensions>& u) const {
  // u[2] places the candidates where there are many luminaires.
  return estimate(x, origin, LuminaireChoice(table_, selection_, origin, x.normal, u[2]), u);
}

DirectLight::Arrival DirectLight::estimate(const SurfacePoint& x, const Vec3f& origin,
                                           const LuminaireChoice& choice,
                                           const std::array<float, kDimensions>& u) const {
  const auto is_above = [&](const Vec3f& towards) { return towards.dot(side_normal(*rays_, x)) > 0; };
  return estimate(origin, x.normal, is_above, choice, u);
}

template <class IsAbove>
DirectLight::Arrival DirectLight::estimate(const Vec3f& origin, const Vec3f& normal, const IsAbove& is_above,
                                           const LuminaireChoice& choice,
                                           const std::array<float, kDimensions>& u) const {
  // u[0] chooses and is then used again.
  float u_choice = u[0];
  float inverse_probability = 0;
  std::size_t entry = 0;
  if (!choice.pick(u_choice, entry, inverse_probability)) return {};
  return arrival(origin, normal, is_above, entry, {u_choice, u[1], u[2]}, inverse_probability);
}

template <class IsAbove>
DirectLight::Arrival DirectLight::arrival(const Vec3f& origin, const Vec3f& normal, const IsAbove& is_above,
                                          std::size_t entry, const std::array<float, kDimensions>& u,
                                          float inverse_probability) const {
  LuminaireSample sample;
  if (!table_.sample(entry, origin, normal, u[0], u[1], sample)) return {};
  const Vec3f towards = sample.towards(origin);
  if (!is_above(towards)) return {};
  Arrival light{table_.strength(entry), sample.factor * inverse_probability, entry, towards, {}, {}};
  // From one place to a lamp without area all rays are alike, and only the numbers tell them apart.
  std::uint32_t chance = 0;
  for (const float number : u) chance = 0x9e3779b9U * chance + std::bit_cast<std::uint32_t>(number);
  if (!passes(origin, sample, chance, light.panes)) return {};
  if (sky_ != nullptr && table_.is_sky(entry) && sky_->is_coloured()) {
    std::vector<float> colour;
    sky_->colour(towards, colour);
    for (std::size_t b = 0; b < band_count(); ++b) colour[b] *= light.pane(b);
    light.panes = std::move(colour);
  }
  if (table_.varies(entry)) {
    table_.radiance_at(entry, sample.target, light.at_point);
    light.strength = nullptr;
    light.is_at_point = true;
  }
  return light;
}

bool DirectLight::passes(const Vec3f& origin, const LuminaireSample& sample, std::uint32_t chance,
                         std::vector<float>& panes) const {
  // Where light may cross panes, whether anything is met would be followed by what it is.
  if (!surfaces_->any_transmits())
    return sample.at_infinity ? rays_->escapes(origin, sample.target, chance)
                              : rays_->visible(origin, sample.target, chance);
  std::optional<SpecularStep> step;  // of the first pane on
  Vec3f from = origin;
  for (int crossed = 0; crossed < kMostPanes; ++crossed) {
    const Vec3f way = sample.towards(from);
    const float distance = sample.at_infinity ? std::numeric_limits<float>::infinity() : way.norm();
    if (!(distance > 0)) return true;
    const Vec3f direction = sample.at_infinity ? way : Vec3f(way / distance);
    Hit hit;
    if (!(sample.at_infinity ? rays_->closest(from, direction, hit, chance)
                             : rays_->first_on_way(from, direction, distance, hit, chance)))
      return true;
    if (!surfaces_->is_specular(hit.triangle, hit.front) || !surfaces_->specular(hit.triangle).is_pane())
      return false;
    if (!step) {
      step.emplace(band_count());
      panes.assign(band_count(), 1.0F);
    }
    const SurfacePoint x = surface_point(*rays_, hit, direction);
    surfaces_->specular(hit.triangle).shares(x.normal.dot(x.towards), x.front, *step);
    float most = 0;
    for (std::size_t b = 0; b < band_count(); ++b) most = std::max(most, panes[b] *= step->transmitted[b]);
    if (!(most > 0)) return false;
    from = rays_->ray_origin(hit.triangle, hit.u, hit.v, !hit.front);
  }
  return false;
}

void DirectLight::add_sample(const SurfacePoint& x, const std::array<float, kDimensions>& u,
                             const float* weight, float* sum) const {
  if (empty()) return;
  add(estimate(x, ray_origin(*rays_, x), u), weight, sum);
}

void DirectLight::add_sample(const MeasuringPoint& x, const std::array<float, kDimensions>& u,
                             const float* weight, float* sum) const {
  if (empty()) return;
  const auto is_above = [&](const Vec3f& towards) { return towards.dot(x.normal) > 0; };
  if (table_.size() > kMostAskedOneByOne) {
    const LuminaireChoice choice(table_, selection_, x.place, x.normal, u[2]);
    add(estimate(x.place, x.normal, is_above, choice, u), weight, sum);
    return;
  }
  for (std::size_t entry = 0; entry < table_.size(); ++entry) {
    // Numbers of their own for each, still evenly spread: moved by multiples of the golden ratio.
    std::array<float, kDimensions> own = u;
    const auto turn = static_cast<float>(entry) * (std::numbers::phi_v<float> - 1);
    for (float& number : own) {
      number += turn;
      number = std::min(number - std::floor(number), kLargestBelowOne);
    }
    add(arrival(x.place, x.normal, is_above, entry, own, 1), weight, sum);
  }
}

void DirectLight::weigh(const SurfacePoint& x, float* weights) const {
  const Vec3f origin = ray_origin(*rays_, x);
  for (std::size_t i = 0; i < table_.size(); ++i) {
    const float weight = table_.brightness(i) * table_.unoccluded(i, origin, x.normal);
    if (std::isfinite(weight)) weights[i] += weight;
  }
}

void DirectLight::add_sample(const SurfacePoint& x, const std::array<float, kDimensions>& u,
                             std::span<const float> luminaire_weights, const float* weight,
                             float* sum) const {
  add(estimate(x, ray_origin(*rays_, x), LuminaireChoice(table_, luminaire_weights), u), weight, sum);
}

void DirectLight::add(const Arrival& light, const float* weight, float* sum) const {
  if (!light.arrives()) return;
  for (std::size_t b = 0; b < band_count(); ++b)
    sum[b] += weight[b] * light.factor * light.strength_in(b) * light.pane(b);
}

void DirectLight::add_reflected_sample(const SurfacePoint& x, const std::array<float, kDimensions>& u,
                                       float chance, const float* weight, float* sum) const {
  if (empty()) return;
  const Arrival light = estimate(x, ray_origin(*rays_, x), u);
  if (!light.arrives()) return;
  SurfaceModel::PointValues at_point;
  const BrdfValue brdf = surfaces_->value(x, light.towards.normalized(), at_point);
  for (std::size_t b = 0; b < band_count(); ++b)
    sum[b] += weight[b] * (brdf(b) / chance) * light.factor * light.strength_in(b) * light.pane(b);
}

void DirectLight::add_lobe_sample(const SurfacePoint& x, const std::array<float, kDimensions>& u,
                                  const CausticShare& counted, DiffuseWay diffuse, const float* weight,
                                  const LobeSums& sums) const {
  if (empty()) return;
  const SpecularSurface& surface = surfaces_->specular(x.triangle);
  if (surface.spreads(SpecularWayOn::kMirror))
    add_lobe_of(x, SpecularWayOn::kMirror, x, u, counted, weight, sums.lobes);
  SurfacePoint beyond = x;
  beyond.front = !x.front;
  beyond.normal = -x.normal;
  if (surface.spreads(SpecularWayOn::kAcross))
    add_lobe_of(x, SpecularWayOn::kAcross, beyond, u, counted, weight, sums.lobes);
  if (surface.diffuses() && diffuse == DiffuseWay::kFollowed)
    add_lobe_of(x, SpecularWayOn::kDiffuse, beyond, u, counted, weight, sums.diffuse);
}

void DirectLight::add_lobe_of(const SurfacePoint& x, SpecularWayOn way, const SurfacePoint& lit,
                              const std::array<float, kDimensions>& u, const CausticShare& counted,
                              const float* weight, float* sum) const {
  const Arrival light = estimate(lit, ray_origin(*rays_, lit), u);
  if (!light.arrives()) return;
  SpecularStep step(band_count());
  if (!surfaces_->specular(x.triangle).value(x, way, light.towards.normalized(), step)) return;
  const float share = left_by_lobe(light, step, counted);
  for (std::size_t b = 0; b < band_count(); ++b)
    sum[b] += weight[b] * share * step.share()[b] * light.factor * light.strength_in(b) * light.pane(b);
}

float DirectLight::left_by_lobe(const Arrival& light, const SpecularStep& step,
                                const CausticShare& counted) const {
  if (table_.is_sky(light.entry)) return 1 - sky_->sky_found_by_lobe(light.towards, step.pdf_per_sr);
  const SurfaceId luminaire = table_.surface_of(light.entry);
  float share = step.is_wide ? 1 : counted.of(luminaire);
  if (luminaire.valid())
    share *= 1 - share_of_lobe(table_.emitting_area(luminaire), light.towards.norm(), step.pdf_per_sr);
  else if (table_.is_sun(light.entry))
    share *= 1 - sky_->sun_found_by_lobe(step.pdf_per_sr);
  return share;
}

float DirectLight::found_by_lobe(TriangleId luminaire, float way, float pdf_per_sr) const {
  return share_of_lobe(table_.emitting_area(surfaces_->surface(luminaire, true)), way, pdf_per_sr);
}

void DirectLight::add_samples(const SurfacePoint& x, const SobolSequence& sequence, std::uint32_t first,
                              int count, double* sum, double* sum_of_squares) const {
  const auto numbers = [&](int i) {
    const std::uint32_t index = first + static_cast<std::uint32_t>(i);
    return std::array<float, kDimensions>{sequence.sample(index, 0), sequence.sample(index, 1),
                                          sequence.sample(index, 2)};
  };
  estimate_all(x, count, numbers, [&](int, const Arrival& light) {
    if (!light.arrives()) return;
    for (std::size_t b = 0; b < band_count(); ++b) {
      const double e = static_cast<double>(light.factor) * static_cast<double>(light.strength_in(b)) *
                       static_cast<double>(light.pane(b));
      sum[b] += e;
      if (sum_of_squares != nullptr) sum_of_squares[b] += e * e;
    }
  });
}

}  // namespace reemit

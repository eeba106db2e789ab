#include "bench/hit_paths/path_step.h"

#include <algorithm>
#include <utility>

#include "bench/hit_paths/rough_ways.h"
#include "bench/hit_paths/surface_ways.h"

namespace reemit::hit_paths {
namespace {

constexpr double kLongestSurvival = 0.98;  ///< Largest chance of going on.

/// How often ways are chosen, in proportion.
struct Chances {
  double spread = 0, through = 0, mirror = 0, across = 0;
  double lambertian() const { return spread + through; }
  double sum() const { return lambertian() + mirror + across; }
};

Chances chances(const Material& material, const SpecularShares& shares, bool front) {
  Chances c{reflected_diffusely(material, front).maxCoeff(), let_through(material).maxCoeff(),
            shares.mirrored.maxCoeff(), shares.crossing.maxCoeff()};
  // Facets of rough glass let light through even where the surface as a whole would reflect it all.
  if (is_rough_across(material) && is_body(material))
    c.across = std::max(c.across, 0.5 * specular_shares(material, 0, front).crossing.maxCoeff());
  return c;
}

/// The mirrored way, or that across; its weight leaves out how often it is chosen.
std::optional<PathStep> specular_step(const RoomHit& hit, const Vec3& direction, const SpecularShares& shares,
                                      bool crosses, PathRandom& random) {
  PathStep step;
  step.crosses = crosses;
  step.scatters = crosses ? is_rough_across(*hit.material) : is_rough_mirror(*hit.material);
  if (!step.scatters) {
    step.direction = crosses ? crossing(hit, direction) : mirrored(hit, direction);
    step.weight = crosses ? shares.crossing : shares.mirrored;
    return step;
  }
  auto way = crosses ? draw_rough_across(hit, direction, random) : draw_rough_mirror(hit, direction, random);
  if (!way) return std::nullopt;
  step.direction = way->direction;
  step.weight = std::move(way->weight);
  return step;
}

}  // namespace

std::optional<PathStep> next_step(const RoomHit& hit, const Vec3& direction, bool roulette,
                                  PathRandom& random) {
  const Material& material = *hit.material;
  const SpecularShares shares = specular_shares(material, arrival_angle(hit, direction), hit.front);
  const Chances chance = chances(material, shares, hit.front);
  const double sum = chance.sum();
  if (!(sum > 0)) return std::nullopt;
  double survival = 1;
  if (roulette) {
    survival = std::min(sum, kLongestSurvival);
    if (uniform(random) >= survival) return std::nullopt;
  }
  // Rooms without mirrors and glass use no number here.
  const double choice = sum > chance.spread ? sum * uniform(random) : 0;
  if (choice < chance.spread) {
    return PathStep{cosine_direction(hit.normal, random),
                    reflected_diffusely(material, hit.front) * (sum / chance.spread / survival), true, false};
  }
  if (choice < chance.lambertian()) {
    return PathStep{cosine_direction(-hit.normal, random),
                    let_through(material) * (sum / chance.through / survival), true, true};
  }
  const bool crosses = chance.across > 0 && choice >= chance.lambertian() + chance.mirror;
  auto step = specular_step(hit, direction, shares, crosses, random);
  if (step) step->weight *= sum / (crosses ? chance.across : chance.mirror) / survival;
  return step;
}

}  // namespace reemit::hit_paths

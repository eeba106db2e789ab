#include "bench/hit_paths/rough_ways.h"

#include <cmath>

#include "bench/hit_paths/gloss_lobe.h"
#include "bench/hit_paths/surface_ways.h"

namespace reemit::hit_paths {
namespace {

/// Rough bodies of glass are made of facets, whatever the file says.
GlossLobe lobe_of(const Material& material) {
  return material.non_diffuse.is_solid ? GlossLobe::kGgx : material.non_diffuse.lobe;
}

Vec3 across_plane(const Vec3& normal, const Vec3& w) {
  return w - 2 * normal.dot(w) * normal;
}

/// By a lobe, which what crosses a thin sheet has mirrored at the sheet.
std::optional<RoughWay> draw_by_lobe(const RoomHit& hit, const Vec3& direction, bool crosses,
                                     PathRandom& random) {
  const NonDiffusePart& part = hit.material->non_diffuse;
  const double alpha = crosses ? part.transmission_roughness : part.roughness;
  const LobeDraw draw = draw_about_lobe(lobe_of(*hit.material), alpha, hit.normal, -direction, random);
  const double cosine = hit.normal.dot(draw.direction);
  if (!(cosine > 0 && draw.pdf > 0)) return std::nullopt;
  const Vec3 to = crosses ? across_plane(hit.normal, draw.direction) : draw.direction;
  return RoughWay{to, rough_value(hit, direction, to) * (cosine / draw.pdf)};
}

/// Refracted at a facet that is drawn by its own density, D cos, wherever it is seen from: what is left is
/// the seen area over the facets' [WAL07, eq. 41].
std::optional<RoughWay> draw_by_facet(const RoomHit& hit, const Vec3& direction, PathRandom& random) {
  const Material& material = *hit.material;
  const double alpha = material.non_diffuse.transmission_roughness;
  RoomHit facet = hit;
  facet.normal = draw_facet(alpha, hit.normal, random);
  const double seen = -facet.normal.dot(direction);
  if (!(seen > 0)) return std::nullopt;
  const SpecularShares shares = specular_shares(material, arrival_angle(facet, direction), hit.front);
  if (!(shares.crossing > 0).any()) return std::nullopt;
  const Vec3 to = crossing(facet, direction);
  const double cosine = -hit.normal.dot(direction);
  if (!(hit.normal.dot(to) < 0 && cosine > 0)) return std::nullopt;
  const double both = unhidden(alpha, hit.normal, direction) * unhidden(alpha, hit.normal, to);
  return RoughWay{to, shares.crossing * (both * seen / (cosine * hit.normal.dot(facet.normal)))};
}

}  // namespace

Spectrum rough_value(const RoomHit& hit, const Vec3& direction, const Vec3& to) {
  const Material& material = *hit.material;
  const NonDiffusePart& part = material.non_diffuse;
  const bool crosses = hit.normal.dot(to) < 0;
  const bool spreads = crosses ? is_rough_across(material) && !part.is_solid : is_rough_mirror(material);
  if (!spreads) return Spectrum::Zero(material.reflectance.size());
  const Vec3 from = -direction;
  const Vec3 mirrored_to = crosses ? across_plane(hit.normal, to) : to;
  const SpecularShares shares = specular_shares(material, facet_angle(from, mirrored_to), hit.front);
  const double alpha = crosses ? part.transmission_roughness : part.roughness;
  return (crosses ? shares.crossing : shares.mirrored) *
         lobe_value(lobe_of(material), alpha, hit.normal, from, mirrored_to);
}

std::optional<RoughWay> draw_rough_mirror(const RoomHit& hit, const Vec3& direction, PathRandom& random) {
  return draw_by_lobe(hit, direction, false, random);
}

std::optional<RoughWay> draw_rough_across(const RoomHit& hit, const Vec3& direction, PathRandom& random) {
  if (is_body(*hit.material)) return draw_by_facet(hit, direction, random);
  return draw_by_lobe(hit, direction, true, random);
}

}  // namespace reemit::hit_paths

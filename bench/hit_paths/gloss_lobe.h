#pragma once
#include "bench/hit_paths/path_random.h"
#include "scenes/model/material.h"
#include "scenes/model/vec.h"

namespace reemit::hit_paths {

// Lobes of rough surfaces by their formulas in docs/materials.md. Directions are unit and leave the surface
// on the side of the normal.

/// BRDF [1/sr] of a lobe for light from one direction seen from another, of a share of 1.
double lobe_value(GlossLobe lobe, double alpha, const Vec3& normal, const Vec3& from, const Vec3& to);

/// Angle of either direction to the facet that mirrors one to the other [rad].
double facet_angle(const Vec3& from, const Vec3& to);

/// A direction, perhaps below the surface, and the density with which it is drawn.
struct LobeDraw {
  Vec3 direction{0, 0, 1};
  double pdf = 0;  ///< [1/sr]
};

/// Draws a direction seen from `from` roughly as the lobe has it: the density is not the lobe's, so that what
/// lobe_value says counts and not how it may be drawn. A quarter of the draws are cosine-distributed, the
/// others from a bell with a long tail.
LobeDraw draw_about_lobe(GlossLobe lobe, double alpha, const Vec3& normal, const Vec3& from,
                         PathRandom& random);

/// Normal of a facet of GGX on the side of `normal`; its density is D cos.
Vec3 draw_facet(double alpha, const Vec3& normal, PathRandom& random);
/// Share of facets of GGX seen from a direction that are not hidden.
double unhidden(double alpha, const Vec3& normal, const Vec3& from);

}  // namespace reemit::hit_paths

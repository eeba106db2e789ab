#pragma once
#include <span>

#include "scenes/model/vec.h"

namespace reemit {

/// What a light tree knows of a luminaire, or of many: where it is, which way its sides face and how strong
/// it is [CON18, sec. 4.1]. Normalised space.
struct LuminaireBounds {
  Vec3f min{0, 0, 0};  ///< Box around every point that emits; may have no size.
  Vec3f max{0, 0, 0};
  Vec3f axis{0, 0, 1};  ///< Unit; middle of the cone of normals.
  float cos_normals =
      -1;  ///< Cosine of the half angle of that cone: 1 for a flat side, -1 for all directions.
  /// Cosine of the largest angle from a normal at which light leaves: 0 for Lambertian sides, less than 0 if
  /// they also shine backwards, the cosine of the outer angle for spots, whose normal is their direction.
  float cos_emission = 0;
  /// The largest intensity in any direction, in any unit that is the same for all luminaires; > 0. Of several
  /// luminaires the sum. (Not the power: a panel sends four times the intensity of a point of its power.)
  float intensity = 1;
};

/// One flat Lambertian side with these corners (at least one): its intensity is radiance times area. A disk
/// has the corners of the box that disk_bounds puts around it.
LuminaireBounds flat_bounds(std::span<const Vec3f> corners, const Vec3f& unit_normal, float intensity);
/// A disk whose front has this unit normal; its intensity is pi r^2 times its radiance.
LuminaireBounds disk_bounds(const Vec3f& centre, const Vec3f& unit_normal, float radius, float intensity);
/// A sphere that emits outwards or inwards, or with radius 0 a point light. The intensity of a sphere is pi
/// r^2 times its radiance.
LuminaireBounds sphere_bounds(const Vec3f& centre, float radius, float intensity);
/// A spot light with the intensity of its axis; `cos_outer` in [0,1).
LuminaireBounds spot_bounds(const Vec3f& position, const Vec3f& unit_direction, float cos_outer,
                            float intensity);

/// The smallest bounds of this kind that hold both, up to float rounding, which only ever makes them larger.
LuminaireBounds merged(const LuminaireBounds& a, const LuminaireBounds& b);

/// Rooms fill the unit cube or so; farther out, squares of distances could leave the range of float.
inline constexpr float kFarthest = 1e6F;

/// Coordinates within kFarthest, min <= max, a unit axis, cosines in [-1,1] and a finite intensity above 0.
bool valid(const LuminaireBounds& bounds);

}  // namespace reemit

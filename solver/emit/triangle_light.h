#pragma once
#include "scenes/model/vec.h"

namespace reemit {

/// One side of a triangle that emits the same radiance everywhere into every direction, in the normalised
/// space. All results are per unit of radiance and free of scale.
struct TriangleLight {
  Vec3f a, b, c;            ///< Corners; barycentric point (u,v) is (1-u-v) a + u b + v c.
  Vec3f normal;             ///< Unit, out of the side that emits.
  float area = 0;           ///< [normalised units^2]
  float longest_edge2 = 0;  ///< Square of the longest edge [normalised units^2].
};

/// A point of a triangle luminaire as drawn for a receiver.
struct TriangleLightSample {
  float u = 0;  ///< Barycentric.
  float v = 0;
  float factor = 0;  ///< Receiver cosine / density per steradian: irradiance per radiance if visible [sr].
};

/// Irradiance at x with unit normal n per unit of radiance if nothing is in the way, in [0, pi]: the polygon
/// formula of Lambert (1760) [SWZ96, sec. 4.2] for the part above the horizon of x, or its far-field limit
/// when the luminaire is small as seen from x. 0 only if no point of the luminaire can light x.
float unoccluded_irradiance(const TriangleLight& light, const Vec3f& x, const Vec3f& n);

/// Draws a point: uniform in solid angle [ARV95] where the luminaire is large as seen from x, else uniform in
/// area ([SWZ96] density p8). False if this point cannot light x. Which density is used depends on x alone,
/// so both are unbiased.
bool sample_triangle_light(const TriangleLight& light, const Vec3f& x, const Vec3f& n, float u0, float u1,
                           TriangleLightSample& sample);

}  // namespace reemit

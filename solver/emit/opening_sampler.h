#pragma once
#include <optional>

#include "scenes/model/photometry.h"

namespace reemit {

/// A point of the opening in luminaire coordinates [m], relative to its centre, for two uniform numbers in
/// [0,1): uniform over the area of flat openings (or the length of those that are only long), else over the
/// surface. Ellipsoids and elliptic cylinders take the image of a uniform sphere or circle, which is uniform
/// where they are round.
Vec3 sample_opening(const LuminousOpening& opening, double u0, double u1);

/// The openings that sample_opening puts points on by (u0 - 1/2) along0 + (u1 - 1/2) along1: flat rectangles,
/// lines and points.
struct FlatOpening {
  Vec3 along0, along1;
  Vec3 point(double u0, double u1) const { return (u0 - 0.5) * along0 + (u1 - 0.5) * along1; }
};
/// Nothing for an opening of another form.
std::optional<FlatOpening> flat_opening(const LuminousOpening& opening);

/// Greatest of length, width and height [m]; 0 for a point.
double opening_extent(const LuminousOpening& opening);

}  // namespace reemit

#pragma once

namespace reemit {

// What a zone costs: its area times the variances, over it, of what makes light differ. Lengths are in units
// of the length of a zone, the square root of its area.

/// Of place alone, in a right triangle with equal legs and that area.
inline constexpr double kCellCost = 2.0 / 9;
/// Unit normals count as lengths times this: in furnished rooms points then differ least from their zones.
inline constexpr double kNormalWeight = 3;
/// Variance of the normals of a patch of a round shape that spans a right angle, about.
inline constexpr double kPatchNormals = 1.0 / 3;
/// The level of the light on sides (light_on_sides) counts as lengths times this.
inline constexpr double kLightWeight = 5;
/// The unevenness of the light on a cell (light_level.h) counts as a variance of place times this. A third or
/// three times as much changes the error of as many zones by less than a tenth.
inline constexpr double kUnevenWeight = 300;

}  // namespace reemit

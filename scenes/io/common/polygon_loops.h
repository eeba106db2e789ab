#pragma once
#include <vector>

#include "scenes/model/texture.h"
#include "scenes/model/vec.h"

namespace reemit {

/// A polygon as formats write it: corners by coordinates.
struct Polygon {
  std::vector<Vec3> outer;                        ///< Counter-clockwise seen from the front.
  std::vector<Vec3> normals;                      ///< One per outer corner, or none.
  std::vector<std::vector<Vec3>> holes;           ///< Any winding.
  std::vector<TexturePoint> texture_points = {};  ///< One per outer corner, or none.
};

/// Cuts an outline that visits a corner more than once into simple loops: a hole that is tied to its outline
/// by a seam (an edge traversed both ways) becomes a proper hole, dangling edges and repeated corners vanish,
/// islands joined by seams become polygons of their own. How deep the loops lie in each other decides which
/// are holes (odd) and which are islands (even), not their winding; the front of all islands is that of the
/// loops around everything else. Corners are the same when their coordinates are. Empty if nothing with three
/// different corners is left. An outline without repetition comes back as it is, and so does one without a
/// front, which encloses as much area backwards as forwards.
std::vector<Polygon> split_at_seams(Polygon polygon);

}  // namespace reemit

#pragma once
#include <cstddef>

#include "scenes/model/surface.h"

namespace reemit {

/// Largest number of faces that a room may have after arrays and instances are expanded.
inline constexpr std::size_t kMostFaces = 10'000'000;
/// What a triangle of a room takes at least [bytes].
inline constexpr double kLeastBytesPerFace = 120;

/// Area of a face [m2], holes taken off: half the length of the vector area, which for a polygon that is not
/// planar is the area of its projection along its mean normal.
double face_area(const Surface& surface, const Face& face);

/// Area of all faces and round shapes [m2].
double surface_area(const Surface& surface);

/// Turns fronts into backs: loops are reversed and normals negated.
void flip_surface(Surface& surface);

/// Applies a transform; one that mirrors also turns the loops, so that fronts stay fronts. Curved shapes need
/// a similarity (is_similarity), which keeps them what they are.
void transform_surface(const Eigen::Affine3d& transform, Surface& surface);

}  // namespace reemit

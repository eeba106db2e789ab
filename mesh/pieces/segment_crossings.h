#pragma once
#include <cstddef>
#include <span>

#include "mesh/pieces/contact_segments.h"

namespace reemit {

/// Crossings of one outline with itself and its holes beyond which the face is refused. Every crossing
/// becomes a vertex, so their number must be bounded; nobody draws a polygon with this many.
inline constexpr std::size_t kMostOutlineCrossings = 100'000;
/// The same for the contact lines in one plane, and for the outlines of faces that overlap in a room of not
/// very many faces.
inline constexpr std::size_t kMostPlaneCrossings = 1'000'000;

/// How many pairs of segments cross between their ends. Counting stops beyond `most`; 0 without counting if
/// there are too few segments for more.
std::size_t count_crossings(std::span<const PlanarSegment> segments, std::size_t most);

}  // namespace reemit

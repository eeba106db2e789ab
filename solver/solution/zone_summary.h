#pragma once
#include <cstddef>

#include "solver/solution/solution.h"

namespace reemit {

/// What kinds of zones there are.
struct ZoneSummary {
  std::size_t zones = 0;         ///< All of them.
  std::size_t shared = 0;        ///< Groups of small sides.
  std::size_t shared_sides = 0;  ///< Sides of triangles in these.
  std::size_t sealed = 0;        ///< Groups of sides that no light should reach.
  double sealed_area = 0;        ///< [m2]
};

/// Counts the zones of a mesh.
ZoneSummary summarise_zones(const ZoneMesh& mesh);

/// The part of all incident light that came to sealed zones; 0 if all is as it should be. Worst band.
double sealed_light_share(const Solution& solution);

}  // namespace reemit

#pragma once
#include <cstddef>

#include "scenes/model/scene.h"

namespace reemit::bench {

/// A closed grey box of 4 x 3 x 4 m, surface 0, with this many small spheres all over its upper nine tenths.
/// Their sizes shrink with their number, so that they hide each other equally little; their radiances are
/// spread over a range of 100.
Scene box_with_spheres(std::size_t count);
/// The same with equilateral triangles that face anywhere.
Scene box_with_triangles(std::size_t count);
/// The same box with one luminaire that is a wavy sheet of 2 x side^2 triangles below the ceiling, facing
/// down.
Scene box_with_sheet(std::size_t side);

}  // namespace reemit::bench

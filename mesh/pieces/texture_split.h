#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "scenes/model/surface.h"

namespace reemit {

/// Whether the texture coordinates and colours of a face are those of one affine map of its plane, so that
/// any of its triangles continues to all of it. True for faces without any.
bool has_affine_texture(const Surface& surface, const Face& face);

/// The triangles over which texture coordinates of a face are interpolated, as corners of its outline: one
/// where the map is affine, else those that programs draw it with: a fan about the first corner where that
/// lies within the outline, ears where not. Holes are not looked at.
std::vector<std::array<std::uint32_t, 3>> texture_triangles(const Surface& surface, const Face& face);

}  // namespace reemit

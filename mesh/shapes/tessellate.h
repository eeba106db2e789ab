#pragma once
#include "scenes/model/scene.h"

namespace reemit {

/// Appends flat faces in place of a shape: vertices on the shape, its normals for shading, `segments` around
/// (even, >= 4).
void append_faces(const CurvedShape& shape, int segments, Surface& surface);

}  // namespace reemit

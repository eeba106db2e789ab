#pragma once
#include "scenes/model/scene.h"

namespace reemit {

/// Throws InputError, naming the face, for an index out of range, a corner that is not finite, or fewer than
/// three corners.
void check_faces(const Scene& scene);

}  // namespace reemit

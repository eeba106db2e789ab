#pragma once
#include <vector>

#include "scenes/io/common/json_cursor.h"
#include "scenes/model/vec.h"

namespace reemit {

/// One step or an array of steps, applied in the order in which they stand: {"translate"}, {"rotate"},
/// {"scale"} or
/// {"matrix"}. Throws InputError for a transform that flattens space.
Eigen::Affine3d read_transform(const JsonCursor& at);

/// The placements of an "array": one counter or several nested ones (their product), each with "count" and
/// either "step" (a translation) or "rotate". Throws InputError beyond 100000 placements.
struct ArrayPlacement {
  Eigen::Affine3d transform;
  std::vector<int> index;  ///< One per counter.
};
/// In order, the last counter the fastest.
std::vector<ArrayPlacement> read_array(const JsonCursor& at);

}  // namespace reemit

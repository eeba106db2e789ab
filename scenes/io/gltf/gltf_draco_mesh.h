#pragma once
#include <cstddef>
#include <memory>

#include <draco/mesh/mesh.h>

#include "scenes/io/common/json_cursor.h"

namespace reemit {

/// Decodes a Draco mesh of as many faces as promised: no number in the data is believed before the memory for
/// it is known to be there. Throws InputError at `at` for data that are damaged or do not keep the promise.
std::unique_ptr<draco::Mesh> decode_draco_mesh(const unsigned char* bytes, std::size_t size,
                                               std::size_t promised_faces, const JsonCursor& at);

}  // namespace reemit

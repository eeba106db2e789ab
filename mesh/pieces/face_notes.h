#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "scenes/model/scene.h"

namespace reemit {

/// How messages name a face: surface, where it was read, and its index.
std::string face_name(const Scene& scene, SurfaceId surface, std::uint32_t face);

/// Counts faces that something happened to and remembers the first few, so that a room with thousands of them
/// gets one line of warning.
class FaceNotes {
 public:
  void add(const Scene& scene, SurfaceId surface, std::uint32_t face);
  std::size_t count() const { return count_; }
  /// "wall (room.obj:12, face 3), ... and 7 more".
  std::string names() const;

 private:
  std::size_t count_ = 0;
  std::vector<std::string> first_;
};

}  // namespace reemit

#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/build_mesh.h"
#include "scenes/model/scene.h"

namespace reemit {

/// A face of a surface, or one of its round shapes.
struct FaceRef {
  SurfaceId surface;
  std::uint32_t number = 0;  ///< In Surface::faces or Surface::shapes.
  bool is_shape = false;

  auto operator<=>(const FaceRef&) const = default;
};

/// The faces to which one thing happened.
struct FaceList {
  std::string key;          ///< In JSON: "flipped".
  std::string description;  ///< For people.
  std::size_t count = 0;
  std::vector<FaceRef> first;  ///< Up to kMostNamed of them, in the order of the room.

  static constexpr std::size_t kMostNamed = 5;
};

/// Faces by what meshing did to them, and those of which a side is sealed; a face may be in several lists. In
/// the order of FaceChange, the sealed ones last; without those that are empty.
std::vector<FaceList> list_faces(const MeshResult& meshed);

/// "'wall' (room.obj:12, face 3), ... and 7 more".
std::string names_of(const Scene& scene, const FaceList& list);
/// The line a face was read from, 0 if that is not known.
std::uint32_t source_line(const Scene& scene, const FaceRef& face);
/// The file a face was read from.
const std::string& source_of(const Scene& scene, const FaceRef& face);

}  // namespace reemit

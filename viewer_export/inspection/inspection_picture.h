#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/build_mesh.h"
#include "scenes/io/common/output_file.h"
#include "scenes/model/scene.h"
#include "viewer_export/inspection/picture_object.h"

namespace reemit {

/// Objects that are shown and hidden together.
struct PictureSet {
  std::string name;
  Vec3 shift{0, 0, 0};  ///< Of the set against the room [m].
  std::vector<PictureObject> objects;
};

/// A picture of a mesh for people whose room misbehaves (docs/meshing.md).
struct InspectionPicture {
  Vec3 origin{0, 0, 0};  ///< Of the positions of all objects [m].
  Vec3 up{0, 1, 0};
  /// What meshing did, one object for each SideKind that occurs, and luminaires as lines; beside it the
  /// zones, coloured by area.
  std::vector<PictureSet> sets;
};

/// Every side of a base triangle that has zones, once in each of the two sets: fronts where they are, backs
/// off them as in exports.
InspectionPicture draw_inspection(const Scene& scene, const MeshResult& meshed);

/// Throws InputError unless a picture can have this name.
void check_inspection_name(const std::filesystem::path& file);

/// Writes a picture as .glb: a node and mesh for each object. The file appears whole or not at all. Throws
/// InputError where it would exceed the 4 GiB of the format, ResourceError when it cannot be written.
void write_inspection(const InspectionPicture& picture, const Scene& scene,
                      const std::filesystem::path& file);

}  // namespace reemit

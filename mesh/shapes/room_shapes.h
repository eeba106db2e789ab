#pragma once
#include <optional>
#include <vector>

#include "mesh/model/mesh_report.h"
#include "mesh/model/mesh_tolerances.h"
#include "mesh/zones/zone_mesh.h"
#include "scenes/model/scene.h"

namespace reemit {

/// The curved shapes of a room that stay exact, and the room without the others.
struct RoomShapes {
  std::vector<CurvedShape> exact;
  std::vector<SurfaceId> surface;    ///< Of each.
  std::vector<std::uint32_t> index;  ///< Of each, in Surface::shapes.
  std::optional<Scene> faceted;      ///< The room with flat faces in place of the other shapes, if any.
  std::size_t replaced = 0;          ///< Shapes that became faces.
  bool all = false;                  ///< All of them had to.

  bool is_two_sided(const Scene& scene, std::size_t i) const {
    return scene.material_of(scene.surfaces[surface[i].index()]).two_sided;
  }
};

/// Decides which shapes stay exact: all that no flat face passes through, unless they end in a circle
/// together with one that is not exact, and all luminaires. The zones of a pierced shape must end at the cut,
/// or they would carry light from one side to the other; faces can be cut. With `exact_shapes` false all
/// become faces.
RoomShapes separate_shapes(const Scene& room, bool exact_shapes, const MeshTolerances& tolerances);

/// Appends the patches of the exact shapes to the base triangles, and their areas to the report.
void append_patches(const Scene& scene, const RoomShapes& shapes, BaseMesh& mesh, MeshReport& report);

}  // namespace reemit

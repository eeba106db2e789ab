#pragma once
#include <optional>
#include <vector>

#include "mesh/model/mesh_report.h"
#include "mesh/model/mesh_settings.h"
#include "mesh/model/mesh_tolerances.h"
#include "mesh/pieces/face_piece.h"
#include "mesh/zones/zone_mesh.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Shapes that became flat faces.
struct FacetedShapes {
  std::size_t count = 0;
  bool all = false;                      ///< All shapes of the room had to.
  int fewest_sides = 0, most_sides = 0;  ///< To a circle.
  double round_area = 0, flat_area = 0;  ///< Of one side, before and after [m2].
};

/// The curved shapes of a room that stay exact, and the room without the others.
struct RoomShapes {
  std::vector<CurvedShape> exact;
  std::vector<SurfaceId> surface;    ///< Of each.
  std::vector<std::uint32_t> index;  ///< Of each, in Surface::shapes.
  std::optional<Scene> faceted;      ///< The room with flat faces in place of the other shapes, if any.
  FacetedShapes facets;

  // Of the surface that exact shape i belongs to.
  bool emits(const Scene& scene, std::size_t i) const {
    return scene.material_of(scene.surfaces[surface[i].index()]).emits();
  }
  bool is_cut_out(const Scene& scene, std::size_t i) const {
    return scene.material_of(scene.surfaces[surface[i].index()]).textures.is_cut_out();
  }
  bool is_two_sided(const Scene& scene, std::size_t i) const {
    return scene.material_of(scene.surfaces[surface[i].index()]).two_sided;
  }
};

/// Decides which shapes stay exact: all that no flat face passes through, unless they end in a circle
/// together with one that is not exact, and all luminaires; but no cut-outs. The zones of a pierced shape
/// must end at the cut, or they would carry light from one side to the other; faces can be cut. How many
/// sides such a shape gets follows its size beside that of the zones that the settings ask for. Without
/// settings.exact_shapes all become faces, with as many sides as any. Throws InputError when the settings are
/// out of range.
RoomShapes separate_shapes(const Scene& room, const MeshSettings& settings, const MeshTolerances& tolerances);

/// Area of all sides that have zones [m2]: of pieces of faces, and of the exact shapes.
double zoned_area(const Scene& scene, const std::vector<FacePiece>& pieces, const RoomShapes& shapes);

/// Appends the patches of the exact shapes to the base triangles, and their areas to the report.
void append_patches(const Scene& scene, const RoomShapes& shapes, BaseMesh& mesh, MeshReport& report);

}  // namespace reemit

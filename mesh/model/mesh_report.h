#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "mesh/model/changed_faces.h"

namespace reemit {

/// Area of one surface through repair and meshing [m2], one side: input = meshed + removed to 1e-9 relative.
struct SurfaceAreas {
  double input = 0;   ///< Sum over the polygons as read, after splitting non-planar ones into triangles.
  double meshed = 0;  ///< Sum over the base triangles.
  /// Duplicates, parts covered by a coplanar face that wins over this one, and what collapsed.
  double removed = 0;
  double collapsed = 0;  ///< Part of `removed`: faces too small or thin to be meshed.
  double welded = 0;     ///< What moving corners onto each other took away, of either sign, and rounding.
};

/// What meshing did to the room, for `info` and for the user.
struct MeshReport {
  std::vector<SurfaceAreas> surfaces;  ///< By SurfaceId.
  std::size_t degenerate_faces = 0;    ///< Dropped: zero area.
  std::size_t duplicate_faces = 0;     ///< Dropped: same polygon twice.
  std::size_t overlapping_faces =
      0;  ///< Lost area to a coplanar face (the emitter wins, else the earlier one).
  std::size_t back_to_back_faces = 0;  ///< Pairs in one plane that keep one side each, somewhere.
  std::size_t flipped_faces = 0;       ///< Turned round because the rest of their closed shell says so.
  std::size_t nonplanar_faces = 0;     ///< Split into triangles.
  std::size_t cut_faces = 0;           ///< Cut along the contact with another face.
  std::vector<std::string> warnings;   ///< With surface names, files and lines.
  /// Which faces the counts are of, and some more; tidy once the room is meshed. Not kept in solution files.
  std::vector<ChangedFace> changes;
};

}  // namespace reemit

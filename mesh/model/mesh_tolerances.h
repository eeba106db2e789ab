#pragma once
#include "scenes/model/scene.h"

namespace reemit {

/// Lengths below which two things count as one, all tied to the size of the room so that a room of 1 mm and
/// one of 10 km are meshed alike. docs/meshing.md says what each was chosen for.
struct MeshTolerances {
  double diagonal = 0;  ///< Of the room's bounding box [m].
  double weld = 0;      ///< Vertices closer than this are one [m]; below what the ray tracer can tell apart.
  double contact = 0;   ///< An edge this close to a plane stands on it [m].
  double snap = 0;      ///< Cuts move this far onto corners, edges and other cuts [m].

  /// Of a room with the given bounding box.
  static MeshTolerances of(const Box& box) {
    const double d = box.size().norm();
    return {.diagonal = d, .weld = 1e-7 * d, .contact = 5e-5 * d, .snap = 1e-5 * d};
  }
};

/// Largest distance of a corner from the plane of its polygon, relative to the polygon's diameter, for the
/// polygon to count as planar. So small that bending by less cannot change an area by 1e-9.
constexpr double kPlanar = 2e-7;
/// Polygons bent by more than this are reported; below, it is the rounding of printed coordinates.
constexpr double kVisiblyBent = 1e-5;
/// Triangles with less area than this share of diagonal^2 carry no light and are left out.
constexpr double kSmallestArea = 1e-14;

}  // namespace reemit

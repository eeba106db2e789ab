#pragma once
#include <optional>

namespace reemit {

/// How a room is cut into zones.
struct MeshSettings {
  /// Largest zone area [m2], > 0. Unset: such that there are about default_zone_count zones, both sides
  /// counted.
  std::optional<double> zone_area;
  int default_zone_count = 8000;  ///< Zones aimed at when zone_area is unset [1, 1e8].
  double smallest_angle_deg =
      20.0;  ///< Quality bound of the base triangulation where the input allows it [0, 30].
  double crease_angle_deg =
      30.0;  ///< Neighbouring faces that bend less share vertices (curved surfaces) [0, 180].
  /// Spheres, disks, cylinders and cones stay what they are. Else they become flat faces, as a method that
  /// needs flat zones asks for.
  bool exact_shapes = true;
};

}  // namespace reemit
